// The subcommands and options of the program as plain data, for what is written about them:
// completion scripts and the manual page.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace retrolux::cli {

struct OptionText {
  std::vector<std::string> names;  // "-h", "--help"; of a positional its one name, "IMAGE"
  std::string type;                // "TEXT", "DIR"; empty: a flag
  std::string description;
  std::string limits;                // "INT in [1 - 4]"; empty: none
  std::string default_value;         // empty: none
  std::vector<std::string> choices;  // what it may be; empty: not a choice
  bool required = false;
  bool several = false;  // takes any number of values

  bool IsFlag() const { return type.empty(); }
  bool IsNumber() const;
  bool IsText() const { return !IsFlag() && !IsNumber() && choices.empty(); }  // perhaps a file
};

struct CommandText {
  std::string path;  // "retrolux study markers"
  std::string description;
  std::string footer;
  std::vector<OptionText> options;  // without --help
  std::vector<OptionText> positionals;
  std::vector<std::string> subcommands;  // names

  std::string Name() const { return path.substr(path.rfind(' ') + 1); }
};

// All commands, each before its subcommands; the first is the program itself, whose options
// (here with --help) every other takes, too.
std::vector<CommandText> CommandTree(const CLI::App& program);

// The type of an option whose values have names, where not CLI::IsMember but the program itself
// refuses others, because it says more.
std::string ChoiceType(const std::vector<std::string>& names);

}  // namespace retrolux::cli
