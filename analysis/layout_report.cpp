#include <algorithm>

#include "analysis/layout_study.h"
#include "analysis/plotly_figure.h"
#include "analysis/raised_picture.h"
#include "analysis/report.h"
#include "analysis/room_figure.h"
#include "core/atomic_file.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

class LayoutReport {
 public:
  LayoutReport(const LayoutStudy& study, fs::path folder)
      : study_(study),
        folder_(std::move(folder)),
        report_("Markers that work together",
                fmt::format("{}, mask {}, method {}; retrolux " RETROLUX_VERSION, study.scene,
                            study.options.mask, study.options.method)) {}

  Report Compose(const Scene& room, const std::string& command) {
    Summary();
    Counts();
    Errors();
    Places();
    Pictures();
    Room(room);
    report_.HowMade(command);
    for (const char* file : {"layout.json", "sightings.csv", "pairs.csv"})
      report_.Attachment(file, ReadTextFile(folder_ / file));
    return std::move(report_);
  }

 private:
  void Summary() {
    double position = 0.0, rotation = 0.0;
    for (size_t p = 0; p < study_.options.poses.size(); ++p) {
      position = std::max(position, study_.Best(p).position_error_mm.value_or(0.0));
      rotation = std::max(rotation, study_.Best(p).rotation_error_deg.value_or(0.0));
    }
    report_.KeyFigures(
        {{"least names in common", std::to_string(study_.Margin() + 3), "",
          fmt::format("by the best pair, in the worst of {} poses; three are needed",
                      study_.options.poses.size())},
         {"misnamed", std::to_string(study_.misnamed), "", "of all names in all pictures"},
         {"largest position error", fmt::format("{:.3f}", position), "mm",
          "of the mask's origin, by the best pair"},
         {"largest rotation error", fmt::format("{:.3f}", rotation), "deg", "likewise"}});
    report_.Paragraph(
        "All markers are on the mask at once, lit by all rings. A pair counts what both of its "
        "cameras named rightly in their noisy pictures; a pose of the mask needs three. Pairs that "
        "stand closer than the smallest separation are left out.");
  }

  Json Trace(const std::string& name, const std::function<Json(size_t)>& value) const {
    Json x = Json::array(), y = Json::array();
    for (size_t p = 0; p < study_.options.poses.size(); ++p) {
      x.push_back(study_.options.poses[p].translation.z());
      y.push_back(value(p));
    }
    return {{"type", "scatter"}, {"mode", "lines+markers"}, {"name", name}, {"x", x}, {"y", y}};
  }

  int Named(size_t pose, size_t camera) const {
    const auto& markers = study_.sightings[pose][camera];
    return static_cast<int>(std::count_if(markers.begin(), markers.end(),
                                          [](const auto& s) { return s.named == s.marker; }));
  }

  void Counts() {
    report_.Heading("How many names in common");
    Json best = Json::array(
        {Trace("best pair", [&](size_t p) { return Json(study_.Best(p).common.size()); }),
         Trace("pairs that have three", [&](size_t p) {
           return Json(std::count_if(study_.pairs.begin(), study_.pairs.end(), [&](const auto& q) {
             return q.pose == p && q.common.size() >= 3;
           }));
         })});
    const Json z = {{"xaxis", AxisTitle("mask along z / mm")},
                    {"yaxis", {{"title", {{"text", "count"}}}, {"rangemode", "tozero"}}}};
    report_.Plot("Markers that the best pair names, and pairs that name three or more", best, z);
    Json cameras = Json::array();
    for (size_t c = 0; c < study_.cameras.size(); ++c)
      cameras.push_back(Trace(study_.cameras[c], [&](size_t p) { return Json(Named(p, c)); }));
    report_.Plot("Markers that each camera names", cameras, z);
  }

  void Errors() {
    const auto or_null = [](const std::optional<double>& v) { return v ? Json(*v) : Json(); };
    report_.Heading("The mask's pose");
    report_.Plot(
        "Error of the pose that the best pair's two pictures give, and what is expected of its "
        "markers (Fitzpatrick's TRE)",
        Json::array({Trace("position, measured",
                           [&](size_t p) { return or_null(study_.Best(p).position_error_mm); }),
                     Trace("position, expected",
                           [&](size_t p) { return Json(study_.Best(p).expected_tre_mm); })}),
        {{"xaxis", AxisTitle("mask along z / mm")},
         {"yaxis", {{"title", {{"text", "error of the origin / mm"}}}, {"rangemode", "tozero"}}}});
  }

  void Places() {
    report_.Heading("The places");
    std::vector<std::vector<std::string>> rows;
    for (const MarkerSpec& m : study_.markers) {
      rows.push_back({m.name, fmt::format("{:.1f}", m.at.x()), fmt::format("{:.1f}", m.at.y()),
                      fmt::format("{:.1f}", m.at.z())});
    }
    report_.Table("On the mask, in the frame of its object, mm", {"marker", "x", "y", "z"}, rows);
  }

  void Pictures() {
    std::vector<LabelledPicture> pictures;
    for (const Pose& pose : study_.options.poses) {
      for (const std::string& camera : study_.cameras) {
        const fs::path file = folder_ / "pictures" / fmt::format("{}_{}.png", pose.name, camera);
        if (fs::is_regular_file(file))
          pictures.push_back({fmt::format("{}, {}", pose.name, camera),
                              EncodeGreyPng(DarkLevelsRaised(ReadGrey(file)))});
      }
    }
    if (pictures.empty()) return;
    report_.Heading("What the cameras record");
    report_.PictureGrid("Both ends and the middle; dark levels raised (gamma 2.2)", pictures, 3);
  }

  // The poses nearest to both ends and to the middle of the scan.
  void Room(const Scene& room) {
    const std::vector<Pose>& poses = study_.options.poses;
    const auto by_z = [](const Pose& a, const Pose& b) {
      return a.translation.z() < b.translation.z();
    };
    const auto by_distance = [](const Pose& a, const Pose& b) {
      return std::abs(a.translation.z()) < std::abs(b.translation.z());
    };
    std::vector<RoomScene> states;
    for (const Pose& pose : {*std::min_element(poses.begin(), poses.end(), by_distance),
                             *std::min_element(poses.begin(), poses.end(), by_z),
                             *std::max_element(poses.begin(), poses.end(), by_z)}) {
      RoomScene& state = states.emplace_back();
      state.label = fmt::format("z {:+.0f} mm", pose.translation.z());
      state.scene = LayoutScene(room, study_.options).AtPose(pose);
      state.scene.markers = study_.markers;
      state.numbers = CamerasThatSee(state.scene, "mask");
    }
    report_.Heading("The room");
    report_.Room(
        "Cameras with their rings and fields of view, the markers, and the mask coloured by how "
        "many cameras see it.",
        DrawRoom("Position of the patient", states));
  }

  const LayoutStudy& study_;
  fs::path folder_;
  Report report_;
};

}  // namespace

void WriteLayoutReport(const LayoutStudy& study, const Scene& room, const fs::path& folder,
                       const std::string& command_line) {
  LayoutReport(study, folder).Compose(room, command_line).Write(folder / "report.html");
}

}  // namespace retrolux
