#include "analysis/folder_difference.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

// Entry by entry.
class Entries {
 public:
  explicit Entries(std::string name) { difference_.name = std::move(name); }

  void Add(bool same, std::optional<double> a, std::optional<double> b) {
    ++difference_.entries;
    difference_.different += same ? 0 : 1;
    if (!a || !b || !std::isfinite(*a) || !std::isfinite(*b)) return;
    const double d = *b - *a;
    ++difference_.numbers;
    sum_ += d;
    squares_ += d * d;
    difference_.most = std::max(difference_.most, std::abs(d));
  }

  ValueDifference Result() const {
    ValueDifference result = difference_;
    if (result.numbers > 0) {
      const auto n = static_cast<double>(result.numbers);
      result.bias = sum_ / n;
      result.rms = std::sqrt(squares_ / n);
    }
    return result;
  }

 private:
  ValueDifference difference_;
  double sum_ = 0.0, squares_ = 0.0;
};

void CompareTables(const fs::path& file_a, const fs::path& file_b, FileDifference& difference) {
  const TextTable a = ReadTextTable(file_a), b = ReadTextTable(file_b);
  if (a.columns != b.columns) {
    difference.note = "other columns";
    return;
  }
  if (a.rows.size() != b.rows.size()) {
    difference.note = fmt::format("{} rows and {}", a.rows.size(), b.rows.size());
    return;
  }
  for (size_t column = 0; column < a.columns.size(); ++column) {
    Entries entries(a.columns[column]);
    for (size_t row = 0; row < a.rows.size(); ++row) {
      const std::string &was = a.rows[row][column], &is = b.rows[row][column];
      entries.Add(was == is, CellNumber(was), CellNumber(is));
    }
    const ValueDifference result = entries.Result();
    if (result.different > 0) difference.values.push_back(result);
  }
}

std::optional<double> NumberOf(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

void CompareJson(const fs::path& file_a, const fs::path& file_b, FileDifference& difference) {
  const auto flat = [](const fs::path& file) {
    const Json json = Json::parse(ReadTextFile(file), nullptr, false);
    return json.is_structured() ? json.flatten() : Json::object();
  };
  const Json a = flat(file_a), b = flat(file_b);
  int64_t others = 0;
  for (const auto& [pointer, was] : a.items()) {
    if (!b.contains(pointer)) {
      ++others;
    } else if (b[pointer] != was) {
      Entries entry(pointer);
      entry.Add(false, NumberOf(was), NumberOf(b[pointer]));
      difference.values.push_back(entry.Result());
    }
  }
  for (const auto& [pointer, is] : b.items()) others += a.contains(pointer) ? 0 : 1;
  if (others > 0) difference.note = fmt::format("{} values are in one of them only", others);
}

bool IsPicture(const fs::path& file) {
  return file.extension() == ".exr" || file.extension() == ".png";
}

FileDifference CompareFiles(const fs::path& folder_a, const fs::path& folder_b,
                            const std::string& name) {
  FileDifference difference;
  difference.file = name;
  const fs::path a = folder_a / name, b = folder_b / name;
  if (!fs::exists(a) || !fs::exists(b)) {
    difference.note = fs::exists(a) ? "only in a" : "only in b";
    return difference;
  }
  difference.same = ReadTextFile(a) == ReadTextFile(b);
  if (difference.same) return difference;
  try {
    if (IsPicture(a)) difference.picture = ComparePictures(ReadPair(a, b));
    if (a.extension() == ".csv") CompareTables(a, b, difference);
    if (a.extension() == ".json") CompareJson(a, b, difference);
  } catch (const InputError& error) {
    difference.note = error.what();
  }
  // Files of other bytes may hold the same pixels: a header tells when it was made.
  if (difference.picture) difference.same = difference.picture->Same();
  return difference;
}

bool TellsResults(const fs::path& relative) {
  static const std::set<std::string> kOthers = {"run.json", "report.html", "manifest.json"};
  return *relative.begin() != "tasks" && !kOthers.contains(relative.filename().string());
}

void CollectFiles(const fs::path& folder, std::set<std::string>& names) {
  std::error_code error;
  for (auto i = fs::recursive_directory_iterator(folder, error);
       !error && i != fs::recursive_directory_iterator(); i.increment(error)) {
    const fs::path relative = i->path().lexically_relative(folder);
    if (i->is_regular_file(error) && TellsResults(relative)) names.insert(relative.string());
  }
  if (error) throw InputError::At(folder, "", error.message(), "a folder that can be read");
}

}  // namespace

std::vector<FileDifference> CompareFolders(const fs::path& folder_a, const fs::path& folder_b) {
  std::set<std::string> names;
  CollectFiles(folder_a, names);
  CollectFiles(folder_b, names);
  std::vector<FileDifference> differences;
  for (const std::string& name : names)
    differences.push_back(CompareFiles(folder_a, folder_b, name));
  return differences;
}

}  // namespace retrolux
