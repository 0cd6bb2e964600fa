// retrolux study vault --out DIR --simulation 1a
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "analysis/hotspot_limit.h"
#include "analysis/vault_report.h"
#include "analysis/vault_study.h"
#include "cli/picture_size.h"
#include "cli/run_json.h"
#include "cli/study.h"
#include "core/atomic_file.h"
#include "scenes/mask_mesh.h"
#include "scenes/masks.h"
#include "scenes/mesh_check.h"

namespace retrolux::cli {

namespace {

struct StudyVaultCommand {
  std::filesystem::path out;
  std::vector<std::string> simulations;
  std::string scenario;
  std::string mask = "face";
  std::string unit = "mm";
  std::string phase = "both";
  std::string placement;
  std::string visibility = "ids";
  double part_area_mm2 = 4.0;
  std::string size;
  std::string hotspot_limit;
  bool quick = false;
};

// The scenario with what an option changes of it.
Scenario Changed(const Scenario& scenario, const std::string& option, nlohmann::json change) {
  Scenario changed = scenario.With({option, std::move(change)});
  changed.variations = scenario.variations;
  return changed;
}

// The masks that the search is for. A mesh file takes the place of the face, or of the first mask.
std::vector<std::string> ChooseMasks(const StudyVaultCommand& command, Scenario& scenario) {
  std::vector<std::string> names;
  for (const auto& [name, spec] : scenario.masks) names.push_back(name);
  if (command.mask == "both") return names;
  if (scenario.masks.contains(command.mask)) return {command.mask};
  if (!std::filesystem::is_regular_file(command.mask)) {
    throw InputError(
        fmt::format("--mask {}: neither a mask of the scenario nor a file; expected {}, both, or a "
                    "mesh file",
                    command.mask, JoinNames(names)));
  }
  const std::string name = scenario.masks.contains("face") ? "face" : names.front();
  const std::string mesh = std::filesystem::absolute(command.mask).string();
  scenario =
      Changed(scenario, "--mask", {{"masks", {{name, {{"mesh", mesh}, {"unit", command.unit}}}}}});
  return {name};
}

void SetSize(const std::string& size, Scenario& scenario) {
  if (size.empty()) return;
  const auto [width, height] = ParseSize(size);
  scenario =
      Changed(scenario, "--size", {{"cameras", {{"width_px", width}, {"height_px", height}}}});
}

// In place of the scenario's least separation.
void SetHotspotLimit(const std::string& file, Scenario& scenario) {
  if (file.empty()) return;
  scenario = Changed(scenario, "--hotspot-limit",
                     {{"combinations", {{"min_separation_deg", HotspotLimit_deg(file)}}}});
}

VaultStudyOptions OptionsOf(const StudyVaultCommand& command) {
  VaultStudyOptions options;
  options.refine = command.phase != "1";
  options.extras = !command.quick;
  if (!command.placement.empty()) {
    options.placement = ReadPlacement(command.placement);
    options.refine = command.phase == "2";
  }
  return options;
}

// What is suspicious about masks that come from files.
void WarnOfMeshes(const Scenario& scenario, const std::vector<std::string>& masks) {
  const std::vector<std::string> built_in = MaskNames();
  for (const std::string& mask : masks) {
    const MaskSpec& spec = scenario.Mask(mask);
    if (std::find(built_in.begin(), built_in.end(), spec.mesh) != built_in.end()) continue;
    for (const std::string& warning : Warnings(CheckMesh(MaskMesh(spec, scenario.file))))
      Tell(fmt::format("warning: {}: {}", spec.mesh, warning));
  }
}

void Warn(const VaultStudy& study) {
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  if (study.views_cut > 0) {
    Tell(fmt::format(
        "warning: the mask is larger than the field of view in {} of {} views of the optimum; what "
        "falls beside a picture counts as not seen",
        study.views_cut, study.views));
  }
  if (study.rotations_too_close > 0) {
    Tell(fmt::format(
        "warning: in {} orientations the snout is fully contracted and still closer to the mask "
        "than the gap of {} mm",
        study.rotations_too_close, study.scenario.nozzle.gap_mm));
  }
}

std::string Text(const VaultStudy& study) {
  const PlacementResult& best = study.best.result;
  const VaultStudy::Rates& rates = study.rates;
  const std::string tasks = study.tasks.Text();
  return fmt::format(
      "simulation {}: phi_b {:g}, theta_1 {:.2f}, theta_2 {:.2f} deg: cost {:.4f}, {:.1f} cm2 seen "
      "by two or more of cameras {}\n"
      "{} placements x orientations in {:.1f} s ({:.0f} a second), {} views made ({:.0f} a "
      "second){}\n",
      study.scenario.name, best.Where().phi_b_deg, best.Where().theta1_deg, best.Where().theta2_deg,
      best.Cost(), best.Worst().worth.area_mm2 / 100.0, NameOf(best.Worst().worth.combination),
      rates.orientations, rates.seconds, static_cast<double>(rates.orientations) / rates.seconds,
      rates.buffers_made, static_cast<double>(rates.buffers_made) / rates.seconds,
      tasks.empty() ? "" : "; " + tasks);
}

nlohmann::json Figures(const VaultStudy& study) {
  const VaultStudy::Rates& rates = study.rates;
  return {{"placements", rates.placements},
          {"evaluations", rates.orientations},
          {"evaluations_per_second", static_cast<double>(rates.orientations) / rates.seconds},
          {"buffers", rates.buffers_made},
          {"buffers_asked", rates.buffers_asked},
          {"buffers_per_second", static_cast<double>(rates.buffers_made) / rates.seconds},
          {"tasks", TasksJson(study.tasks)}};
}

// One room after the other; what a mask shows is kept from one to the next.
class VaultCommand {
 public:
  VaultCommand(const StudyVaultCommand& command, const GlobalOptions& global)
      : command_(command),
        global_(global),
        stores_(VisibilityRuleNamed(command.visibility), command.part_area_mm2),
        progress_(MakeProgress(global)) {}

  const VaultStudy& Run(Scenario scenario, VaultStudyOptions options,
                        const std::filesystem::path& folder) {
    const StudyRun run(global_);
    SetSize(command_.size, scenario);
    SetHotspotLimit(command_.hotspot_limit, scenario);
    options.masks = ChooseMasks(command_, scenario);
    CheckInput(scenario, options);
    WarnOfMeshes(scenario, options.masks);
    EnsureWritableFolder(folder);
    studies_.push_back(RunVaultStudy(scenario, options, stores_, folder, *progress_));
    const VaultStudy& study = studies_.back();
    Warn(study);
    WriteVaultFiles(study, folder);
    WriteVaultReport(study, stores_, folder, global_.command_line);
    run.Write(folder, Figures(study));
    text_ += Text(study) + "report: " + (folder / "report.html").string() + "\n";
    summary_.push_back(VaultSolution(study));
    return study;
  }

  // A placement that was found in one room, in another one.
  void RunElsewhere(const std::string& name, const std::string& room, const Placement& placement) {
    Scenario scenario = LoadScenario(room);
    scenario.name = name;
    VaultStudyOptions options = OptionsOf(command_);
    options.placement = placement;
    options.refine = false;
    Run(scenario, options, command_.out / name);
  }

  void Summarise() {
    WriteVaultSummary(studies_, command_.out, global_.command_line);
    text_ += "all: " + (command_.out / "report.html").string() + "\n";
  }

  void Print() const { PrintResult(global_, summary_, text_); }

 private:
  // What is wrong with masks or numbers is told before there is a folder.
  void CheckInput(const Scenario& scenario, const VaultStudyOptions& options) {
    for (const std::string& mask : options.masks)
      const PlacementSearch search(scenario, mask, stores_.For(scenario, mask));
    if (!options.placement) {
      PlacementGrid(scenario);
    } else if (const std::string why = NotBuildable(scenario, *options.placement); !why.empty()) {
      throw InputError::At(command_.placement, "/placement", why, "a placement that can be built");
    }
  }

  const StudyVaultCommand& command_;
  const GlobalOptions& global_;
  MaskStores stores_;
  std::unique_ptr<Progress> progress_;
  std::vector<VaultStudy> studies_;
  nlohmann::json summary_ = nlohmann::json::array();
  std::string text_;
};

// What the thesis compares beyond its seven simulations (4.7.6, 4.10): the rigs' heights of the
// one-beam optimum in the two-beam room and the other way round, and the placement that it chose
// for both rooms.
void RunAcross(VaultCommand& run, const std::map<std::string, Placement>& best) {
  const auto has = [&](const char* a, const char* b) {
    return best.contains(a) && best.contains(b);
  };
  if (has("2", "4")) {
    const Placement &two = best.at("2"), &four = best.at("4");
    run.RunElsewhere("2b", "2", {two.phi_b_deg, four.theta1_deg, four.theta2_deg});
    run.RunElsewhere("4b", "4", {four.phi_b_deg, two.theta1_deg, two.theta2_deg});
  }
  if (has("1a", "3a")) run.RunElsewhere("1a-in-3a", "3a", best.at("1a"));
}

int RunStudyVault(const StudyVaultCommand& command, const GlobalOptions& global) {
  std::vector<std::string> names = command.simulations;
  if (names == std::vector<std::string>{"all"}) names = BuiltInScenarioNames();
  if (!command.scenario.empty()) names = {command.scenario};
  if (names.empty()) {
    throw InputError(
        fmt::format("no simulation; expected --simulation with some of {}, or all, or "
                    "--scenario FILE",
                    JoinNames(BuiltInScenarioNames())));
  }
  std::vector<Scenario> scenarios;
  for (const std::string& name : names) scenarios.push_back(LoadScenario(name));
  VaultCommand run(command, global);
  std::map<std::string, Placement> best;
  for (const Scenario& scenario : scenarios) {
    const auto folder = scenarios.size() == 1 ? command.out : command.out / scenario.name;
    best[scenario.name] = run.Run(scenario, OptionsOf(command), folder).best.result.Where();
  }
  if (scenarios.size() > 1) {
    if (command.placement.empty()) RunAcross(run, best);
    run.Summarise();
  }
  run.Print();
  return kExitGood;
}

}  // namespace

void SetUpStudyVault(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyVaultCommand>();
  CLI::App* sub = study.add_subcommand(
      "vault",
      "Where in the treatment vault do cameras see a patient's mask best, in the worst case? "
      "(thesis chapter 4)");
  sub->add_option("--out", command->out, "folder for the results")->required();
  auto* simulation =
      sub->add_option("--simulation", command->simulations,
                      "built-in scenarios, e.g. 1a or 1a,3a (a folder each), or all: " +
                          JoinNames(BuiltInScenarioNames()))
          ->delimiter(',');
  sub->add_option("--scenario", command->scenario, "a scenario file (docs/file-formats.md)")
      ->excludes(simulation);
  sub->add_option("--mask", command->mask,
                  "face, body, both (the worse counts), or a mesh file turned like the face")
      ->capture_default_str();
  sub->add_option("--unit", command->unit, "of the mesh file")
      ->check(CLI::IsMember({"mm", "cm", "m"}))
      ->capture_default_str();
  sub->add_option("--phase", command->phase,
                  "1: the coarse grid; 2: also the fine one around the best three (with "
                  "--placement: around that); both: 2")
      ->check(CLI::IsMember({"1", "2", "both"}))
      ->capture_default_str();
  sub->add_option("--placement", command->placement,
                  "no search: what this placement is worth, from a solution.json or "
                  "{\"placement\": {\"phi_b_deg\", \"theta1_deg\", \"theta2_deg\"}}");
  sub->add_option("--visibility", command->visibility,
                  "what hides a part of the mask from a camera: ids (its id buffer), rays, or "
                  "triangles (the thesis's rule, whole triangles)")
      ->check(CLI::IsMember({"ids", "rays", "triangles"}))
      ->capture_default_str();
  sub->add_option("--sample-area", command->part_area_mm2,
                  "mm2 of the mask that one sample stands for, at most")
      ->check(CLI::Range(1e-3, 1e4))
      ->capture_default_str();
  sub->add_option("--size", command->size, "pixels of the cameras, same field of view");
  sub->add_option("--hotspot-limit", command->hotspot_limit,
                  "summary.json of study hotspot: the least separation of two cameras is the one "
                  "from which on a neighbour's ring changes nothing that robust measures, instead "
                  "of the scenario's");
  sub->add_flag("--quick", command->quick,
                "the search only: no sensitivity, no variations, no refinement between the grid");
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStudyVault(*command, global); };
  });
}

}  // namespace retrolux::cli
