// retrolux mask make | sample | import | reconstruct
#include <fmt/format.h>

#include "cli/commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "scenes/gltf.h"
#include "scenes/masks.h"
#include "scenes/mesh_check.h"
#include "scenes/mesh_distance.h"
#include "scenes/mesh_import.h"
#include "scenes/mesh_reconstruct.h"
#include "scenes/mesh_weld.h"
#include "scenes/point_cloud.h"
#include "scenes/scene.h"

namespace retrolux::cli {

namespace fs = std::filesystem;

namespace {

struct MaskOptions {
  std::string input;  // name of a mask, mesh file or point cloud
  std::string unit;
  fs::path out;
  std::string compare;
  std::optional<double> relief;
  bool smooth = false, flip = false;
  int points = 20000;
  double noise_mm = 0.0;
  ReconstructOptions reconstruct;
};

nlohmann::json Numbers(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Before the work: the place can be written to and the name tells the right format.
void CheckOut(const fs::path& out, const std::vector<std::string>& extensions) {
  if (fs::is_directory(out)) throw InputError::At(out, "", "is a folder", "the name of a file");
  const std::string extension = out.extension().string();
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
    throw InputError::At(out, "", fmt::format("the extension '{}'", extension),
                         JoinNames(extensions));
  }
  const fs::path folder = out.parent_path();
  EnsureWritableFolder(folder.empty() ? fs::path(".") : folder);
}

void WriteMesh(const TriangleMesh& mesh, const fs::path& out) {
  Scene scene;
  scene.name = "mask";
  scene.UseMaterial("mask");
  scene.objects.push_back({"mask", mesh, {}, "mask", false});
  WriteGlb(scene, UpAxis::kZ, out);
}

// glTF files need no unit.
LengthUnit UnitOf(const fs::path& file, const std::string& unit) {
  if (!unit.empty()) return ParseLengthUnit(unit);
  if (IsGltf(file)) return LengthUnit::kMetre;
  throw InputError::At(file, "", "no unit of its coordinates", "--unit mm, cm or m");
}

// The mesh of that name, or of that file. The unit is not for glTF, which is always in metres.
TriangleMesh NamedMesh(const std::string& name, const std::string& unit) {
  const std::vector<std::string> names = MaskNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) return MakeMask(name);
  if (!fs::exists(name)) {
    throw InputError(fmt::format("no mask and no file '{}'; expected one of {}, or a mesh file",
                                 name, JoinNames(names)));
  }
  return ImportMesh(name, UnitOf(name, IsGltf(name) ? "" : unit));
}

nlohmann::json Summary(const MeshFindings& f) {
  return {{"vertices", f.vertices},
          {"triangles", f.triangles},
          {"area_mm2", f.area_mm2},
          {"min_mm", Numbers(f.min_corner)},
          {"max_mm", Numbers(f.max_corner)},
          {"pieces", f.pieces},
          {"holes", f.holes},
          {"boundary_edges", f.boundary_edges},
          {"non_manifold_edges", f.non_manifold_edges},
          {"inconsistent_edges", f.inconsistent_edges},
          {"inside_out_pieces", f.inside_out_pieces},
          {"opposed_normals", f.opposed_normals},
          {"duplicate_vertices", f.duplicate_vertices},
          {"degenerate_triangles", f.degenerate_triangles},
          {"warnings", Warnings(f)}};
}

std::string Text(const fs::path& out, const MeshFindings& f) {
  const Vec3d size = f.max_corner - f.min_corner;
  std::string text =
      fmt::format("{}: {} vertices, {} triangles, {:.0f} mm2, {:.1f} x {:.1f} x {:.1f} mm, {}",
                  out.string(), f.vertices, f.triangles, f.area_mm2, size.x(), size.y(), size.z(),
                  f.holes == 0   ? "closed"
                  : f.holes == 1 ? "open, one rim"
                                 : fmt::format("{} holes", f.holes));
  for (const std::string& warning : Warnings(f)) text += "\nwarning: " + warning;
  return text;
}

void WriteAndReport(const TriangleMesh& mesh, const char* source, const MaskOptions& options,
                    const GlobalOptions& global) {
  WriteMesh(mesh, options.out);
  const MeshFindings findings = CheckMesh(mesh);
  nlohmann::json summary = Summary(findings);
  summary[source] = options.input;
  summary["out"] = options.out.string();
  PrintResult(global, summary, Text(options.out, findings));
}

int RunMake(const MaskOptions& options, const GlobalOptions& global) {
  FaceShape face;
  if (options.relief && options.input != "face") {
    throw InputError(
        fmt::format("--relief with the mask '{}'; expected the mask 'face'", options.input));
  }
  face.relief = options.relief.value_or(face.relief);
  const TriangleMesh mesh = options.relief ? FaceMask(face) : MakeMask(options.input);
  CheckOut(options.out, {".glb"});
  WriteAndReport(mesh, "mask", options, global);
  return kExitGood;
}

int RunSample(const MaskOptions& options, const GlobalOptions& global) {
  const TriangleMesh mesh = NamedMesh(options.input, options.unit);
  CheckOut(options.out, {".ply", ".xyz"});
  WritePointCloud(SampleSurface(mesh, options.points, options.noise_mm, global.seed), options.out);
  PrintResult(global,
              {{"surface", options.input},
               {"out", options.out.string()},
               {"points", options.points},
               {"noise_mm", options.noise_mm},
               {"seed", global.seed}},
              fmt::format("{}: {} points in mm, noise {:g} mm", options.out.string(),
                          options.points, options.noise_mm));
  return kExitGood;
}

int RunImport(const MaskOptions& options, const GlobalOptions& global) {
  TriangleMesh mesh = ImportMesh(options.input, UnitOf(options.input, options.unit));
  CheckOut(options.out, {".glb"});
  if (options.flip) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    for (Vec3f& normal : mesh.normals) normal = -normal;
  }
  if (options.smooth) mesh = WithSmoothNormals(mesh);
  WriteAndReport(mesh, "file", options, global);
  return kExitGood;
}

nlohmann::json Summary(const DistanceSummary& distance) {
  return {{"samples", distance.samples},
          {"mean_mm", distance.mean_mm},
          {"rms_mm", distance.rms_mm},
          {"percentile95_mm", distance.percentile95_mm},
          {"max_mm", distance.max_mm}};
}

std::string Text(const char* direction, const DistanceSummary& distance) {
  return fmt::format("\n{}: mean {:.3f}, RMS {:.3f}, 95 % below {:.3f}, at most {:.3f} mm",
                     direction, distance.mean_mm, distance.rms_mm, distance.percentile95_mm,
                     distance.max_mm);
}

// Compares the reconstruction with the true surface, both ways.
std::string Compare(const TriangleMesh& mesh, const TriangleMesh& truth, nlohmann::json& summary) {
  const DistanceSummary to_truth = DistanceBetween(mesh, truth);
  const DistanceSummary from_truth = DistanceBetween(truth, mesh);
  const double area_ratio = mesh.Area() / truth.Area();
  summary["compare"] = {{"to_truth", Summary(to_truth)},
                        {"from_truth", Summary(from_truth)},
                        {"area_ratio", area_ratio}};
  return Text("reconstruction to truth", to_truth) + Text("truth to reconstruction", from_truth) +
         fmt::format("\narea: {:.4f} of the true one", area_ratio);
}

int RunReconstruct(const MaskOptions& options, const GlobalOptions& global) {
  options.reconstruct.Check();
  const std::vector<Vec3f> points =
      ReadPointCloud(options.input, UnitOf(options.input, options.unit));
  std::optional<TriangleMesh> truth;
  if (!options.compare.empty()) truth = NamedMesh(options.compare, options.unit);
  CheckOut(options.out, {".glb"});
  const Reconstruction result = ReconstructSurface(points, options.reconstruct);
  WriteMesh(result.mesh, options.out);
  const MeshFindings findings = CheckMesh(result.mesh);
  nlohmann::json summary = Summary(findings);
  summary["cloud"] = options.input;
  summary["out"] = options.out.string();
  summary["points"] = points.size();
  summary["spacing_mm"] = result.spacing_mm;
  summary["neighbours"] = result.neighbours;
  summary["max_edge_mm"] = result.max_edge_mm;
  std::string text = fmt::format(
      "{} points, {:.2f} mm apart, smoothed over {} neighbours, edges up to {:.1f} mm\n{}",
      points.size(), result.spacing_mm, result.neighbours, result.max_edge_mm,
      Text(options.out, findings));
  if (truth) text += Compare(result.mesh, *truth, summary);
  PrintResult(global, summary, text);
  return kExitGood;
}

// Declares a subcommand of `mask` with what all of them have.
CLI::App* AddMaskCommand(CLI::App& mask, const char* name, const char* description,
                         const std::shared_ptr<MaskOptions>& options, const char* input,
                         const char* out, const GlobalOptions& global, Run& run,
                         int (*action)(const MaskOptions&, const GlobalOptions&)) {
  CLI::App* command = mask.add_subcommand(name, description);
  command->add_option(input, options->input)->required();
  command->add_option("--out", options->out, out)->required()->type_name("FILE");
  command->callback([options, &global, &run, action] {
    run = [options, &global, action] { return action(*options, global); };
  });
  return command;
}

void AddUnit(CLI::App* command, const std::shared_ptr<MaskOptions>& options) {
  command
      ->add_option("--unit", options->unit,
                   "unit of the file's coordinates: mm, cm or m; not needed for glTF (metres)")
      ->check(CLI::IsMember({"mm", "cm", "m"}));
}

}  // namespace

void SetUpMask(CLI::App& app, const GlobalOptions& global, Run& run) {
  const auto options = std::make_shared<MaskOptions>();
  CLI::App* mask = app.add_subcommand("mask", "Make, import, check or reconstruct masks");
  const char* glb = "File for the mesh, .glb (metres, y up; scene.json: \"up_axis\": \"z\")";

  CLI::App* make =
      AddMaskCommand(*mask, "make", "Write a mask of the program: face, body, oval, sphere",
                     options, "NAME", glb, global, run, RunMake);
  make->add_option("--relief", options->relief,
                   fmt::format("face: height of brow, nose, chin ...; 1 = a bare face, 0 = a "
                               "plain half-ellipsoid; default {:g}",
                               FaceShape{}.relief))
      ->check(CLI::Range(0.0, 1.5));

  CLI::App* sample = AddMaskCommand(
      *mask, "sample", "Points on a mask or mesh, as a scanner would give them", options, "SURFACE",
      "File for the points, .ply or .xyz", global, run, RunSample);
  AddUnit(sample, options);
  sample->add_option("--points", options->points, "number of points, evenly by area")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  sample->add_option("--noise-mm", options->noise_mm, "Gaussian noise of each coordinate, 1 sigma")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();

  CLI::App* import =
      AddMaskCommand(*mask, "import", "Check a mesh (glTF, PLY, OBJ, STL) and write it as .glb",
                     options, "FILE", glb, global, run, RunImport);
  AddUnit(import, options);
  import->add_flag("--flip", options->flip, "turn the surface inside out");
  import->add_flag("--smooth", options->smooth, "compute smooth vertex normals");

  CLI::App* reconstruct = AddMaskCommand(
      *mask, "reconstruct", "A surface through a point cloud (PLY, OBJ, XYZ text), outwards",
      options, "CLOUD", glb, global, run, RunReconstruct);
  AddUnit(reconstruct, options);
  ReconstructOptions& r = options->reconstruct;
  reconstruct->add_option(
      "--compare", options->compare,
      "mask name or mesh file (in --unit, glTF in metres): print the distances");
  reconstruct
      ->add_option("--smoothing-scale-mm", r.smoothing_scale_mm,
                   "radius that noise is averaged over, mm; 0: 4 times the points' spacing")
      ->capture_default_str();
  reconstruct
      ->add_option("--smoothing-iterations", r.smoothing_iterations, "0 for points without noise")
      ->capture_default_str();
  reconstruct
      ->add_option("--max-edge-mm", r.max_edge_mm,
                   "longest edge of a triangle, mm: wider gaps stay open; 0: 6 times the spacing")
      ->capture_default_str();
}

}  // namespace retrolux::cli
