#include <fmt/format.h>

#include <algorithm>

#include "cli/completion.h"

namespace retrolux::cli {

namespace {

constexpr const char* kHead = R"(#compdef retrolux
# zsh completion, made by `retrolux completion zsh`

# For a command with subcommands, whose $names these are: one of them, or what belongs to it.
__retrolux_subcommand() {
  case $state in
    name) _describe subcommand names ;;
    rest) (( ! $+functions[$1_$line[1]] )) || $1_$line[1] ;;
  esac
}
)";

// Both ways: as a file of $fpath, which is the function's body, and by eval.
constexpr const char* kTail = R"(
if [[ $funcstack[1] == _retrolux ]]; then _retrolux "$@"; else compdef _retrolux retrolux; fi
)";

std::string Quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return "'" + quoted + "'";
}

// A description, in which these characters would end it.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view("[]:\\").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// "retrolux study markers" is completed by _retrolux_study_markers.
std::string FunctionOf(const std::string& path) {
  std::string name = "_" + path;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

// How _arguments completes a value: ":what it is:how".
std::string Value(const OptionText& option, const std::string& what) {
  if (option.IsFlag()) return "";
  if (!option.choices.empty()) return fmt::format(":{}:({})", what, fmt::join(option.choices, " "));
  return fmt::format(":{}:{}", what, option.IsNumber() ? " " : "_files");
}

std::string Options(const std::vector<OptionText>& options) {
  std::string lines;
  for (const OptionText& option : options) {
    for (const std::string& name : option.names) {
      lines +=
          fmt::format(" \\\n    {}",
                      Quoted(fmt::format("{}{}[{}]{}", option.several ? "*" : "", name,
                                         Escaped(option.description), Value(option, option.type))));
    }
  }
  return lines;
}

std::string Positionals(const std::vector<OptionText>& positionals) {
  std::string lines;
  for (const OptionText& positional : positionals) {
    lines += " \\\n    " +
             Quoted((positional.several ? "*" : "") + Value(positional, positional.names.front()));
  }
  return lines;
}

const CommandText& CommandAt(const std::vector<CommandText>& commands, const std::string& path) {
  return *std::find_if(commands.begin(), commands.end(),
                       [&](const CommandText& command) { return command.path == path; });
}

// Of a command that has subcommands.
std::string Names(const CommandText& command, const std::vector<CommandText>& commands) {
  std::string lines = "  local state line\n  local -a names=(\n";
  for (const std::string& name : command.subcommands) {
    const std::string& text = CommandAt(commands, command.path + " " + name).description;
    lines += "    " + Quoted(name + ":" + text) + "\n";
  }
  return lines + "  )\n";
}

std::string Function(const CommandText& command, const std::vector<CommandText>& commands) {
  const bool group = !command.subcommands.empty();
  const std::string name = FunctionOf(command.path);
  std::string text = fmt::format("\n{}() {{\n", name);
  if (group) text += Names(command, commands);
  text += "  _arguments -C $__retrolux_common";
  if (&command != &commands.front()) text += Options(command.options);
  text += group ? " '1: :->name' '*:: :->rest'" : Positionals(command.positionals);
  if (group) text += "\n  __retrolux_subcommand " + name;
  return text + "\n}\n";
}

}  // namespace

std::string ZshCompletion(const std::vector<CommandText>& commands) {
  std::string script = kHead;
  script += "\ntypeset -ga __retrolux_common=(" + Options(commands.front().options) + "\n)\n";
  for (const CommandText& command : commands) script += Function(command, commands);
  return script + kTail;
}

}  // namespace retrolux::cli
