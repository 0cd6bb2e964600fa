#include <fmt/format.h>

#include "cli/completion.h"

namespace retrolux::cli {

namespace {

constexpr const char* kHead = R"(# fish completion, made by `retrolux completion fish`

# Is the command so far the one at this path?
function __retrolux_at --argument-names path
    set -l so_far retrolux
    for word in (commandline -opc)[2..]
        contains -- "$so_far $word" $__retrolux_paths; and set so_far "$so_far $word"
    end
    test "$so_far" = "$path"
end
)";

std::string Quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return "'" + quoted + "'";
}

// Wherever `where` holds; it ends with a blank if it is not empty.
std::string Complete(const std::string& where, const std::string& what) {
  return "complete -c retrolux " + where + what + "\n";
}

// What may follow: -x is a word that is no file, -r -F a file.
std::string Value(const OptionText& option) {
  if (option.IsFlag()) return "";
  if (option.IsText()) return " -r -F";
  if (option.choices.empty()) return " -x";
  return fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
}

std::string Options(const std::string& where, const std::vector<OptionText>& options) {
  std::string lines;
  for (const OptionText& option : options) {
    std::string names;
    for (const std::string& name : option.names)
      names += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
    lines += Complete(where, names.substr(1) + Value(option) + " -d " + Quoted(option.description));
  }
  return lines;
}

std::string Positionals(const std::string& where, const std::vector<OptionText>& positionals) {
  std::string lines;
  for (const OptionText& positional : positionals) {
    lines += Complete(where, Value(positional).substr(1));
  }
  return lines;
}

}  // namespace

std::string FishCompletion(const std::vector<CommandText>& commands) {
  std::string script = kHead;
  script += "set -g __retrolux_paths";
  for (const CommandText& command : commands) script += " \\\n    " + Quoted(command.path);
  script += "\n\n" + Complete("", "-f") + Options("", commands.front().options);
  for (size_t i = 1; i < commands.size(); ++i) {
    const CommandText& command = commands[i];
    const std::string group = command.path.substr(0, command.path.rfind(' '));
    const auto at = [](const std::string& path) {
      return "-n " + Quoted("__retrolux_at \"" + path + "\"") + " ";
    };
    script +=
        "\n" + Complete(at(group), "-a " + command.Name() + " -d " + Quoted(command.description));
    script += Options(at(command.path), command.options);
    script += Positionals(at(command.path), command.positionals);
  }
  return script;
}

}  // namespace retrolux::cli
