#include "analysis/render_report.h"

#include <algorithm>

#include "analysis/picture_channels.h"
#include "analysis/raised_picture.h"
#include "analysis/room_figure.h"
#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/image_file.h"

namespace retrolux {

using Json = nlohmann::json;

namespace {

Json ReadTruth(const std::filesystem::path& file) {
  const Json truth = Json::parse(ReadTextFile(file), nullptr, false);
  if (!truth.is_object() || !truth.contains("cameras"))
    throw InputError::At(file, "", "no cameras", "the truth.json of a render");
  return truth;
}

// What markers are on, else a mask, else the first thing there is.
std::string CentreOf(const Scene& scene) {
  if (!scene.markers.empty()) return scene.markers.front().object;
  const bool mask = std::any_of(scene.objects.begin(), scene.objects.end(),
                                [](const SceneObject& object) { return object.name == "mask"; });
  return mask ? "mask" : scene.objects.front().name;
}

void AddRoom(const Scene& scene, Report& report) {
  if (scene.objects.empty() || scene.cameras.empty()) return;
  const std::string centre = CentreOf(scene);
  report.Heading("The room");
  report.Room(fmt::format("The scene `{}`: cameras with their rings and fields of view; `{}` is "
                          "coloured by how many cameras see it",
                          scene.name, centre),
              DrawRoom("Scene", {{scene.name, scene, CamerasThatSee(scene, centre)}}, centre));
}

double HeaderNumber(const PictureChannels& picture, const char* key) {
  const auto text = picture.attributes.find(key);
  return text == picture.attributes.end() ? 0.0 : CellNumber(text->second).value_or(0.0);
}

// What the sensor would give without noise and with as many bits as it takes.
std::string NoiselessPng(const PictureChannels& picture, int bits) {
  const ReportChannel& electrons = *picture.Find("electrons.Y");
  const double gain_dn_e = HeaderNumber(picture, "retrolux/gain_dn_e");
  const double offset_dn = HeaderNumber(picture, "retrolux/offset_dn");
  const double most_dn = (1 << bits) - 1;
  DigitalImage image{Plane<uint16_t>(picture.width, picture.height), bits};
  for (size_t i = 0; i < electrons.values.size(); ++i) {
    const double dn = offset_dn + gain_dn_e * static_cast<double>(electrons.values[i]);
    image.dn.data[i] = static_cast<uint16_t>(std::clamp(dn, 0.0, most_dn) + 0.5);
  }
  return EncodeGreyPng(DarkLevelsRaised(image));
}

void AddPictures(const std::filesystem::path& folder, const Json& cameras, Report& report) {
  report.Heading("What the cameras record");
  for (const auto& [name, camera] : cameras.items()) {
    const std::filesystem::path png = folder / (name + ".png"), exr = folder / (name + ".exr");
    if (!std::filesystem::exists(png) || !std::filesystem::exists(exr)) continue;
    const DigitalImage recorded = ReadGrey(png);
    const PictureChannels picture = ReadChannels(exr);
    report.Comparison(
        fmt::format("Camera `{}`, dark levels raised (gamma 2.2): what the sensor gives, and the "
                    "same light without noise",
                    name),
        {"recorded", EncodeGreyPng(DarkLevelsRaised(recorded))},
        {"without noise", NoiselessPng(picture, recorded.bits)});
  }
}

std::string Number(const Json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "";
}

void AddMarkers(const Json& cameras, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, camera] : cameras.items()) {
    for (const Json& m : camera.at("markers")) {
      const Json& px = m.at("centroid_outline_px");
      rows.push_back(
          {name, m.at("name"), m.at("marker").dump(), px.is_array() ? Number(px[0], "{:.2f}") : "",
           px.is_array() ? Number(px[1], "{:.2f}") : "", Number(m.at("visible_fraction"), "{:.3f}"),
           Number(m.at("incidence_deg"), "{:.1f}"), Number(m.at("distance_mm"), "{:.0f}"),
           m.at("in_frame").get<bool>() ? "yes" : "no"});
    }
  }
  if (rows.empty()) return;
  report.Heading("The markers");
  report.Table("What is true of each marker in each camera (truth.json has more)",
               {"camera", "name", "marker", "u / px", "v / px", "visible fraction",
                "incidence / deg", "distance / mm", "in frame"},
               rows);
}

}  // namespace

Report RenderReport(const std::filesystem::path& folder, const std::optional<Scene>& scene,
                    const std::string& command) {
  const Json truth = ReadTruth(folder / "truth.json");
  const Json& cameras = truth.at("cameras");
  Report report(
      "What the cameras of a scene record",
      fmt::format("{} cameras; pixel (0, 0) is the centre of the top-left pixel", cameras.size()));
  AddPictures(folder, cameras, report);
  AddMarkers(cameras, report);
  if (scene) {
    AddRoom(*scene, report);
  } else {
    report.Paragraph("The scene could not be loaded again, so that the room is not drawn.");
  }
  report.HowMade(command);
  report.Paragraph("`retrolux view NAME.exr` shows any channel of a picture, value by value.");
  for (const char* file : {"truth.json", "cameras.yml"}) {
    if (std::filesystem::exists(folder / file))
      report.Attachment(file, ReadTextFile(folder / file));
  }
  return report;
}

}  // namespace retrolux
