#include "analysis/stereo_files.h"

#include <fmt/format.h>

#include <cmath>

#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using Json = nlohmann::ordered_json;

Json Vector(const Vec3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json Matrix(const Mat3d& m) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 9; ++i) rows.push_back(m(i / 3, i % 3));
  return rows;
}

Json NumberJson(int number) {
  return number == 0 ? Json("standard") : Json(number);
}

Json ViewJson(const StereoFolder& folder, const StereoMarker& marker, const StereoSighting& seen) {
  Json view = {{"camera", folder.views[seen.view].camera.name},
               {"detection", seen.detection},
               {"named_by", seen.by_position ? "position" : "shape"},
               {"used", seen.used},
               {"residual_px", nullptr}};
  if (marker.point && seen.residual_px.allFinite())
    view["residual_px"] = {seen.residual_px.x(), seen.residual_px.y()};
  return view;
}

Json MarkerJson(const StereoFolder& folder, size_t index) {
  const StereoMarker& marker = folder.result.markers[index];
  Json json = {{"name", marker.name},       {"marker", NumberJson(marker.number)},
               {"at_mm", nullptr},          {"sigma_mm", nullptr},
               {"covariance_mm2", nullptr}, {"rms_px", nullptr},
               {"refusal", nullptr},        {"views", Json::array()},
               {"true_mm", nullptr},        {"error_mm", nullptr}};
  if (marker.point) {
    json["at_mm"] = Vector(marker.point->position);
    json["sigma_mm"] = Vector(marker.point->covariance.diagonal().cwiseSqrt());
    json["covariance_mm2"] = Matrix(marker.point->covariance);
    json["rms_px"] = marker.point->rms_px;
  } else {
    json["refusal"] = marker.refusal;
  }
  for (const StereoSighting& seen : marker.sightings)
    json["views"].push_back(ViewJson(folder, marker, seen));
  if (const auto& truth = folder.truth_of[index]) json["true_mm"] = Vector(folder.truth[*truth].at);
  if (const auto error = folder.Error_mm(index)) json["error_mm"] = Vector(*error);
  return json;
}

Json PoseJson(const StereoFolder& folder) {
  const MaskPose& pose = *folder.result.pose;
  Json json = {{"R_world_from_mask", Matrix(pose.world_from_mask.rotation)},
               {"t_world_from_mask_mm", Vector(pose.world_from_mask.translation)},
               {"fre_mm", pose.fre_mm},
               {"fle_mm", pose.fle_mm},
               {"tre_isocentre_mm", pose.Tre_mm(Vec3d::Zero())},
               {"markers", Json::array()},
               {"error", nullptr}};
  for (size_t i = 0; i < folder.result.pose_markers.size(); ++i) {
    json["markers"].push_back({{"name", folder.result.markers[folder.result.pose_markers[i]].name},
                               {"used", static_cast<bool>(pose.used[i])},
                               {"residual_mm", pose.residuals_mm[i]}});
  }
  if (folder.pose_error) {
    json["error"] = {{"translation_mm", Vector(folder.pose_error->translation_mm)},
                     {"rotation_deg", folder.pose_error->rotation_deg}};
  }
  return json;
}

std::string Number(double value) {
  return fmt::format("{:.6f}", value);
}

void AddNumbers(const std::optional<Vec3d>& v, std::vector<std::string>& cells) {
  for (Eigen::Index i = 0; i < 3; ++i) cells.push_back(v ? Number((*v)[i]) : "");
}

void WriteTable(const StereoFolder& folder, const std::filesystem::path& file) {
  CsvWriter table({"name",
                   "marker",
                   "x_mm",
                   "y_mm",
                   "z_mm",
                   "sigma_x_mm",
                   "sigma_y_mm",
                   "sigma_z_mm",
                   "views",
                   "views_used",
                   "views_named_by_position",
                   "residual_rms_px",
                   "true_x_mm",
                   "true_y_mm",
                   "true_z_mm",
                   "error_x_mm",
                   "error_y_mm",
                   "error_z_mm",
                   "error_mm",
                   "refusal"});
  for (size_t m = 0; m < folder.result.markers.size(); ++m) {
    const StereoMarker& marker = folder.result.markers[m];
    size_t used = 0, by_position = 0;
    for (const StereoSighting& seen : marker.sightings) {
      used += seen.used;
      by_position += seen.by_position;
    }
    std::optional<Vec3d> at, sigma, truth;
    if (marker.point) {
      at = marker.point->position;
      sigma = marker.point->covariance.diagonal().cwiseSqrt();
    }
    if (folder.truth_of[m]) truth = folder.truth[*folder.truth_of[m]].at;
    const auto error = folder.Error_mm(m);
    std::vector<std::string> cells = {
        marker.name, marker.number == 0 ? "standard" : std::to_string(marker.number)};
    AddNumbers(at, cells);
    AddNumbers(sigma, cells);
    cells.push_back(std::to_string(marker.sightings.size()));
    cells.push_back(std::to_string(used));
    cells.push_back(std::to_string(by_position));
    cells.push_back(marker.point ? Number(marker.point->rms_px) : "");
    AddNumbers(truth, cells);
    AddNumbers(error, cells);
    cells.push_back(error ? Number(error->norm()) : "");
    cells.push_back(marker.refusal);
    table.Row(cells);
  }
  table.Write(file);
}

Constellation Reconstructed(const StereoResult& result) {
  Constellation constellation;
  for (const StereoMarker& marker : result.markers) {
    if (marker.point) constellation.push_back({marker.name, marker.number, marker.point->position});
  }
  return constellation;
}

}  // namespace

std::optional<double> RmsError_mm(const StereoFolder& folder) {
  double sum = 0.0;
  int count = 0;
  for (size_t m = 0; m < folder.result.markers.size(); ++m) {
    const auto error = folder.Error_mm(m);
    if (!error) continue;
    sum += error->squaredNorm();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

Json StereoJson(const StereoFolder& folder, const StereoOptions& options) {
  Json json = {{"schema", "retrolux/stereo-1"},
               {"version", RETROLUX_VERSION},
               {"units", "mm, px, deg"},
               {"pixel_origin", "center"},
               {"frame", "world of cameras.yml"},
               {"point", options.point == MarkerPoint::kCentre ? "centre" : "light"},
               {"sigma_px", options.sigma_px},
               {"max_residual_px", options.triangulation.max_residual_px},
               {"detections", folder.detections_from},
               {"constellation", folder.constellation_from},
               {"cameras", Json::array()},
               {"markers", Json::array()},
               {"pose", nullptr},
               {"pose_refusal", nullptr},
               {"ambiguous", Json::array()},
               {"rms_error_mm", nullptr}};
  for (const CameraView& view : folder.views) json["cameras"].push_back(view.camera.name);
  for (size_t m = 0; m < folder.result.markers.size(); ++m)
    json["markers"].push_back(MarkerJson(folder, m));
  if (folder.result.pose) {
    json["pose"] = PoseJson(folder);
  } else {
    json["pose_refusal"] = folder.result.pose_refusal;
  }
  for (const auto& [view, name] : folder.result.ambiguous)
    json["ambiguous"].push_back({{"camera", folder.views[view].camera.name}, {"name", name}});
  if (const auto rms = RmsError_mm(folder)) json["rms_error_mm"] = *rms;
  return json;
}

void WriteStereoFiles(const StereoFolder& folder, const StereoOptions& options,
                      const std::filesystem::path& out) {
  WriteTable(folder, out / "markers3d.csv");
  WriteTextFile(out / "constellation.json",
                ConstellationJson(Reconstructed(folder.result)).dump(2) + "\n");
  WriteTextFile(out / "stereo.json", StereoJson(folder, options).dump(2) + "\n");
}

}  // namespace retrolux
