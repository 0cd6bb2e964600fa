// A report with every kind of block, from made-up data that look like those of the marker study:
//     report_demo FILE.html
// It shows what the page can do, and tests/report_page.sh checks it in a browser.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "analysis/report.h"
#include "analysis/room_figure.h"
#include "core/conventions.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/image_file.h"

namespace retrolux {
namespace {

constexpr OvalGrid kGrid;
const std::vector<std::string> kCameras = {"front-middle", "front-left", "front-right",
                                           "back-middle",  "back-left",  "back-right"};
const std::vector<std::string> kReasons = {"hit",       "outside picture", "facing away", "hidden",
                                           "too small", "not detected",    "wrong number"};

// Reproducible and of no quality: it only has to look like noise.
double Noise(uint64_t key) {
  key = (key ^ (key >> 31)) * 0x9e3779b97f4a7c15ULL;
  key = (key ^ (key >> 29)) * 0xbf58476d1ce4e5b9ULL;
  return static_cast<double>(key >> 11 & 0xffffff) / 0x1000000;
}

struct Cell {
  Vec3d point, normal;
};

Cell CellAt(int row, int column, bool left) {
  const double z = kGrid.half_length_mm * (2.0 * (row + 0.5) / kGrid.rows - 1.0);
  const double rho = kGrid.radius_mm * std::sqrt(1.0 - std::pow(z / kGrid.half_length_mm, 2));
  const double phi = RadFromDeg((column + 0.5) * 90.0 / kGrid.columns) * (left ? 1.0 : -1.0);
  const Vec3d point(rho * std::cos(phi), rho * std::sin(phi), z);
  const Vec3d radii(kGrid.radius_mm, kGrid.radius_mm, kGrid.half_length_mm);
  return {point, point.cwiseQuotient(radii.cwiseAbs2()).normalized()};
}

// What a camera makes of marker `marker` there: an index of kReasons.
int Outcome(int camera, int marker, double pose_z, const Cell& cell) {
  const Vec3d eyes[] = {{700, 0, 1450},  {450, 600, 1400},  {450, -600, 1400},
                        {800, 0, -1400}, {780, 300, -1380}, {780, -300, -1380}};
  const Vec3d to_camera = eyes[camera] - cell.point - Vec3d(0, 0, pose_z);
  const double cosine = cell.normal.dot(to_camera.normalized());
  const auto key = static_cast<uint64_t>(std::llround(cell.point.x() * 7 + cell.point.y() * 131 +
                                                      cell.point.z() * 977)) +
                   static_cast<uint64_t>(camera * 31 + marker * 1009);
  const double limit = (marker == 2 ? 0.46 : 0.53) + 0.10 * (Noise(key) - 0.5);
  if (cosine <= 0.0) return 2;
  if (camera == 0 && std::abs(cell.point.y()) < 12 && cell.point.z() < -60) return 3;
  if (cosine < 0.25) return 4;
  if (cosine < 0.36) return 5;
  return cosine < limit ? 6 : 0;
}

using Rule = std::function<int(const Cell&)>;

OvalMap MapOf(const std::string& label, const Rule& rule, bool usable) {
  OvalMap map{label, "", {}, {}};
  int hits = 0;
  for (int row = 0; row < kGrid.rows; ++row) {
    for (int column = 0; column < kGrid.columns; ++column) {
      map.left.push_back(rule(CellAt(row, column, true)));
      map.right.push_back(rule(CellAt(row, column, false)));
      hits += map.left.back() == 1 ? 1 : 0;
    }
  }
  const double share = hits / (1.0 * kGrid.rows * kGrid.columns);
  if (usable) map.note = fmt::format("{:.1f} %, {:.0f} mm²", 100.0 * share, 80133.0 * share);
  return map;
}

struct Pose {
  const char* name;
  double z;
};
constexpr Pose kPoses[] = {{"reference", 0.0}, {"start", 140.0}, {"end", -140.0}};

int CamerasHit(int first, int last, int marker, double z, const Cell& cell) {
  int count = 0;
  for (int camera = first; camera < last; ++camera) {
    count += Outcome(camera, marker, z, cell) == 0 ? 1 : 0;
  }
  return count;
}

void AddMaps(Report& report) {
  std::vector<OvalMap> satisfies, front, counts, reasons;
  for (const int marker : {2, 3}) {
    for (const Pose& pose : kPoses) {
      const std::string label = fmt::format("Marker {}, {}", marker, pose.name);
      satisfies.push_back(MapOf(
          label,
          [&](const Cell& cell) { return CamerasHit(0, 6, marker, pose.z, cell) >= 2 ? 1 : 0; },
          true));
      front.push_back(MapOf(
          label,
          [&](const Cell& cell) { return CamerasHit(0, 3, marker, pose.z, cell) >= 2 ? 1 : 0; },
          true));
    }
  }
  for (const int marker : {2, 3}) {
    counts.push_back(MapOf(
        fmt::format("Marker {}, reference", marker),
        [&](const Cell& cell) { return CamerasHit(0, 6, marker, 0.0, cell); }, false));
  }
  for (int camera = 0; camera < 6; ++camera) {
    reasons.push_back(MapOf(
        kCameras[static_cast<size_t>(camera)],
        [&](const Cell& cell) { return Outcome(camera, 2, 0.0, cell); }, false));
  }
  report.Heading("Where a marker satisfies the criteria");
  report.OvalMaps("Positions identified by **at least two of the six cameras**.",
                  HitMissCategories(), satisfies);
  report.OvalMaps("Positions identified by at least two of the **front** cameras.",
                  HitMissCategories(), front);
  report.Heading("How many cameras, and why not");
  report.OvalMaps("Number of cameras that identify the marker.", CountCategories(6), counts);
  report.OvalMaps("Reason of a miss by camera, marker 2 in the reference pose.",
                  NamedCategories(kReasons), reasons);
}

void AddPlots(Report& report) {
  nlohmann::json z = nlohmann::json::array(), area2 = z, area3 = z, error = z;
  for (int64_t k = -14; k <= 14; ++k) {
    z.push_back(10 * k);
    area2.push_back(52.0 - 0.0011 * std::pow(10.0 * static_cast<double>(k) - 15.0, 2) +
                    Noise(static_cast<uint64_t>(k) + 99));
    area3.push_back(44.0 - 0.0012 * std::pow(10.0 * static_cast<double>(k) - 15.0, 2) +
                    Noise(static_cast<uint64_t>(k) + 55));
    error.push_back(1.1);
  }
  const auto curve = [&](const char* name, const nlohmann::json& area, const char* symbol) {
    return nlohmann::json{{"type", "scatter"},
                          {"mode", "lines+markers"},
                          {"name", name},
                          {"x", z},
                          {"y", area},
                          {"marker", {{"symbol", symbol}}},
                          {"error_y", {{"type", "data"}, {"array", error}}}};
  };
  report.Heading("The scan");
  report.Plot("Usable area along the scan, with its 95 % interval.",
              {curve("marker 2", area2, "circle"), curve("marker 3", area3, "square")},
              {{"xaxis", {{"title", {{"text", "position of the oval, z (mm)"}}}}},
               {"yaxis", {{"title", {{"text", "usable area (%)"}}}, {"rangemode", "tozero"}}}});

  nlohmann::json map = nlohmann::json::array();
  for (int row = 0; row < 18; ++row) {
    std::vector<double> line;
    line.reserve(24);
    for (int column = 0; column < 24; ++column) {
      line.push_back(std::round(1000.0 * std::exp(-0.01 * (row * row + 0.4 * column * column))) /
                     10);
    }
    map.push_back(line);
  }
  report.Plot("Hit rate over incidence angle and size of the marker in the picture.",
              {{{"type", "heatmap"},
                {"z", map},
                {"dx", 4},
                {"x0", 2},
                {"dy", 2},
                {"y0", 40},
                {"colorbar", {{"title", {{"text", "hits (%)"}}}}}}},
              {{"xaxis", {{"title", {{"text", "incidence angle (degrees)"}}}}},
               {"yaxis", {{"title", {{"text", "width of the marker (px)"}}}}}});

  nlohmann::json bars = nlohmann::json::array();
  for (size_t reason = 1; reason < kReasons.size(); ++reason) {
    nlohmann::json counts = nlohmann::json::array();
    for (size_t camera = 0; camera < 6; ++camera) {
      counts.push_back(std::floor(60 * Noise(reason * 64 + camera * 7 + 3)));
    }
    bars.push_back({{"type", "bar"}, {"name", kReasons[reason]}, {"x", kCameras}, {"y", counts}});
  }
  report.Plot("Reasons of the misses by camera.", bars,
              {{"barmode", "stack"}, {"yaxis", {{"title", {{"text", "positions"}}}}}});
}

// A triangle on a dim mask, seen at `cosine`, with shot noise.
std::string MarkerPicture(int width, int height, double size_px, double cosine, uint64_t seed) {
  std::vector<uint8_t> rgb;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (x - 0.47 * width) / (size_px * cosine), v = (y - 0.44 * height) / size_px;
      const bool inside = v < 0.5 && v > 2.0 * std::abs(u) - 0.5;
      const double mask =
          std::hypot(x - 0.5 * width, 1.2 * (y - 0.6 * height)) < 0.36 * width ? 26.0 : 9.0;
      const auto key = seed * 7919 + static_cast<uint64_t>(y * width + x) * 4;
      const double noise = Noise(key) + Noise(key + 1) + Noise(key + 2) - 1.5;
      const double value =
          (inside ? 60.0 + 120.0 * cosine : mask) * (1.0 + 0.12 * noise) + 5 * noise;
      rgb.insert(rgb.end(), 3, static_cast<uint8_t>(std::clamp(value, 0.0, 255.0)));
    }
  }
  return EncodeRgbPng(width, height, rgb);
}

void AddPictures(Report& report) {
  report.Heading("What the cameras record");
  std::vector<LabelledPicture> crops, whole;
  for (int k = 0; k < 6; ++k) {
    const double incidence = 12.0 * k;
    crops.push_back(
        {fmt::format("{}, {:.0f}°", kCameras[static_cast<size_t>(k)], incidence),
         MarkerPicture(64, 48, 22, std::cos(RadFromDeg(incidence)), static_cast<uint64_t>(k))});
  }
  whole.push_back({"front-middle, frontal", MarkerPicture(640, 480, 60, 1.0, 11)});
  whole.push_back({"front-left, oblique", MarkerPicture(640, 480, 60, 0.5, 12)});
  report.PictureGrid("Marker 3 at growing incidence angles, cut out of the pictures.", crops, 6);
  report.PictureGrid("Whole pictures of 640 x 480 pixels.", whole, 2,
                     {{"marker", "#b4b4b4"}, {"mask", "#1a1a1a"}});
  report.Comparison("Two pictures and a slider.", {"frontal", MarkerPicture(640, 480, 60, 1.0, 11)},
                    {"oblique", MarkerPicture(640, 480, 60, 0.5, 12)});
  report.Picture("One picture by itself.", MarkerPicture(320, 240, 60, 0.8, 13));
}

// A wave with a hole, and the ids of its quarters.
void AddChannels(Report& report) {
  constexpr int kWidth = 96, kHeight = 64;
  ReportChannel wave, slope, quarter;
  wave.name = "electrons.Y";
  wave.unit = "e-";
  slope.name = "difference";
  slope.kind = ReportChannel::Kind::kDifference;
  quarter.name = "id.object";
  quarter.kind = ReportChannel::Kind::kIds;
  quarter.names = {"upper left", "upper right", "lower left"};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool hole = std::hypot(x - 60, y - 20) < 6.0;
      wave.values.push_back(hole ? std::nanf("") : static_cast<float>(100 * x + y));
      slope.values.push_back(static_cast<float>(x - kWidth / 2));
      quarter.values.push_back(
          static_cast<float>((x < kWidth / 2 ? 0 : 1) + (y < kHeight / 2 ? 0 : 2)));
    }
  }
  report.Channels("A picture's channels: values, a difference, ids.", kWidth, kHeight,
                  {wave, slope, quarter});
}

// Two triangles before a camera, the second of which comes nearer.
void AddRoom(Report& report) {
  RoomFigure room;
  room.choice = "Distance";
  const auto pane = [](double x) -> nlohmann::json {
    return {{"type", "mesh3d"},
            {"x", {x, x, x, x}},
            {"y", {-50, 50, 50, -50}},
            {"z", {-50, -50, 50, 50}},
            {"i", {0, 0}},
            {"j", {1, 2}},
            {"k", {2, 3}},
            {"intensity", {1, 2}},
            {"intensitymode", "cell"},
            {"cmin", 0},
            {"cmax", 2}};
  };
  room.traces.push_back({{"type", "scatter3d"},
                         {"mode", "markers+text"},
                         {"name", "camera"},
                         {"x", {300}},
                         {"y", {0}},
                         {"z", {0}},
                         {"text", {"camera"}}});
  room.states.push_back({"far", nlohmann::json::array({pane(0.0)})});
  room.states.push_back({"near", nlohmann::json::array({pane(100.0)})});
  report.Room("A room with a choice of two states.", room, 420);
}

void AddTables(Report& report) {
  const std::vector<std::string> columns = {"marker", "pose", "set", "usable_mm2", "usable_pct"};
  std::vector<std::vector<std::string>> rows;
  CsvWriter csv(columns);
  for (const int marker : {2, 3}) {
    for (const Pose& pose : kPoses) {
      for (const char* set : {"satisfies", "front", "back", "both", "all", "expanded"}) {
        const double share = 0.2 + 0.4 * Noise(rows.size() + 17);
        rows.push_back({fmt::format("{}", marker), pose.name, set,
                        fmt::format("{:.0f}", 80133.0 * share),
                        fmt::format("{:.1f}", 100 * share)});
        csv.Row(rows.back());
      }
    }
  }
  report.Heading("The numbers");
  report.Table("Usable area by marker, pose and set.", columns, rows);
  report.Attachment("usable.csv", csv.Text());
  report.Attachment("notes.txt", "A text with </script>, <b>markup</b>, & and \"quotes\".\n");
}

Report DemoReport() {
  Report report("Where can markers sit? <Demo> & more", "Made-up data: what a report can show");
  report.KeyFigures({{"Usable area, marker 2", "46.9", "%", "37,582 mm² of the face half"},
                     {"Usable area, marker 3", "39.5", "%", "31,652 mm² of the face half"},
                     {"In every pose", "11.2", "%", "front and back cameras"},
                     {"Pictures", "14,112", "", "at 32 samples a pixel"}});
  report.Paragraph(
      "A marker counts where **at least two of the six cameras** identify it. Both markers satisfy "
      "the criteria on top of the oval; towards the rims the incidence angle ends it. The pair of "
      "back cameras is only 10.66° apart. The table `hits.csv` has every picture.");
  AddMaps(report);
  AddPlots(report);
  AddPictures(report);
  AddChannels(report);
  AddRoom(report);
  AddTables(report);
  report.Heading("How this was made");
  report.Paragraph(
      "`retrolux study markers --out DIR --seed 1`, and then <script>nothing</script>.");
  return report;
}

}  // namespace
}  // namespace retrolux

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: report_demo FILE.html\n", stderr);
    return 2;
  }
  try {
    retrolux::DemoReport().Write(arguments[1]);
  } catch (const retrolux::InputError& error) {
    std::fprintf(stderr, "report_demo: %s\n", error.what());
    return 2;
  }
}
