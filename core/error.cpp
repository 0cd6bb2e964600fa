#include "core/error.h"

#include <algorithm>
#include <numeric>

namespace retrolux {

InputError InputError::At(const std::filesystem::path& file, std::string_view place,
                          std::string_view found, std::string_view expected) {
  const std::string where =
      place.empty() ? file.string() : fmt::format("{}: {}", file.string(), place);
  return InputError(fmt::format("{}: {}; expected {}", where, found, expected));
}

namespace {

// Levenshtein distance.
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string NearestName(std::string_view name, const std::vector<std::string>& names) {
  std::string best;
  size_t best_distance = std::max<size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : names) {
    const size_t distance = EditDistance(name, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string JoinNames(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void FailCheck(const char* condition, const char* file, int line, const std::string& values) {
  throw std::logic_error(
      fmt::format("{}:{}: check failed: {} ({})", file, line, condition, values));
}

}  // namespace retrolux
