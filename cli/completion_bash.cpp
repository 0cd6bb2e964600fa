#include <fmt/format.h>

#include "cli/completion.h"

namespace retrolux::cli {

namespace {

// $path is the command so far ("retrolux study markers"), $word what is being typed, $previous what
// stands before it. No reply: with `complete -o default`, bash completes files itself.
constexpr const char* kHead = R"(# bash completion, made by `retrolux completion bash`
_retrolux() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} path=retrolux
  local i commands= options= words=
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$path ${COMP_WORDS[i]}" in
)";

constexpr const char* kAfterPaths = R"( path+=" ${COMP_WORDS[i]}" ;;
    esac
  done
  # bash takes --option=value for three words.
  if [[ $word == = ]]; then
    word=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  case "$path $previous" in
)";

constexpr const char* kAfterValues = R"(    *)
      case $path in
)";

constexpr const char* kTail = R"(      esac
      words=$commands
      [[ $word != -* ]] || words=$options
      ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _retrolux retrolux
)";

std::string Paths(const std::vector<CommandText>& commands) {
  std::vector<std::string> patterns;
  for (const CommandText& command : commands) patterns.push_back("'" + command.path + "'");
  return fmt::format("      {})", fmt::join(patterns.begin() + 1, patterns.end(), " | "));
}

// What may stand after an option; nothing of ours for a file, nothing at all for a number. `where`:
// how the pattern of the command begins.
std::string Values(const std::string& where, const std::vector<OptionText>& options) {
  std::string cases;
  for (const OptionText& option : options) {
    if (option.IsFlag()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names)
      patterns.push_back(fmt::format("{} {}'", where, name));
    cases += fmt::format("    {}) ", fmt::join(patterns, " | "));
    if (option.IsNumber()) cases += "compopt +o default 2>/dev/null ";
    if (!option.choices.empty())
      cases += fmt::format("words='{}' ", fmt::join(option.choices, " "));
    cases += ";;\n";
  }
  return cases;
}

void AppendNames(const std::vector<OptionText>& options, std::vector<std::string>& names) {
  for (const OptionText& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
}

// The words that are no option's value: subcommands or the choices of positionals, and options.
std::string Words(const CommandText& command, const CommandText& program) {
  std::vector<std::string> words = command.subcommands;
  for (const OptionText& positional : command.positionals)
    words.insert(words.end(), positional.choices.begin(), positional.choices.end());
  std::vector<std::string> options;
  AppendNames(command.options, options);
  if (&command != &program) AppendNames(program.options, options);
  return fmt::format("        '{}') commands='{}' options='{}' ;;\n", command.path,
                     fmt::join(words, " "), fmt::join(options, " "));
}

}  // namespace

std::string BashCompletion(const std::vector<CommandText>& commands) {
  const CommandText& program = commands.front();
  std::string script = kHead + Paths(commands) + kAfterPaths + Values("*'", program.options);
  for (const CommandText& command : commands) {
    if (&command != &program) script += Values("'" + command.path, command.options);
  }
  script += kAfterValues;
  for (const CommandText& command : commands) script += Words(command, program);
  return script + kTail;
}

}  // namespace retrolux::cli
