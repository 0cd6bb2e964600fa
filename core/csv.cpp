#include "core/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux {

std::string CsvNumber(double value) {
  return fmt::format("{:.6g}", value);
}

void AddNumbers(const std::vector<double>& values, std::vector<std::string>& cells) {
  for (const double value : values) cells.push_back(CsvNumber(value));
}

CsvWriter::CsvWriter(const std::vector<std::string>& columns) : columns_(columns.size()) {
  Line(columns);
}

void CsvWriter::Row(const std::vector<std::string>& cells) {
  RETROLUX_CHECK(cells.size() == columns_, "{} cells, {} columns", cells.size(), columns_);
  Line(cells);
}

void CsvWriter::Line(const std::vector<std::string>& cells) {
  for (size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) text_ += ',';
    if (cells[i].find_first_of(",\"\n") == std::string::npos) {
      text_ += cells[i];
      continue;
    }
    text_ += '"';
    for (const char c : cells[i]) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
    text_ += '"';
  }
  text_ += '\n';
}

void CsvWriter::Write(const std::filesystem::path& path) const {
  WriteTextFile(path, text_);
}

namespace {

// One line of a table after the other, comments and empty lines left out. A quoted cell may hold
// commas, quotes (doubled) and line ends.
class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path)
      : path_(path), text_(ReadTextFile(path)) {}

  // Empty at the end.
  std::vector<std::string> NextRow() {
    SkipComments();
    std::vector<std::string> cells;
    while (at_ < text_.size()) {
      cells.push_back(text_[at_] == '"' ? Quoted() : Plain());
      if (at_ >= text_.size()) break;
      const char end = text_[at_++];
      if (end == ',') continue;
      ++line_;
      break;
    }
    return cells;
  }

  std::string Place() const { return fmt::format("line {}", row_line_); }

 private:
  void SkipComments() {
    while (at_ < text_.size() && (text_[at_] == '#' || text_[at_] == '\n' || text_[at_] == '\r')) {
      at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1;
      ++line_;
    }
    row_line_ = line_;
  }

  std::string Plain() {
    const size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
    std::string cell = text_.substr(at_, end - at_);
    at_ = end;
    if (!cell.empty() && cell.back() == '\r') cell.pop_back();
    return cell;
  }

  std::string Quoted() {
    std::string cell;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] != '"') {
        cell += text_[at_];
      } else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        cell += text_[at_++];
      } else {
        ++at_;
        return cell + Plain();
      }
    }
    throw InputError::At(path_, Place(), "a quote that does not end", "one");
  }

  std::filesystem::path path_;
  std::string text_;
  size_t at_ = 0;
  int line_ = 1, row_line_ = 1;
};

template <typename Table, typename Cell>
Table ReadTable(const std::filesystem::path& path, Cell cell) {
  TableReader reader(path);
  Table table;
  table.columns = reader.NextRow();
  for (auto cells = reader.NextRow(); !cells.empty(); cells = reader.NextRow()) {
    if (cells.size() != table.columns.size()) {
      throw InputError::At(path, reader.Place(), fmt::format("{} cells", cells.size()),
                           fmt::format("{} ({})", table.columns.size(), JoinNames(table.columns)));
    }
    auto& row = table.rows.emplace_back();
    for (const std::string& text : cells) row.push_back(cell(text, reader.Place()));
  }
  return table;
}

}  // namespace

std::optional<double> CellNumber(const std::string& cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

TextTable ReadTextTable(const std::filesystem::path& path) {
  return ReadTable<TextTable>(path,
                              [](const std::string& cell, const std::string&) { return cell; });
}

NumberTable ReadNumberTable(const std::filesystem::path& path) {
  auto table = ReadTable<NumberTable>(path, [&](const std::string& cell, const std::string& place) {
    const std::optional<double> value = CellNumber(cell);
    if (!value || !std::isfinite(*value))
      throw InputError::At(path, place, fmt::format("'{}'", cell), "a number");
    return *value;
  });
  if (table.rows.empty()) throw InputError::At(path, "", "no rows", "a header and numbers");
  return table;
}

}  // namespace retrolux
