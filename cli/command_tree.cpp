#include "cli/command_tree.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace retrolux::cli {

namespace {

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

// CLI11 tells the validators of an option only in the text "TYPE:VALIDATOR" of its help: a choice
// as "TEXT:{a,b}", a range as "INT:INT in [1 - 4]".
void ReadType(const std::string& text, OptionText& result) {
  const size_t colon = text.find(':');
  result.type = text.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string validator = text.substr(colon + 1);
  if (validator.front() == '{' && validator.back() == '}') {
    result.choices = SplitAtCommas(validator.substr(1, validator.size() - 2));
  } else {
    result.limits = validator;
  }
}

OptionText TextOf(const CLI::Option& option) {
  OptionText text;
  if (option.get_positional()) text.names = {option.get_name(true)};
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  if (option.get_type_size() != 0) ReadType(option.get_type_name(), text);
  text.description = option.get_description();
  text.default_value = option.get_default_str();
  text.required = option.get_required();
  text.several = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  return text;
}

void Append(const CLI::App& app, const std::string& path, std::vector<CommandText>& all) {
  CommandText command{path, app.get_description(), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      command.positionals.push_back(TextOf(*option));
    } else if (option != app.get_help_ptr() || all.empty()) {
      command.options.push_back(TextOf(*option));
    }
  }
  const std::vector<const CLI::App*> subcommands = app.get_subcommands({});
  for (const CLI::App* sub : subcommands) command.subcommands.push_back(sub->get_name());
  all.push_back(std::move(command));
  for (const CLI::App* sub : subcommands) Append(*sub, path + " " + sub->get_name(), all);
}

}  // namespace

bool OptionText::IsNumber() const {
  constexpr std::array kNumbers = {"INT", "UINT", "FLOAT"};
  return std::find(kNumbers.begin(), kNumbers.end(), type) != kNumbers.end();
}

std::string ChoiceType(const std::vector<std::string>& names) {
  return "TEXT:{" + CLI::detail::join(names, ",") + "}";
}

std::vector<CommandText> CommandTree(const CLI::App& program) {
  std::vector<CommandText> all;
  Append(program, "retrolux", all);  // its own name is the path that it was started by
  return all;
}

}  // namespace retrolux::cli
