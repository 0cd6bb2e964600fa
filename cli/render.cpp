// retrolux render SCENE --out DIR
#include <fmt/format.h>

#include "analysis/shot.h"
#include "cli/commands.h"
#include "cli/picture_size.h"
#include "cli/run_json.h"

namespace retrolux::cli {

namespace {

struct RenderCommand {
  std::string scene;
  std::filesystem::path out;
  std::string pose;
  std::string size;
  std::string rings = "all";
  ShotOptions shot;
};

int RunRender(RenderCommand command, const GlobalOptions& global) {
  const Scene scene = LoadSceneAs(command.scene, command.pose, command.size);
  command.shot.rings = command.rings == "own" ? RingChoice::kOwn : RingChoice::kAll;
  command.shot.trace.seed = global.seed;
  command.shot.noise_seed = global.NoiseSeed();
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const std::vector<std::string> files = RenderShot(scene, command.shot, command.out, *progress);
  const double seconds = run.Seconds();
  run.Write(command.out,
            {{"scene", command.scene}, {"pose", command.pose}, {"size", command.size}});
  PrintResult(global, {{"out", command.out.string()}, {"files", files}, {"seconds", seconds}},
              fmt::format("{}: {} in {:.1f} s", command.out.string(), JoinNames(files), seconds));
  return kExitGood;
}

}  // namespace

void SetUpRender(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<RenderCommand>();
  CLI::App* sub = app.add_subcommand("render",
                                     "Render what the cameras of a scene record: NAME.exr (all "
                                     "channels), NAME.png (DN), truth.json, cameras.yml");
  sub->add_option("scene", command->scene,
                  "built-in scene (see `retrolux scene list`) or scene.json")
      ->required();
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--camera", command->shot.cameras, "only these cameras, comma-separated")
      ->delimiter(',');
  sub->add_option("--pose", command->pose, "a pose of the scene; default: as given");
  sub->add_option("--spp", command->shot.trace.samples_per_pixel, "samples per pixel")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  sub->add_option("--edge-spp", command->shot.edge_samples_per_pixel,
                  "samples per pixel at the edges of objects and markers, where pictures are "
                  "noisiest; default: 4 times --spp")
      ->check(CLI::Range(1, 1 << 20));
  sub->add_option("--size", command->size, "WxH in px, same field of view; default: the camera's");
  sub->add_option("--rings", command->rings, "whose diodes are on: all, or each camera's own only")
      ->check(CLI::IsMember({"all", "own"}))
      ->capture_default_str();
  sub->add_flag("--ids-only", command->shot.ids_only,
                "only the id pass: ids, depth, position, normal; no light");
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunRender(*command, global); };
  });
}

}  // namespace retrolux::cli
