// retrolux validate [--out DIR] [--only NAME,...]
#include <fmt/format.h>

#include "analysis/validation.h"
#include "cli/commands.h"

namespace retrolux::cli {

namespace {

struct ValidateCommand {
  std::filesystem::path out;
  std::vector<std::string> only;
};

int RunValidate(const ValidateCommand& command, const GlobalOptions& global) {
  const auto progress = MakeProgress(global);
  const Validation validation = Validate(command.only, *progress);
  std::string text;
  for (const CheckGroupResult& result : validation.groups) {
    text += fmt::format("{} ({:.1f} s; independent of what is tested: {})\n", result.group->name,
                        result.seconds, result.group->independent_of);
    for (const Check& check : result.checks) text += "  " + TextOf(check) + "\n";
  }
  text += fmt::format("{} of {} checks pass", validation.Count() - validation.Failed(),
                      validation.Count());
  if (!command.out.empty()) {
    WriteValidation(validation, command.out, global.command_line);
    text += fmt::format("\nreport: {}", (command.out / "report.html").string());
  }
  PrintResult(global, ToJson(validation), text);
  return validation.Failed() == 0 ? kExitGood : kExitCheckFailed;
}

}  // namespace

void SetUpValidate(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<ValidateCommand>();
  CLI::App* sub = app.add_subcommand(
      "validate",
      "Hold the physics against closed forms and tables: measured, expected, tolerance and source "
      "of each check; exit code 3 if one fails");
  sub->add_option("--out", command->out, "folder for validate.json and report.html");
  std::vector<std::string> names;
  for (const CheckGroup& group : CheckGroups()) names.emplace_back(group.name);
  sub->add_option("--only", command->only,
                  fmt::format("some groups of checks, comma-separated: {}", fmt::join(names, ", ")))
      ->delimiter(',');
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunValidate(*command, global); };
  });
}

}  // namespace retrolux::cli
