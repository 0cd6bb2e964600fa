// retrolux manual
#include "cli/manual.h"

#include <fmt/format.h>

#include "cli/commands.h"

namespace retrolux::cli {

namespace {

// Without a date, so that the same sources give the same page.
constexpr const char* kBegin = R"(.\" Made by `retrolux manual`
.TH RETROLUX 1 "" "Retrolux )" RETROLUX_VERSION R"(" "User Commands"
.SH NAME
retrolux \- pictures of retro\-reflective markers, and what to learn from them
)";

constexpr const char* kEnd = R"(.SH EXIT STATUS
.TP
0
good
.TP
1
our fault; please report it
.TP
2
wrong input
.TP
3
a check failed
.TP
4
some tasks failed; the others are done
.TP
75
try again: disk full, too little memory
.TP
129, 130, 143
interrupted by a signal; the same command goes on where it was
.SH ENVIRONMENT
.TP
RETROLUX_DATA
a folder in which data files are looked for first
.SH FILES
.TP
\&../share/retrolux
beside the folder of the program: materials, scenes, schemas and the page of reports
)";

// Text as it is: roff would take a backslash for its own, a hyphen for one to break at, and a line
// that begins with a dot for a request.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    const bool begins = escaped.empty() || escaped.back() == '\n';
    if (begins && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Bold(const std::string& text) {
  return "\\fB" + Escaped(text) + "\\fR";
}
std::string Italic(const std::string& text) {
  return "\\fI" + Escaped(text) + "\\fR";
}

std::string Heading(const OptionText& option, bool positional) {
  std::vector<std::string> names;
  for (const std::string& name : option.names)
    names.push_back(positional ? Italic(name) : Bold(name));
  std::string heading = fmt::format("{}", fmt::join(names, ", "));
  if (!option.choices.empty()) {
    heading += " " + Escaped(fmt::format("{}", fmt::join(option.choices, "|")));
  } else if (!option.IsFlag() && !positional) {
    heading += " " + Italic(option.type);
  }
  return option.several ? heading + " ..." : heading;
}

// In brackets, or nothing.
std::string Notes(const OptionText& option) {
  std::vector<std::string> notes;
  if (option.required) notes.emplace_back("required");
  if (!option.limits.empty()) notes.push_back(option.limits);
  if (!option.default_value.empty()) notes.push_back("default: " + option.default_value);
  return notes.empty() ? "" : fmt::format("({})", fmt::join(notes, "; "));
}

std::string Options(const std::vector<OptionText>& options, bool positional) {
  std::string text;
  for (const OptionText& option : options) {
    text += ".TP\n" + Heading(option, positional) + "\n";
    for (const std::string& line : {option.description, Notes(option)})
      if (!line.empty()) text += Escaped(line) + "\n";
  }
  return text;
}

std::string Usage(const CommandText& command) {
  std::string usage = Bold(command.path);
  if (!command.options.empty()) usage += " [OPTIONS]";
  for (const OptionText& positional : command.positionals) {
    const std::string name = Italic(positional.names.front()) + (positional.several ? "..." : "");
    usage += positional.required ? " " + name : " [" + name + "]";
  }
  return command.subcommands.empty() ? usage : usage + " SUBCOMMAND";
}

std::string Section(const CommandText& command) {
  std::string text = fmt::format(".SS \"{}\"\n{}\n", Usage(command), Escaped(command.description));
  text += Options(command.positionals, true) + Options(command.options, false);
  if (!command.footer.empty()) text += ".PP\n" + Escaped(command.footer) + "\n";
  return text;
}

}  // namespace

std::string ManualPage(const std::vector<CommandText>& commands) {
  const CommandText& program = commands.front();
  std::string page = kBegin;
  page += ".SH SYNOPSIS\n" + Usage(program) + "\n";
  page += ".SH DESCRIPTION\n" + Escaped(program.description) + "\n";
  page += ".SH OPTIONS\nEvery subcommand takes these, too.\n" + Options(program.options, false);
  page += ".SH COMMANDS\n";
  for (size_t i = 1; i < commands.size(); ++i) page += Section(commands[i]);
  return page + kEnd;
}

void SetUpManual(CLI::App& app, const GlobalOptions& global, Run& run) {
  CLI::App* sub = app.add_subcommand("manual", "Print the manual page, for man -l");
  sub->callback([&app, &global, &run] {
    run = [&app, &global] {
      std::string page = ManualPage(CommandTree(app));
      page.pop_back();  // PrintResult ends the line
      PrintResult(global, {{"manual", page}}, page);
      return kExitGood;
    };
  });
}

}  // namespace retrolux::cli
