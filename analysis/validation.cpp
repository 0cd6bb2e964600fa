#include "analysis/validation.h"

#include <algorithm>
#include <chrono>

#include "analysis/report.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux {

namespace {

std::vector<const CheckGroup*> Chosen(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const CheckGroup& group : CheckGroups()) known.emplace_back(group.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("no checks '{}'; expected one of {}", name, JoinNames(known)));
  }
  std::vector<const CheckGroup*> chosen;
  for (const CheckGroup& group : CheckGroups()) {
    if (names.empty() || std::find(names.begin(), names.end(), group.name) != names.end())
      chosen.push_back(&group);
  }
  return chosen;
}

std::string Number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string WithUnit(double value, const std::string& unit) {
  return unit.empty() ? Number(value) : Number(value) + " " + unit;
}

}  // namespace

size_t Validation::Count() const {
  size_t count = 0;
  for (const CheckGroupResult& result : groups) count += result.checks.size();
  return count;
}

size_t Validation::Failed() const {
  size_t failed = 0;
  for (const CheckGroupResult& result : groups) {
    failed += static_cast<size_t>(std::count_if(result.checks.begin(), result.checks.end(),
                                                [](const Check& c) { return !c.Pass(); }));
  }
  return failed;
}

Validation Validate(const std::vector<std::string>& names, Progress& progress) {
  const std::vector<const CheckGroup*> chosen = Chosen(names);
  Validation validation;
  progress.Begin("validate", static_cast<int64_t>(chosen.size()), "groups");
  for (const CheckGroup* group : chosen) {
    const auto start = std::chrono::steady_clock::now();
    CheckGroupResult result{group, group->run()};
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    validation.groups.push_back(std::move(result));
    progress.Advance(1);
  }
  progress.End();
  return validation;
}

std::string TextOf(const Check& check) {
  return fmt::format("{:<6}{}: measured {}, expected {} +- {} ({})", check.Pass() ? "ok" : "FAILED",
                     check.name, WithUnit(check.measured, check.unit), Number(check.expected),
                     fmt::format("{:.2g}", check.tolerance), check.source);
}

nlohmann::json ToJson(const Validation& validation) {
  nlohmann::json checks = nlohmann::json::array();
  for (const CheckGroupResult& result : validation.groups) {
    for (const Check& check : result.checks) {
      checks.push_back({{"group", result.group->name},
                        {"check", check.name},
                        {"measured", check.measured},
                        {"expected", check.expected},
                        {"tolerance", check.tolerance},
                        {"unit", check.unit},
                        {"pass", check.Pass()},
                        {"source", check.source},
                        {"independent_of", result.group->independent_of}});
    }
  }
  return {{"schema", "retrolux/validate-1"},
          {"version", RETROLUX_VERSION},
          {"pixel_origin", "center"},
          {"units", "as in each check"},
          {"count", validation.Count()},
          {"failed", validation.Failed()},
          {"checks", checks}};
}

void WriteValidation(const Validation& validation, const std::filesystem::path& folder,
                     const std::string& command_line) {
  EnsureWritableFolder(folder);
  WriteTextFile(folder / "validate.json", ToJson(validation).dump(2) + "\n");
  Report report("Physics against closed forms and tables", "retrolux " RETROLUX_VERSION);
  report.KeyFigures({{"Checks passed", fmt::format("{}", validation.Count() - validation.Failed()),
                      fmt::format("of {}", validation.Count()), ""}});
  for (const CheckGroupResult& result : validation.groups) {
    std::string title = result.group->name;
    title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
    report.Heading(title);
    std::vector<std::vector<std::string>> rows;
    for (const Check& check : result.checks) {
      rows.push_back({check.Pass() ? "ok" : "FAILED", check.name, Number(check.measured),
                      Number(check.expected), fmt::format("{:.2g}", check.tolerance), check.unit,
                      check.source});
    }
    report.Table(fmt::format("Independent of what is tested: {}", result.group->independent_of),
                 {"", "check", "measured", "expected", "±", "unit", "source"}, rows);
  }
  report.HowMade(command_line);
  report.Write(folder / "report.html");
}

}  // namespace retrolux
