// retrolux stereo DIR --out DIR
#include <fmt/format.h>

#include "analysis/stereo_files.h"
#include "classifier/method.h"
#include "cli/command_tree.h"
#include "cli/run_json.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

struct StereoCommand {
  StereoFolderOptions stereo;
  std::string point = "centre";
  std::filesystem::path out;
};

std::string Text(const StereoFolder& folder) {
  std::string text;
  for (size_t m = 0; m < folder.result.markers.size(); ++m) {
    const StereoMarker& marker = folder.result.markers[m];
    text += fmt::format("{:<12} ", marker.name);
    if (!marker.point) {
      text += marker.refusal + "\n";
      continue;
    }
    const Vec3d& at = marker.point->position;
    text += fmt::format("{:9.3f} {:9.3f} {:9.3f} mm", at.x(), at.y(), at.z());
    if (const auto error = folder.Error_mm(m))
      text += fmt::format("  error {:.3f} mm", error->norm());
    text += "\n";
  }
  const auto& pose = folder.result.pose;
  if (!pose) return text + "no pose: " + folder.result.pose_refusal + "\n";
  text += fmt::format("pose from {} markers: FRE {:.3f} mm, TRE at the isocentre {:.3f} mm",
                      pose->pairs.size(), pose->fre_mm, pose->Tre_mm(Vec3d::Zero()));
  if (const auto& error = folder.pose_error)
    text += fmt::format("; error {:.3f} mm, {:.3f} degrees", error->translation_mm.norm(),
                        error->rotation_deg);
  return text + "\n";
}

int RunStereo(StereoCommand command, const GlobalOptions& global) {
  StereoOptions& options = command.stereo.stereo;
  options.point = command.point == "light" ? MarkerPoint::kLight : MarkerPoint::kCentre;
  const StudyRun run(global);
  const StereoFolder folder = ReconstructFolder(command.stereo);
  EnsureWritableFolder(command.out);
  WriteStereoFiles(folder, options, command.out);
  WriteStereoReport(folder, options, command.stereo.folder, command.out, global.command_line);
  run.Write(command.out,
            {{"cameras", folder.views.size()}, {"markers", folder.result.markers.size()}});
  const auto report = command.out / "report.html";
  nlohmann::json summary = StereoJson(folder, options);
  PrintResult(global, summary, Text(folder) + fmt::format("report: {}", report.string()));
  return kExitGood;
}

}  // namespace

void SetUpStereo(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StereoCommand>();
  CLI::App* sub = app.add_subcommand(
      "stereo", "Markers in space and the mask's pose from the pictures of several cameras");
  sub->footer(
      "DIR holds cameras.yml and a picture NAME.png of each of its cameras, as `retrolux render`\n"
      "writes them. Detections: --detections, else DIR/detections.json, else by --method.\n"
      "Where the markers are on the mask: --constellation, else DIR/truth.json, else unknown: "
      "then\n"
      "identified markers are reconstructed, standard ones are not, and there is no pose.");
  StereoFolderOptions& stereo = command->stereo;
  sub->add_option("folder", stereo.folder, "folder of a shot")->required();
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--method", stereo.method, "identification method")
      ->type_name(ChoiceType(MethodNames()))
      ->capture_default_str();
  sub->add_option("--detections", stereo.detections, "detections.json of any detector");
  sub->add_option("--constellation", stereo.constellation,
                  "where the markers are in the mask's frame, retrolux/constellation-1");
  sub->add_option(
         "--point", command->point,
         "of a marker's image: centre (middle of the shape by the fit) or light (centroid)")
      ->check(CLI::IsMember({"centre", "light"}))
      ->capture_default_str();
  sub->add_option("--sigma-px", stereo.stereo.sigma_px,
                  "noise of a detection in px, for the standard deviations")
      ->check(CLI::Range(1e-4, 100.0))
      ->capture_default_str();
  sub->add_option("--max-residual-px", stereo.stereo.triangulation.max_residual_px,
                  "views that lie further off are outliers")
      ->check(CLI::Range(1e-3, 1000.0))
      ->capture_default_str();
  sub->add_option("--max-residual-mm", stereo.stereo.max_residual_mm,
                  "markers that lie further from the constellation do not count for the pose")
      ->check(CLI::Range(1e-3, 1000.0))
      ->capture_default_str();
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStereo(*command, global); };
  });
}

}  // namespace retrolux::cli
