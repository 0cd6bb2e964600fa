// retrolux study hotspot --out DIR
#include <fmt/format.h>

#include <cmath>

#include "analysis/hotspot_placement_verdict.h"
#include "analysis/hotspot_study.h"
#include "cli/run_json.h"
#include "cli/study.h"
#include "scenes/scene_json.h"

namespace retrolux::cli {

namespace {

constexpr const char* kNone = "none";
constexpr const char* kAll = "all";

struct StudyHotspotCommand {
  std::filesystem::path out;
  std::string angles = "2:40:1";
  std::string scene = "ct-room";
  std::string placement;
  std::string scenario;
  int rotations = 8;
  bool indirect = false;
  bool angles_given = false;  // on the command line
  std::vector<std::string> variations = {kAll};
  int spp = 4;
  bool quick = false;
  HotspotStudyOptions study;
};

// "2:40:1" (from, to, step) or "2,5,10".
std::vector<double> ParseAngles(const std::string& text) {
  const auto fail = [&]() -> double {
    throw InputError(fmt::format(
        "--angles: found '{}'; expected FROM:TO:STEP or a list, in degrees, such as 2:40:1", text));
  };
  const char separator = text.find(':') != std::string::npos ? ':' : ',';
  std::vector<double> numbers;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    char* rest = nullptr;
    const double number = std::strtod(part.c_str(), &rest);
    numbers.push_back(part.empty() || *rest != '\0' || !std::isfinite(number) ? fail() : number);
    begin = end + 1;
  }
  if (separator == ',') return numbers;
  if (numbers.size() != 3 || !(numbers[2] >= 0.01) || numbers[1] < numbers[0]) fail();
  std::vector<double> angles;
  const auto steps = static_cast<int>((numbers[1] - numbers[0]) / numbers[2] + 1e-9);
  for (int i = 0; i <= steps; ++i) angles.push_back(numbers[0] + i * numbers[2]);
  return angles;
}

void SetSamples(int spp, HotspotSamples& samples) {
  samples = {spp, 4 * spp, 8 * spp, std::max(1, spp / 4)};
}

void MakeQuick(StudyHotspotCommand& command) {
  command.angles = "2,5,10,15,20,30,40";
  command.study.variation_angles_deg = {5, 15, 30};
  command.study.placements = 1;
  command.study.shot.exposures = 4;
  command.study.shot.powers = {};
  command.spp = 2;
  command.rotations = 2;
}

// Without the marks of bold type and of code.
std::string Plain(std::string text) {
  std::erase_if(text, [](char c) { return c == '*' || c == '`'; });
  return text;
}

std::string Text(const HotspotStudy& study) {
  std::string text;
  if (study.placement) {
    for (const std::string& sentence : VerdictOf(*study.placement)) text += Plain(sentence) + "\n";
  }
  const HotspotSeries& series = study.series.front();
  if (series.rows.empty()) return text;
  text += "from which separation on does the neighbour change nothing?\n";
  for (const HotspotLimit& limit : LimitsOf(series.rows, study.Mix("both"))) {
    text += fmt::format("  {:<26} {:<18} ({})\n", limit.criterion->name,
                        LimitText(limit, series.rows), limit.criterion->meaning);
  }
  return text;
}

int RunStudyHotspot(StudyHotspotCommand command, const GlobalOptions& global) {
  if (command.quick) MakeQuick(command);
  HotspotStudyOptions& options = command.study;
  // A placement is a question of its own.
  if (command.placement.empty() || command.angles_given)
    options.angles_deg = ParseAngles(command.angles);
  options.shot.seed = global.seed;
  options.shot.noise_seed = global.NoiseSeed();
  SetSamples(command.spp, options.shot.samples);
  if (!command.placement.empty()) {
    options.placement = {ReadHotspotVault(command.placement, command.scenario), command.rotations,
                         command.indirect};
  } else if (command.scene != kNone) {
    options.room = LoadScene(command.scene);
  }
  if (options.angles_deg.empty()) command.variations = {kNone};
  if (command.variations == std::vector<std::string>{kAll}) {
    for (const HotspotVariation& variation : HotspotVariations())
      options.variations.emplace_back(variation.name);
  } else if (command.variations != std::vector<std::string>{kNone}) {
    options.variations = command.variations;
  }
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const HotspotStudy study = RunHotspotStudy(options, command.out, *progress);
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  WriteHotspotStudyFiles(study, command.out);
  WriteHotspotStudyReport(study, command.out, global.command_line);
  run.Write(command.out, {{"views", study.tasks.done_before + study.tasks.done_now},
                          {"tasks", TasksJson(study.tasks)}});
  const std::filesystem::path report = command.out / "report.html";
  const std::string tasks = study.tasks.Text();
  PrintResult(global, HotspotSummary(study),
              Text(study) + fmt::format("{:.1f} s{}\nreport: {}", run.Seconds(),
                                        tasks.empty() ? "" : "; " + tasks, report.string()));
  return kExitGood;
}

}  // namespace

void SetUpStudyHotspot(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyHotspotCommand>();
  CLI::App* sub = study.add_subcommand(
      "hotspot",
      "What do the rings of neighbouring cameras do to a picture, over the angle between them? "
      "Highlights, retro-reflection's tail, overlapping beams, glare, saturation, one by one");
  HotspotSetup& setup = command->study.setup;
  HotspotShotOptions& shot = command->study.shot;
  shot.powers = {4.0};
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--angles", command->angles, "separations, degrees: FROM:TO:STEP or a list")
      ->capture_default_str();
  CLI::Option* scene =
      sub->add_option("--scene", command->scene,
                      "a room as it stands, with an object 'mask': what do all its rings do to "
                      "each of its pictures? 'none': no room")
          ->capture_default_str();
  CLI::Option* placement =
      sub->add_option("--placement", command->placement,
                      "solution.json of study vault: which pairs of its cameras have hot spots, at "
                      "which rotations of the mask? In place of the room, and without --angles of "
                      "the angles")
          ->excludes(scene);
  sub->add_option("--scenario", command->scenario,
                  "with --placement: a simulation or scenario file in place of the solution's own")
      ->needs(placement);
  sub->add_option("--rotations", command->rotations,
                  "with --placement: how many rotations of the mask are rendered, the worst by "
                  "their forecast; 162 are all of the face")
      ->check(CLI::Range(1, 100000))
      ->needs(placement)
      ->capture_default_str();
  sub->add_flag("--indirect", command->indirect,
                "with --placement: light that is reflected more than once, too, which wants 16 "
                "times the --spp")
      ->needs(placement);
  sub->add_option("--variations", command->variations,
                  "changes of the setup that are tried at fewer angles: names, all or none")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--placements", command->study.placements,
                  "random places of the mask at each angle")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub->add_option("--exposures", shot.exposures, "noisy pictures of each")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  sub->add_option("--powers", shot.powers, "of the neighbours' rings, relative, beside 1")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  sub->add_option("--spp", command->spp,
                  "samples per pixel of the mask; 4 times as many on markers, 8 times at edges")
      ->check(CLI::Range(1, 1 << 14))
      ->capture_default_str();
  sub->add_option("--mask", setup.mask, "oval or face")->capture_default_str();
  sub->add_option("--roughness", setup.roughness, "GGX width of the mask's coat")
      ->capture_default_str();
  sub->add_option("--material", setup.sheeting, "sheeting of the markers")->capture_default_str();
  sub->add_option("--ring-radius", setup.ring_radius_mm, "of all rings, mm")->capture_default_str();
  sub->add_option("--half-angle", setup.half_angle_deg, "of all diodes, degrees")
      ->capture_default_str();
  sub->add_option("--neighbour-peak", setup.neighbour_nm,
                  "of the neighbours' diodes, nm; their own filters follow")
      ->capture_default_str();
  sub->add_option("--neighbour-width", setup.neighbour_fwhm_nm,
                  "of the neighbours' diodes at half maximum, nm")
      ->capture_default_str();
  sub->add_option("--exposure", setup.exposure, "in units of the derived exposure")
      ->capture_default_str();
  sub->add_option("--glare", setup.veiling_glare, "veiling glare of the lens, share")
      ->capture_default_str();
  sub->add_flag("--ccd", setup.ccd, "a CCD with blooming, and smear of 1e-5");
  sub->add_option("--cameras", setup.cameras, "in a row; the first looks")->capture_default_str();
  sub->add_option("--distance", setup.distance_mm, "of all cameras from the isocentre, mm")
      ->capture_default_str();
  sub->add_flag("--quick", command->quick,
                "seven angles, two rotations of a placement, few and noisier pictures");
  sub->callback([command, sub, &global, &run] {
    command->angles_given = sub->count("--angles") > 0;
    run = [command, &global] { return RunStudyHotspot(*command, global); };
  });
}

}  // namespace retrolux::cli
