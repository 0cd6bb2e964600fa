// Kinds of failure: the user's data throw InputError, a full disk or short memory throws
// TryAgainError, tasks of which others are done throw TasksFailed, our own fault trips
// RETROLUX_CHECK. A normal miss is a std::optional. Only cli/main.cpp catches, and turns them into
// exit codes.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace retrolux {

// Something the user gave is wrong: says where, what was found, and what was expected. Exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  // "FILE: PLACE: FOUND; expected EXPECTED". `place` may be empty (the file as a whole).
  static InputError At(const std::filesystem::path& file, std::string_view place,
                       std::string_view found, std::string_view expected);
};

// The machine could not do it now and may do it later (disk full, no memory). Exit code 75.
class TryAgainError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Of many independent tasks some failed; the others are done and kept. Exit code 4.
class TasksFailed : public std::runtime_error {
 public:
  // `failures`: "NAME: what happened", one for each.
  TasksFailed(const std::string& what, std::vector<std::string> failures)
      : std::runtime_error(what), failures_(std::move(failures)) {}
  const std::vector<std::string>& Failures() const { return failures_; }

 private:
  std::vector<std::string> failures_;
};

// Of `names`, the one closest to `name` by edit distance if it is close enough to be a slip of the
// pen, else the empty string. For messages of the form "unknown key 'ringz', did you mean
// 'rings'?".
std::string NearestName(std::string_view name, const std::vector<std::string>& names);

// "a, b, c"
std::string JoinNames(const std::vector<std::string>& names);

[[noreturn]] void FailCheck(const char* condition, const char* file, int line,
                            const std::string& values);

}  // namespace retrolux

// Our own fault if false; the further arguments are an fmt format and its values.
#define RETROLUX_CHECK(condition, ...)                                                 \
  do {                                                                                 \
    if (!(condition)) {                                                                \
      ::retrolux::FailCheck(#condition, __FILE__, __LINE__, fmt::format(__VA_ARGS__)); \
    }                                                                                  \
  } while (false)
