// Reports: one self-contained HTML page (plots, tables, pictures, maps, downloads) that opens from
// a mail attachment without a network. Content goes in block by block; the page in analysis/report/
// draws it.
//
// To add a kind of block: a method here that appends {"type": ...} to the content, a function in
// analysis/report/ (page.js, or a file of its own that report.cpp lists) and its row in the table
// DRAW of page.js, and a line in tests/report_demo.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace retrolux {

struct RoomFigure;  // analysis/room_figure.h

// A number that decides something, shown large: {"Usable area", "41.2", "%", "marker 2,
// reference"}.
struct KeyFigure {
  std::string label;
  std::string value;
  std::string unit;
  std::string note;
};

struct LabelledPicture {
  std::string label;
  std::string png_bytes;  // the encoded file, e.g. of EncodeRgbPng
};

// A channel of a picture, row by row.
struct ReportChannel {
  enum class Kind { kValue, kDifference, kIds };  // a difference is drawn from blue to red about 0

  std::string name, unit;
  Kind kind = Kind::kValue;
  std::vector<std::string> names;  // of ids: the first is that of id 1
  std::vector<float> values;       // ids up to 2^24; NaN: no value
};

// The grid of marker positions on the top half (x >= 0) of an ellipsoid of revolution about z.
// Cells have equal lengths along z (row 0 at the rear end) and equal angles about it (column 0 at
// the top).
struct OvalGrid {
  int rows = 28;
  int columns = 14;  // on each side
  double half_length_mm = 140.0;
  double radius_mm = 100.0;
};

// What a value of a map means. The value is the index in the list of categories.
struct OvalCategory {
  std::string label;
  std::string colour;  // of CSS, e.g. "#0072b2"
};

// Ready categories, told apart by the colour-blind and in print.
std::vector<OvalCategory> HitMissCategories();        // 0 = miss, white; 1 = hit, black
std::vector<OvalCategory> CountCategories(int most);  // 0 .. most, white, then viridis
std::vector<OvalCategory> NamedCategories(
    const std::vector<std::string>& names);  // at most 8, the first black

// One map. Values row by row, `columns` of them a row, from the top down to the side.
struct OvalMap {
  std::string label;
  std::string note;        // e.g. "41.2 %, 33,015 mm2"; may be empty
  std::vector<int> left;   // y >= 0, the left of an observer who faces the scanner
  std::vector<int> right;  // the mirrored half, y < 0
};

class Report {
 public:
  Report(const std::string& title, const std::string& subtitle);

  // Begins a section and enters it in the table of contents.
  void Heading(const std::string& text);
  // Plain text; only **bold** and `code` mean anything.
  void Paragraph(const std::string& text);
  void KeyFigures(const std::vector<KeyFigure>& figures);
  // A figure of plotly: an array of traces and a layout; colours, fonts and margins have defaults.
  // NaN makes a gap.
  void Plot(const std::string& caption, nlohmann::json data,
            nlohmann::json layout = nlohmann::json::object(), int height_px = 420);
  // Can be downloaded as CSV. Columns of numbers are aligned as such.
  void Table(const std::string& caption, const std::vector<std::string>& columns,
             const std::vector<std::vector<std::string>>& rows);
  // Pictures open in a viewer with zoom, never smoothed there.
  void Picture(const std::string& caption, const std::string& png_bytes);
  // `legend`: what colours in the pictures mean.
  void PictureGrid(const std::string& caption, const std::vector<LabelledPicture>& pictures,
                   int columns, const std::vector<OvalCategory>& legend = {});
  // Two pictures of the same size, one over the other, with a slider between them.
  void Comparison(const std::string& caption, const LabelledPicture& left,
                  const LabelledPicture& right);
  // Channels of one picture to choose from: false colour with a scale that can be set, the value
  // under the pointer.
  void Channels(const std::string& caption, int width, int height,
                const std::vector<ReportChannel>& channels);
  // A room in three dimensions, with a choice of its states.
  void Room(const std::string& caption, const RoomFigure& room, int height_px = 620);
  // Small multiples with one legend: each map unrolled, and painted on the oval seen from above,
  // from the side (+y) and from the front (+z).
  void OvalMaps(const std::string& caption, const std::vector<OvalCategory>& categories,
                const std::vector<OvalMap>& maps, const OvalGrid& grid = {});
  // A file that the page carries and offers for download.
  void Attachment(const std::string& file_name, const std::string& text);
  // Begins the section "How this was made" with the command; what else there is to say goes after.
  void HowMade(const std::string& command_line);

  // The same content gives the same bytes. InputError if the plot library is not installed.
  std::string Html() const;
  void Write(const std::filesystem::path& file) const;

 private:
  void Add(const char* type, nlohmann::json block);

  nlohmann::json content_;
  bool has_plots_ = false;
};

}  // namespace retrolux
