#include <fmt/format.h>

#include <cmath>

#include "analysis/mask_picture.h"
#include "analysis/plotly_figure.h"
#include "analysis/raised_picture.h"
#include "analysis/report.h"
#include "analysis/stereo_files.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;
using Colour = std::array<uint8_t, 3>;

constexpr Colour kByShape = {0, 158, 115}, kByPosition = {86, 180, 233}, kLeftOut = {213, 94, 0};

RgbPicture Grey(const DigitalImage& image) {
  RgbPicture picture(image.dn.width, image.dn.height, {0, 0, 0});
  for (int y = 0; y < image.dn.height; ++y) {
    for (int x = 0; x < image.dn.width; ++x) {
      const auto grey = static_cast<uint8_t>(image.dn(x, y));
      picture.Set(x, y, {grey, grey, grey});
    }
  }
  return picture;
}

void DrawCross(RgbPicture& picture, const Vec2d& px, const Colour& colour) {
  constexpr int kGap_px = 3, kArm_px = 10;
  const int u = static_cast<int>(std::lround(px.x())), v = static_cast<int>(std::lround(px.y()));
  const auto set = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < picture.width && y < picture.height) picture.Set(x, y, colour);
  };
  for (int i = kGap_px; i <= kArm_px; ++i) {
    set(u + i, v);
    set(u - i, v);
    set(u, v + i);
    set(u, v - i);
  }
}

const char* const kAxes[] = {"x", "y", "z"};

// The markers seen along one of the world's axes, with bars of 3 sigma.
PlotlyFigure SeenAlong(const StereoFolder& folder, Eigen::Index across, Eigen::Index up) {
  json x = json::array(), y = json::array(), x3 = json::array(), y3 = json::array(),
       names = json::array(), true_x = json::array(), true_y = json::array();
  for (size_t m = 0; m < folder.result.markers.size(); ++m) {
    const StereoMarker& marker = folder.result.markers[m];
    if (const auto& truth = folder.truth_of[m]) {
      true_x.push_back(folder.truth[*truth].at[across]);
      true_y.push_back(folder.truth[*truth].at[up]);
    }
    if (!marker.point) continue;
    x.push_back(marker.point->position[across]);
    y.push_back(marker.point->position[up]);
    x3.push_back(3.0 * std::sqrt(marker.point->covariance(across, across)));
    y3.push_back(3.0 * std::sqrt(marker.point->covariance(up, up)));
    names.push_back(marker.name);
  }
  PlotlyFigure figure;
  figure.traces.push_back(
      {{"type", "scatter"},
       {"mode", "markers"},
       {"name", "true"},
       {"x", true_x},
       {"y", true_y},
       {"marker", {{"symbol", "circle-open"}, {"size", 14}, {"color", kGrey}}}});
  figure.traces.push_back({{"type", "scatter"},
                           {"mode", "markers+text"},
                           {"name", "reconstructed, bars of 3 sigma"},
                           {"x", x},
                           {"y", y},
                           {"text", names},
                           {"textposition", "top center"},
                           {"error_x", {{"array", x3}}},
                           {"error_y", {{"array", y3}}},
                           {"marker", {{"color", kBlue}}}});
  json y_axis = AxisTitle(fmt::format("{} (mm)", kAxes[up]));
  y_axis["scaleanchor"] = "x";
  figure.layout = {{"xaxis", AxisTitle(fmt::format("{} (mm)", kAxes[across]))}, {"yaxis", y_axis}};
  figure.height_px = 520;
  return figure;
}

std::string Vector(const Vec3d& v, int digits) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v.x(), digits, v.y(), digits, v.z(), digits);
}

class StereoReport {
 public:
  StereoReport(const StereoFolder& folder, const StereoOptions& options)
      : folder_(folder),
        options_(options),
        report_("Markers in space",
                fmt::format("{} cameras; detections: {}; constellation: {}; retrolux {}",
                            folder.views.size(), folder.detections_from, folder.constellation_from,
                            RETROLUX_VERSION)) {}

  Report Compose(const std::filesystem::path& pictures, const std::string& command_line) {
    Summary();
    Places();
    Pose();
    Pictures(pictures);
    report_.HowMade(command_line);
    report_.Paragraph(fmt::format(
        "Triangulated is the {}. Standard deviations are those of {:g} px in each picture (five "
        "times as much for the fitted middle of shapes with less than five corners); views that "
        "lie more than {:g} px off are left out. Error: reconstructed minus true place of the "
        "middle of the marker's shape on its surface (docs/stereo.md).",
        options_.point == MarkerPoint::kCentre
            ? "middle of each marker's shape by the fit (where the method knows it, else the "
              "centroid)"
            : "centroid of each detection",
        options_.sigma_px, options_.triangulation.max_residual_px));
    return std::move(report_);
  }

 private:
  void Summary() {
    size_t found = 0;
    for (const StereoMarker& marker : folder_.result.markers) found += marker.point.has_value();
    std::vector<KeyFigure> figures = {{"Markers", std::to_string(found),
                                       fmt::format("of {}", folder_.result.markers.size()),
                                       "reconstructed"}};
    if (const auto rms = RmsError_mm(folder_))
      figures.push_back(
          {"Error", fmt::format("{:.3f}", *rms), "mm", "rms distance from the truth"});
    if (const auto& pose = folder_.result.pose) {
      figures.push_back({"FRE", fmt::format("{:.3f}", pose->fre_mm), "mm",
                         fmt::format("of {} markers", pose->pairs.size())});
      figures.push_back({"TRE", fmt::format("{:.3f}", pose->Tre_mm(Vec3d::Zero())), "mm",
                         "expected at the mask's origin"});
    }
    if (const auto& error = folder_.pose_error) {
      figures.push_back({"Pose, shift", fmt::format("{:.3f}", error->translation_mm.norm()), "mm",
                         "found minus true, at the mask's origin"});
      figures.push_back({"Pose, turn", fmt::format("{:.3f}", error->rotation_deg), "degrees", ""});
    }
    report_.KeyFigures(figures);
  }

  void Places() {
    report_.Heading("Markers");
    for (const auto& [across, up] : {std::pair<Eigen::Index, Eigen::Index>{1, 2}, {1, 0}}) {
      const PlotlyFigure figure = SeenAlong(folder_, across, up);
      report_.Plot(fmt::format("The markers over the world's {} and {}", kAxes[across], kAxes[up]),
                   figure.traces, figure.layout, figure.height_px);
    }
    std::vector<std::vector<std::string>> rows;
    for (size_t m = 0; m < folder_.result.markers.size(); ++m) {
      const StereoMarker& marker = folder_.result.markers[m];
      const auto error = folder_.Error_mm(m);
      std::string views;
      for (const StereoSighting& seen : marker.sightings) {
        views +=
            fmt::format("{}{}{}{}", views.empty() ? "" : ", ", folder_.views[seen.view].camera.name,
                        seen.by_position ? " (by position)" : "",
                        marker.point && !seen.used ? " (left out)" : "");
      }
      rows.push_back(
          {marker.name, marker.point ? Vector(marker.point->position, 3) : marker.refusal,
           marker.point ? Vector(marker.point->covariance.diagonal().cwiseSqrt(), 3) : "",
           marker.point ? fmt::format("{:.3f}", marker.point->rms_px) : "", views,
           error ? Vector(*error, 3) : "", error ? fmt::format("{:.3f}", error->norm()) : ""});
    }
    report_.Table("Markers in the world's frame",
                  {"marker", "x, y, z (mm)", "sigma (mm)", "residual (px)", "views",
                   "error x, y, z (mm)", "error (mm)"},
                  rows);
    for (const auto& [view, name] : folder_.result.ambiguous) {
      report_.Paragraph(
          fmt::format("**{}** in camera {}: more than one pattern could be it; refused.", name,
                      folder_.views[view].camera.name));
    }
  }

  void Pose() {
    report_.Heading("The mask's pose");
    if (!folder_.result.pose) {
      report_.Paragraph(fmt::format("None: {}.", folder_.result.pose_refusal));
      return;
    }
    const MaskPose& pose = *folder_.result.pose;
    std::vector<std::vector<std::string>> rows;
    for (size_t i = 0; i < pose.residuals_mm.size(); ++i) {
      rows.push_back({folder_.result.markers[folder_.result.pose_markers[i]].name,
                      fmt::format("{:.3f}", pose.residuals_mm[i]),
                      pose.used[i] ? "yes" : "left out"});
    }
    report_.Table("Distances that the registration of the constellation leaves",
                  {"marker", "distance (mm)", "used"}, rows);
    if (folder_.pose_error) {
      report_.Paragraph(fmt::format(
          "Found minus true: shift {} mm (x, y, z) at the mask's origin, turn {:.4f} degrees.",
          Vector(folder_.pose_error->translation_mm, 3), folder_.pose_error->rotation_deg));
    }
  }

  void Pictures(const std::filesystem::path& folder) {
    std::vector<LabelledPicture> pictures;
    for (size_t v = 0; v < folder_.views.size(); ++v) {
      const CameraView& view = folder_.views[v];
      const auto file = folder / (view.camera.name + ".png");
      if (!std::filesystem::is_regular_file(file)) continue;
      RgbPicture picture = Grey(DarkLevelsRaised(ReadGrey(file)));
      for (const StereoMarker& marker : folder_.result.markers) {
        for (const StereoSighting& seen : marker.sightings) {
          if (seen.view != v) continue;
          DrawCross(picture, PointOf(view.detections[seen.detection], options_.point),
                    !seen.used         ? kLeftOut
                    : seen.by_position ? kByPosition
                                       : kByShape);
        }
      }
      pictures.push_back({view.camera.name, picture.Png()});
    }
    if (pictures.empty()) return;
    report_.Heading("Pictures");
    report_.PictureGrid("What the cameras saw (gamma 2.2)", pictures, 2,
                        {{"named by its shape", kGreen},
                         {"named by its position", kSky},
                         {"left out", kVermillion}});
  }

  const StereoFolder& folder_;
  const StereoOptions& options_;
  Report report_;
};

}  // namespace

void WriteStereoReport(const StereoFolder& folder, const StereoOptions& options,
                       const std::filesystem::path& pictures, const std::filesystem::path& out,
                       const std::string& command_line) {
  StereoReport(folder, options).Compose(pictures, command_line).Write(out / "report.html");
}

}  // namespace retrolux
