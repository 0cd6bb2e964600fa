#include "core/csv.h"

#include <charconv>
#include <cmath>
#include <sstream>

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

NumberTable ReadNumberTable(const std::filesystem::path& path) {
  std::istringstream stream(ReadTextFile(path));
  NumberTable table;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells;
    std::istringstream split(line);
    for (std::string cell; std::getline(split, cell, ',');) cells.push_back(cell);
    const std::string place = fmt::format("line {}", number);
    if (table.columns.empty()) {
      table.columns = cells;
      continue;
    }
    if (cells.size() != table.columns.size()) {
      throw InputError::At(path, place, fmt::format("{} cells", cells.size()),
                           fmt::format("{} ({})", table.columns.size(), JoinNames(table.columns)));
    }
    std::vector<double> row;
    for (const std::string& cell : cells) {
      double value = 0.0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value)) {
        throw InputError::At(path, place, fmt::format("'{}'", cell), "a number");
      }
      row.push_back(value);
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) throw InputError::At(path, "", "no rows", "a header and numbers");
  return table;
}

}  // namespace retrolux
