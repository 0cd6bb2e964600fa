// `retrolux validate`: all physical checks, one after the other, and what they gave.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/check.h"
#include "core/parallel.h"

namespace retrolux {

struct CheckGroupResult {
  const CheckGroup* group;
  std::vector<Check> checks;
  double seconds = 0.0;
};

struct Validation {
  std::vector<CheckGroupResult> groups;

  size_t Count() const;
  size_t Failed() const;
};

// The groups of those names, in the order of the table; all of them if `names` is empty.
// InputError that lists the names.
Validation Validate(const std::vector<std::string>& names, Progress& progress);

// "ok    name: measured 1.0002, expected 1 +- 0.001 (source)"
std::string TextOf(const Check& check);

// retrolux/validate-1.
nlohmann::json ToJson(const Validation& validation);

// validate.json and report.html.
void WriteValidation(const Validation& validation, const std::filesystem::path& folder,
                     const std::string& command_line);

}  // namespace retrolux
