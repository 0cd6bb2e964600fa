// Tables: comma-separated, first line the header with units in the names. Lines that begin with '#'
// are comments (sources) in the tables that we read; the tables that we write have none.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrolux {

// Six significant digits.
std::string CsvNumber(double value);
void AddNumbers(const std::vector<double>& values, std::vector<std::string>& cells);

class CsvWriter {
 public:
  explicit CsvWriter(const std::vector<std::string>& columns);

  // One row; the number of cells must be that of the columns. Cells with commas or quotes are
  // quoted.
  void Row(const std::vector<std::string>& cells);
  void Write(const std::filesystem::path& path) const;
  const std::string& Text() const { return text_; }

 private:
  void Line(const std::vector<std::string>& cells);
  size_t columns_;
  std::string text_;
};

// Any table: cells as they stand, quotes taken off. InputError if a row has more or fewer cells
// than the header, or a quote does not end.
struct TextTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
TextTable ReadTextTable(const std::filesystem::path& path);

// The number that a cell holds, the whole of it; nothing for text and for an empty cell.
std::optional<double> CellNumber(const std::string& cell);

// Numbers only, as the data files under materials/data. InputError with file and line.
struct NumberTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};
NumberTable ReadNumberTable(const std::filesystem::path& path);

}  // namespace retrolux
