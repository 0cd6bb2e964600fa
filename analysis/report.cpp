#include "analysis/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include "analysis/base64.h"
#include "analysis/room_figure.h"
#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/error.h"

namespace retrolux {

using nlohmann::json;

namespace {

std::string Replaced(std::string_view text, char what, std::string_view by) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (c == what) {
      result += by;
    } else {
      result += c;
    }
  }
  return result;
}

std::string EscapeHtml(std::string_view text) {
  std::string result = Replaced(text, '&', "&amp;");  // first, for the others bring new ones
  result = Replaced(result, '<', "&lt;");
  result = Replaced(result, '>', "&gt;");
  return Replaced(result, '"', "&quot;");
}

// JSON that may stand in a <script> element: in JSON a '<' is always inside a string, so that the
// escape changes nothing. Bytes that are not UTF-8 become U+FFFD.
std::string EmbeddedJson(const json& content) {
  return Replaced(content.dump(-1, ' ', false, json::error_handler_t::replace), '<', "\\u003c");
}

std::string PageFile(const char* name) {
  return ReadTextFile(DataPath(std::filesystem::path("analysis/report") / name));
}

std::string PageScripts() {
  std::string scripts;
  for (const char* name : {"oval.js", "plot.js", "viewer.js", "compare.js", "channels.js",
                           "room.js", "page.js"})  // page.js last: it draws with the others
    scripts += PageFile(name);
  return scripts;
}

std::string PlotLibrary() {
  std::string text;
  try {
    text = PageFile("node_modules/plotly.js-dist-min/plotly.min.js");
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("the plot library is not installed; run scripts/setup.sh and try again ({})",
                    error.what()));
  }
  RETROLUX_CHECK(text.find("</script") == std::string::npos, "plotly.min.js ends its element");
  return text;
}

// Puts `parts` in the places "{{name}}" of the page, in one pass: what a part says is never a
// place.
std::string FillTemplate(std::string_view page, const std::map<std::string, std::string>& parts) {
  std::string result;
  for (;;) {
    const size_t begin = page.find("{{");
    if (begin == std::string_view::npos) break;
    const size_t end = page.find("}}", begin);
    RETROLUX_CHECK(end != std::string_view::npos, "page.html: '{{{{' without an end");
    const std::string name(page.substr(begin + 2, end - begin - 2));
    const auto part = parts.find(name);
    RETROLUX_CHECK(part != parts.end(), "page.html: unknown place '{}'", name);
    result += page.substr(0, begin);
    result += part->second;
    page.remove_prefix(end + 2);
  }
  return result += page;
}

json PictureJson(const LabelledPicture& picture) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  RETROLUX_CHECK(std::string_view(picture.png_bytes).substr(0, 8) == kSignature,
                 "picture '{}' is not a PNG", picture.label);
  return {{"label", picture.label}, {"png", Base64(picture.png_bytes)}};
}

json LegendJson(const std::vector<OvalCategory>& categories) {
  json legend = json::array();
  for (const OvalCategory& category : categories) {
    legend.push_back({{"label", category.label}, {"colour", category.colour}});
  }
  return legend;
}

// `left` and `right` as rows of the unrolled map: from the left side over the top to the right
// side.
json MapRows(const OvalMap& map, const OvalGrid& grid, int categories) {
  const size_t columns = static_cast<size_t>(grid.columns);
  const size_t cells = static_cast<size_t>(grid.rows) * columns;
  RETROLUX_CHECK(map.left.size() == cells && map.right.size() == cells,
                 "map '{}': {} and {} values for {} cells a side", map.label, map.left.size(),
                 map.right.size(), cells);
  json rows = json::array();
  for (size_t begin = 0; begin < cells; begin += columns) {
    std::vector<int> row(map.left.rend() - static_cast<std::ptrdiff_t>(begin + columns),
                         map.left.rend() - static_cast<std::ptrdiff_t>(begin));
    row.insert(row.end(), map.right.begin() + static_cast<std::ptrdiff_t>(begin),
               map.right.begin() + static_cast<std::ptrdiff_t>(begin + columns));
    for (const int value : row) {
      RETROLUX_CHECK(value >= 0 && value < categories, "map '{}': value {} of {} categories",
                     map.label, value, categories);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::vector<OvalCategory> HitMissCategories() {
  return {{"miss", "#ffffff"}, {"hit", "#1a1a1a"}};
}

std::vector<OvalCategory> CountCategories(int most) {
  // Viridis from its light end: more is darker.
  constexpr std::array<std::array<int, 3>, 7> kStops = {{{253, 231, 37},
                                                         {144, 215, 67},
                                                         {53, 183, 121},
                                                         {33, 145, 140},
                                                         {49, 104, 142},
                                                         {68, 57, 131},
                                                         {68, 1, 84}}};
  RETROLUX_CHECK(most >= 1, "most = {}", most);
  std::vector<OvalCategory> categories = {{"0", "#ffffff"}};
  for (int count = 1; count <= most; ++count) {
    const double place = most == 1 ? 6.0 : 6.0 * (count - 1) / (most - 1);
    const size_t stop = std::min<size_t>(5, static_cast<size_t>(place));
    const double weight = place - static_cast<double>(stop);
    std::array<int, 3> rgb{};
    for (size_t k = 0; k < 3; ++k) {
      const double value = (1.0 - weight) * kStops[stop][k] + weight * kStops[stop + 1][k];
      rgb[k] = static_cast<int>(std::lround(value));
    }
    categories.push_back(
        {fmt::format("{}", count), fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2])});
  }
  return categories;
}

std::vector<OvalCategory> NamedCategories(const std::vector<std::string>& names) {
  // First black: what the map is about, e.g. the hits; then two greys for what had to be expected;
  // the rest of Okabe and Ito (2008).
  constexpr std::array<const char*, 8> kColours = {"#1a1a1a", "#aab2bb", "#e4e7ea", "#56b4e9",
                                                   "#e69f00", "#d55e00", "#cc79a7", "#009e73"};
  RETROLUX_CHECK(names.size() <= kColours.size(), "{} categories", names.size());
  std::vector<OvalCategory> categories;
  categories.reserve(names.size());
  for (const std::string& name : names) categories.push_back({name, kColours[categories.size()]});
  return categories;
}

Report::Report(const std::string& title, const std::string& subtitle)
    : content_{{"schema", "retrolux/report-1"},
               {"title", title},
               {"subtitle", subtitle},
               {"blocks", json::array()}} {}

void Report::Add(const char* type, json block) {
  block["type"] = type;
  content_["blocks"].push_back(std::move(block));
}

void Report::Heading(const std::string& text) {
  Add("heading", {{"text", text}});
}

void Report::Paragraph(const std::string& text) {
  Add("paragraph", {{"text", text}});
}

void Report::KeyFigures(const std::vector<KeyFigure>& figures) {
  json items = json::array();
  for (const KeyFigure& figure : figures) {
    items.push_back({{"label", figure.label},
                     {"value", figure.value},
                     {"unit", figure.unit},
                     {"note", figure.note}});
  }
  Add("key_figures", {{"items", std::move(items)}});
}

void Report::Plot(const std::string& caption, json data, json layout, int height_px) {
  RETROLUX_CHECK(data.is_array() && layout.is_object(), "plot '{}'", caption);
  Add("plot", {{"caption", caption},
               {"data", std::move(data)},
               {"layout", std::move(layout)},
               {"height_px", height_px}});
  has_plots_ = true;
}

void Report::Table(const std::string& caption, const std::vector<std::string>& columns,
                   const std::vector<std::vector<std::string>>& rows) {
  for (const auto& row : rows) {
    RETROLUX_CHECK(row.size() == columns.size(), "table '{}': {} cells for {} columns", caption,
                   row.size(), columns.size());
  }
  Add("table", {{"caption", caption}, {"columns", columns}, {"rows", rows}});
}

void Report::Picture(const std::string& caption, const std::string& png_bytes) {
  PictureGrid(caption, {{"", png_bytes}}, 1);
}

void Report::PictureGrid(const std::string& caption, const std::vector<LabelledPicture>& pictures,
                         int columns, const std::vector<OvalCategory>& legend) {
  json items = json::array();
  for (const LabelledPicture& picture : pictures) items.push_back(PictureJson(picture));
  json block = {{"caption", caption}, {"columns", columns}, {"items", std::move(items)}};
  if (!legend.empty()) block["legend"] = LegendJson(legend);
  Add("pictures", std::move(block));
}

void Report::Comparison(const std::string& caption, const LabelledPicture& left,
                        const LabelledPicture& right) {
  Add("comparison",
      {{"caption", caption}, {"items", json::array({PictureJson(left), PictureJson(right)})}});
}

void Report::Channels(const std::string& caption, int width, int height,
                      const std::vector<ReportChannel>& channels) {
  constexpr std::array<const char*, 3> kKinds = {"value", "difference", "ids"};
  json items = json::array();
  for (const ReportChannel& channel : channels) {
    RETROLUX_CHECK(
        channel.values.size() == static_cast<size_t>(width) * static_cast<size_t>(height),
        "channel '{}': {} values", channel.name, channel.values.size());
    items.push_back({{"name", channel.name},
                     {"unit", channel.unit},
                     {"kind", kKinds[static_cast<size_t>(channel.kind)]},
                     {"names", channel.names},
                     {"data", Base64(Deflated(channel.values))}});
  }
  Add("channels",
      {{"caption", caption}, {"width", width}, {"height", height}, {"channels", std::move(items)}});
}

void Report::Room(const std::string& caption, const RoomFigure& room, int height_px) {
  RETROLUX_CHECK(!room.states.empty(), "room '{}' has no state", caption);
  const auto vector = [](const Vec3d& v) -> json {
    return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
  };
  json states = json::array();
  for (const RoomState& state : room.states)
    states.push_back({{"label", state.label}, {"traces", state.traces}});
  Add("room", {{"caption", caption},
               {"height_px", height_px},
               {"up", vector(room.up)},
               {"eye", vector(room.eye)},
               {"traces", room.traces},
               {"choice", room.choice},
               {"states", std::move(states)}});
  has_plots_ = true;
}

void Report::OvalMaps(const std::string& caption, const std::vector<OvalCategory>& categories,
                      const std::vector<OvalMap>& maps, const OvalGrid& grid) {
  json items = json::array();
  for (const OvalMap& map : maps) {
    items.push_back({{"label", map.label},
                     {"note", map.note},
                     {"values", MapRows(map, grid, static_cast<int>(categories.size()))}});
  }
  Add("oval_maps", {{"caption", caption},
                    {"categories", LegendJson(categories)},
                    {"maps", std::move(items)},
                    {"grid",
                     {{"rows", grid.rows},
                      {"columns", grid.columns},
                      {"half_length_mm", grid.half_length_mm},
                      {"radius_mm", grid.radius_mm}}}});
}

void Report::Attachment(const std::string& file_name, const std::string& text) {
  Add("attachment", {{"file_name", file_name}, {"text", text}});
}

void Report::HowMade(const std::string& command_line) {
  Heading("How this was made");
  Paragraph(fmt::format("`{}`", command_line));
}

std::string Report::Html() const {
  return FillTemplate(PageFile("page.html"),
                      {{"title", EscapeHtml(content_["title"].get<std::string>())},
                       {"css", PageFile("page.css")},
                       {"plotly", has_plots_ ? PlotLibrary() : ""},
                       {"content", EmbeddedJson(content_)},
                       {"js", PageScripts()}});
}

void Report::Write(const std::filesystem::path& file) const {
  WriteTextFile(file, Html());
}

}  // namespace retrolux
