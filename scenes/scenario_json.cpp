// Reads scenario files.
#include <algorithm>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/error.h"
#include "core/file_below.h"
#include "core/json_reader.h"
#include "scenes/scenario.h"
#include "scenes/scene_json_values.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxLength_mm = 1e5;
constexpr int kMaxCameras = 16;  // the areas of all their subsets are kept in one table
constexpr size_t kMaxSteps = 100000;
const fs::path kScenarioFolder = "scenes/data/scenarios";

double Length(JsonReader& json, const std::string& key) {
  return json.Number(key, 0.0, kMaxLength_mm);
}

Steps ReadSteps(JsonReader json, double min, double max) {
  Steps steps = {json.Number("from", min, max), json.Number("to", min, max),
                 json.Number("step", -kMaxLength_mm, kMaxLength_mm)};
  json.Finish();
  if (!(steps.step > 0.0)) json.Fail(fmt::format("the step {}", steps.step), "a step above 0");
  if (steps.to < steps.from) {
    json.Fail(fmt::format("an empty interval: from {} to {}", steps.from, steps.to), "from <= to");
  }
  if ((steps.to - steps.from) / steps.step > static_cast<double>(kMaxSteps)) {
    json.Fail(fmt::format("{:.0f} steps", (steps.to - steps.from) / steps.step),
              fmt::format("at most {}", kMaxSteps));
  }
  return steps;
}

double PositiveStep(JsonReader& json, const std::string& key) {
  const double step = json.Number(key, 0.0, 1e4);
  if (!(step > 0.0)) json.Child(key).Fail("the step 0", "a step above 0");
  return step;
}

NozzleSpec ReadNozzle(JsonReader json) {
  NozzleSpec nozzle;
  nozzle.tip_radius_mm = Length(json, "tip_radius_mm");
  nozzle.snout_back_radius_mm = Length(json, "snout_back_radius_mm");
  nozzle.snout_length_mm = Length(json, "snout_length_mm");
  nozzle.min_tip_distance_mm = Length(json, "min_tip_distance_mm");
  nozzle.gap_mm = Length(json, "gap_mm");
  nozzle.cylinder_radius_mm = Length(json, "cylinder_radius_mm");
  nozzle.cylinder_front_mm = Length(json, "cylinder_front_mm");
  nozzle.cylinder_length_mm = Length(json, "cylinder_length_mm");
  json.Finish();
  if (nozzle.snout_back_radius_mm < nozzle.tip_radius_mm ||
      nozzle.cylinder_radius_mm < nozzle.snout_back_radius_mm) {
    json.Fail(
        fmt::format("radii {} (tip), {} (back of the snout), {} mm (cylinder)",
                    nozzle.tip_radius_mm, nozzle.snout_back_radius_mm, nozzle.cylinder_radius_mm),
        "radii that do not fall from the tip to the cylinder: the snout slides into it");
  }
  if (!(nozzle.snout_length_mm > 0.0) || !(nozzle.cylinder_length_mm > 0.0))
    json.Fail("a snout or cylinder without length", "lengths above 0");
  const double reach = nozzle.min_tip_distance_mm + nozzle.snout_length_mm;
  if (nozzle.cylinder_front_mm > reach) {
    json.Fail(fmt::format("a cylinder that begins at {} mm, behind the end of the extended snout "
                          "at {} mm",
                          nozzle.cylinder_front_mm, reach),
              "a snout that reaches its cylinder");
  }
  return nozzle;
}

RigSpec ReadRigs(JsonReader json) {
  RigSpec rigs;
  rigs.layout = json.Choice("layout", {"constant-distance", "equal-radius"}) == "equal-radius"
                    ? RigLayout::kEqualRadius
                    : RigLayout::kConstantDistance;
  rigs.distance_mm = json.Number("distance_mm", 1.0, kMaxLength_mm);
  rigs.max_distance_mm = json.Number("max_distance_mm", rigs.distance_mm, kMaxLength_mm);
  rigs.min_radius_mm = Length(json, "min_radius_mm");
  rigs.min_height_mm = json.Number("min_height_mm", -kMaxLength_mm, kMaxLength_mm);
  rigs.tolerance_mm = Length(json, "tolerance_mm");
  rigs.same_height = json.Bool("same_height", false);
  json.Finish();
  return rigs;
}

VaultCameras ReadCameras(JsonReader json) {
  VaultCameras cameras;
  cameras.count = json.Integer("count", 1, kMaxCameras);
  if (cameras.count < 2) {
    json.Child("count").Fail("one camera", "at least two: a marker is located by a pair");
  }
  cameras.arrangement = json.Choice("arrangement", {"beside-beam", "even"}) == "even"
                            ? Arrangement::kEven
                            : Arrangement::kBesideBeam;
  cameras.width_px = json.Integer("width_px", 8, 1 << 14);
  cameras.height_px = json.Integer("height_px", 8, 1 << 14);
  cameras.horizontal_fov_deg = json.Number("horizontal_fov_deg", 0.01, 170.0);
  cameras.vertical_fov_deg = json.Number("vertical_fov_deg", 0.01, 170.0);
  json.Finish();
  return cameras;
}

std::vector<double> Angles(JsonReader& json, const std::string& key) {
  const JsonReader array = json.Child(key);
  std::vector<double> angles;
  if (array.IsObject()) return ReadSteps(array, -360.0, 360.0).Values();
  for (size_t i = 0; i < array.Size(); ++i) angles.push_back(array.Child(i).AsNumber(-360, 360));
  if (angles.empty()) array.Fail("no angle", "at least one");
  return angles;
}

MaskSpec ReadMask(JsonReader json) {
  MaskSpec mask;
  mask.mesh = json.String("mesh");
  if (json.Has("unit")) mask.unit = json.Choice("unit", {"mm", "cm", "m"});
  mask.scale = json.Number("scale", 1e-3, 1e3, 1.0);
  mask.relief = json.Number("relief", 0.0, 1.5, mask.relief);
  mask.order = json.String("order", mask.order);
  std::string sorted = mask.order;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != "xyz") {
    json.Child("order").Fail(Quoted(mask.order), "x, y and z once each, e.g. \"zyx\"");
  }
  mask.x_deg = Angles(json, "x_deg");
  mask.y_deg = Angles(json, "y_deg");
  mask.z_deg = Angles(json, "z_deg");
  ForEach(json, "limits", [&](JsonReader limit) {
    mask.limits.push_back({limit.Number("y_at_least_deg", -360.0, 360.0),
                           limit.Number("z_at_least_deg", -360.0, 360.0)});
    limit.Finish();
  });
  json.Finish();
  if (MaskRotations(mask).empty())
    json.Fail("limits that leave no orientation", "at least one orientation");
  return mask;
}

CombinationSpec ReadCombinations(JsonReader json, int cameras) {
  CombinationSpec spec;
  spec.size = json.Integer("size", 2, 4);
  if (spec.size > cameras) {
    json.Child("size").Fail(fmt::format("combinations of {} among {} cameras", spec.size, cameras),
                            "at most as many as there are cameras");
  }
  ForEach(json, "extra", [&](const JsonReader& row) {
    if (!row.IsArray() || row.Size() < 2 || row.Size() > 4)
      row.Fail("a combination that is not of 2 to 4 cameras", "e.g. [1, 2, 8, 9]");
    std::vector<int> combination;
    for (size_t i = 0; i < row.Size(); ++i) {
      const double camera = row.Child(i).AsNumber(-1e6, 1e6);
      if (camera != static_cast<int>(camera) || camera < 1 || camera > cameras) {
        row.Child(i).Fail(fmt::format("camera {}", camera),
                          fmt::format("a camera from 1 to {}", cameras));
      }
      combination.push_back(static_cast<int>(camera));
    }
    std::sort(combination.begin(), combination.end());
    if (std::adjacent_find(combination.begin(), combination.end()) != combination.end())
      row.Fail("a camera twice", "different cameras");
    spec.extra.push_back(combination);
  });
  spec.min_separation_deg = json.Number("min_separation_deg", 0.0, 180.0);
  json.Finish();
  return spec;
}

SearchSpec ReadSearch(JsonReader json) {
  SearchSpec search;
  search.phi_b_deg = ReadSteps(json.Child("phi_b_deg"), 0.0, 180.0);
  search.theta_deg = ReadSteps(json.Child("theta_deg"), 0.0, 180.0);
  search.refined_phi_b_step_deg = PositiveStep(json, "refined_phi_b_step_deg");
  search.refined_theta_step_deg = PositiveStep(json, "refined_theta_step_deg");
  search.refined_optima = json.Integer("refined_optima", 1, 100);
  search.snap_phi_b_deg = PositiveStep(json, "snap_phi_b_deg");
  search.snap_height_mm = PositiveStep(json, "snap_height_mm");
  json.Finish();
  return search;
}

std::vector<ErrorPoint> ReadErrorPoints(const JsonReader& json) {
  std::vector<ErrorPoint> points;
  double last_deg = 0.0;
  for (size_t i = 0; i < json.Size(); ++i) {
    const JsonReader point = json.Child(i);
    const std::vector<double> pair = point.Numbers(2);
    if (!(pair[0] > last_deg && pair[0] <= 90.0)) {
      point.Fail(fmt::format("{:g} degrees after {:g}", pair[0], last_deg),
                 "ascending angles above 0, up to 90");
    }
    if (!(pair[1] > 0.0)) point.Fail(fmt::format("an error of {:g} mm", pair[1]), "a positive one");
    points.push_back({pair[0], pair[1]});
    last_deg = pair[0];
  }
  if (points.size() < 3) json.Fail(fmt::format("{} known points", points.size()), "three or more");
  return points;
}

// The error at which a pair of cameras is worth nothing.
double ReadGammaMax(JsonReader& json, const std::vector<ErrorPoint>& points) {
  double least_mm = points.front().error_mm;
  for (const ErrorPoint& point : points) least_mm = std::min(least_mm, point.error_mm);
  const double gamma_max_mm = json.Number("gamma_max_mm", 1e-6, 1e6);
  if (gamma_max_mm <= least_mm) {
    json.Fail(fmt::format("gamma_max_mm {:g}", gamma_max_mm),
              fmt::format("more than the least known error, {:g} mm", least_mm));
  }
  return gamma_max_mm;
}

ThesisSolution ReadThesisSolution(JsonReader json) {
  ThesisSolution row;
  row.name = json.String("name");
  row.phi_b_deg = json.Number("phi_b_deg", 0.0, 180.0);
  row.theta1_deg = json.Number("theta1_deg", 0.0, 180.0);
  row.theta2_deg = json.Number("theta2_deg", 0.0, 180.0);
  row.cost = json.Number("cost", 0.0, 1e6);
  row.area_pct = json.Number("area_pct", 0.0, 100.0);
  row.area_cm2 = json.Number("area_cm2", 0.0, 1e6);
  row.angle_deg = json.Number("angle_deg", 0.0, 180.0);
  row.error_mm = json.Number("error_mm", 0.0, 1e3);
  if (json.Has("remark")) row.remark = json.String("remark");
  json.Finish();
  return row;
}

std::vector<Beam> ReadBeams(JsonReader& json) {
  std::vector<Beam> beams;
  ForEach(json, "beams", [&](JsonReader beam) {
    beams.push_back({beam.String("name"), beam.Number("elevation_deg", -90.0, 90.0)});
    beam.Finish();
  });
  return beams;
}

// The path that a "base" means: a file beside the one that names it, a built-in scenario, or one of
// the data folder, "scenes/data/...".
fs::path BaseFile(const fs::path& file, const nlohmann::json& base) {
  if (base.is_string()) {
    const fs::path name = base.get<std::string>();
    if (!ObjectionToFile(file.parent_path(), name)) return file.parent_path() / name;
    const std::vector<std::string> names = BuiltInScenarioNames();
    if (std::find(names.begin(), names.end(), name) != names.end())
      return DataPath(kScenarioFolder / (name.string() + ".json"));
    if (name.string().starts_with("scenes/data/")) return DataPath(name);
  }
  throw InputError::At(file, "/base", "no such scenario",
                       fmt::format("a file beside this one, or one of the built-in {}",
                                   JoinNames(BuiltInScenarioNames())));
}

// The file with the chain of its bases merged under it.
nlohmann::json Merged(const fs::path& file, int depth = 0) {
  constexpr int kDeepest = 8;
  nlohmann::json document = JsonReader::FromFile(file).Raw();
  if (!document.is_object() || !document.contains("base")) return document;
  if (depth == kDeepest) {
    throw InputError::At(file, "/base", fmt::format("more than {} bases", kDeepest),
                         "a chain that ends");
  }
  nlohmann::json merged = Merged(BaseFile(file, document["base"]), depth + 1);
  document.erase("base");
  merged.merge_patch(document);
  return merged;
}

Scenario FromDocument(const nlohmann::json& document, const fs::path& file) {
  JsonReader json = JsonReader::FromText(document.dump(), file);
  Scenario scenario;
  scenario.file = file;
  scenario.document = document;
  json.Schema("retrolux/scenario-1");
  scenario.name = json.String("name");
  scenario.description = json.String("description", "");
  scenario.isocentre_height_mm = Length(json, "isocentre_height_mm");
  scenario.beams = ReadBeams(json);
  scenario.nozzle = ReadNozzle(json.Child("nozzle"));
  scenario.rigs = ReadRigs(json.Child("rigs"));
  scenario.cameras = ReadCameras(json.Child("cameras"));
  JsonReader masks = json.Child("masks");
  for (const std::string& name : masks.Keys()) scenario.masks[name] = ReadMask(masks.Child(name));
  if (scenario.masks.empty()) masks.Fail("no mask", "at least one");
  scenario.combinations = ReadCombinations(json.Child("combinations"), scenario.cameras.count);
  JsonReader error = json.Child("reconstruction_error");
  scenario.error_points = ReadErrorPoints(error.Child("points"));
  scenario.gamma_max_mm = ReadGammaMax(error, scenario.error_points);
  error.Finish();
  scenario.search = ReadSearch(json.Child("search"));
  ForEach(json, "variations", [&](JsonReader variation) {
    scenario.variations.push_back({variation.String("name"), variation.Child("change").Raw()});
    variation.Finish();
  });
  ForEach(json, "thesis",
          [&](const JsonReader& row) { scenario.thesis.push_back(ReadThesisSolution(row)); });
  json.Finish();
  return scenario;
}

// Not those that a command gives in the place of the file's: they may lie anywhere.
void CheckMeshFiles(const Scenario& scenario) {
  for (const auto& [name, mask] : scenario.masks) {
    if (!fs::path(mask.mesh).has_extension()) continue;
    if (const auto found = ObjectionToFile(scenario.file.parent_path(), mask.mesh)) {
      throw InputError::At(scenario.file, fmt::format("/masks/{}/mesh", name), *found,
                           "a built-in mask, or a file below the folder of the scenario");
    }
  }
}

}  // namespace

Scenario Scenario::With(const Variation& variation) const {
  nlohmann::json changed = document;
  changed.merge_patch(variation.change);
  changed.erase("variations");
  return FromDocument(changed, file.string() + " (" + variation.name + ")");
}

std::vector<std::string> BuiltInScenarioNames() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(DataPath(kScenarioFolder))) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scenario LoadScenario(const std::string& name_or_path) {
  const std::vector<std::string> names = BuiltInScenarioNames();
  const bool built_in = std::find(names.begin(), names.end(), name_or_path) != names.end();
  const fs::path file =
      built_in ? DataPath(kScenarioFolder / (name_or_path + ".json")) : fs::path(name_or_path);
  if (!built_in && !fs::is_regular_file(file)) {
    throw InputError::At(file, "", "no such scenario file",
                         fmt::format("a file, or one of the built-in {}", JoinNames(names)));
  }
  const Scenario scenario = FromDocument(Merged(file), file);
  CheckMeshFiles(scenario);
  for (const Variation& variation : scenario.variations) scenario.With(variation);
  return scenario;
}

}  // namespace retrolux
