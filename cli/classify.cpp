// retrolux classify: names the markers in pictures.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "classifier/detections_json.h"
#include "classifier/method.h"
#include "cli/command_tree.h"
#include "cli/commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_file.h"
#include "core/marker_set.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;

struct ClassifyOptions {
  std::vector<fs::path> images;
  std::string method = "edges";
  fs::path set;    // empty: the built-in one
  fs::path debug;  // empty: none
  fs::path out;
};

// One folder for one picture; below it, one for each of several, named as they are. The second of
// the same name becomes NAME_2.
std::vector<fs::path> DebugFolders(const ClassifyOptions& options) {
  if (options.images.size() == 1) return {options.debug};
  std::vector<fs::path> folders;
  std::map<std::string, int> uses;
  for (const fs::path& image : options.images) {
    std::string name = image.stem().string();
    const int use = ++uses[name];
    if (use > 1) name = fmt::format("{}_{}", name, use);
    folders.push_back(options.debug / name);
  }
  return folders;
}

// All pictures must exist before the work starts, and the results must find their place.
void CheckPlaces(const ClassifyOptions& options) {
  for (const fs::path& image : options.images) {
    if (!fs::is_regular_file(image)) {
      throw InputError::At(image, "", fs::is_directory(image) ? "is a folder" : "no such file",
                           "a picture");
    }
  }
  if (fs::is_directory(options.out)) {
    throw InputError::At(options.out, "", "is a folder", "the name of a file");
  }
  const fs::path folder = options.out.parent_path();
  EnsureWritableFolder(folder.empty() ? fs::path(".") : folder);
  if (!options.debug.empty()) EnsureWritableFolder(options.debug);
}

int RunClassify(const ClassifyOptions& options, const GlobalOptions& global) {
  const Method method = MethodByName(options.method);
  const MarkerSet markers = options.set.empty() ? DefaultMarkerSet() : ReadMarkerSet(options.set);
  CheckPlaces(options);
  const std::vector<fs::path> debug =
      options.debug.empty() ? std::vector<fs::path>() : DebugFolders(options);

  const auto count = static_cast<int64_t>(options.images.size());
  std::vector<PictureDetections> pictures(options.images.size());
  const std::unique_ptr<Progress> progress = MakeProgress(global);
  progress->Begin("classify", count, "pictures");
  ParallelFor(count, [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    const fs::path& file = options.images[i];
    pictures[i] = {file.string(), file.stem().string(),
                   method(ReadGrey(file), markers, debug.empty() ? nullptr : &debug[i])};
    progress->Advance(1);
  });
  progress->End();
  WriteDetections(options.out, options.method, pictures);

  size_t patterns = 0;
  size_t named = 0;
  for (const PictureDetections& picture : pictures) {
    patterns += picture.detections.size();
    for (const Detection& d : picture.detections) named += d.marker.has_value();
  }
  PrintResult(global,
              {{"pictures", pictures.size()},
               {"patterns", patterns},
               {"named", named},
               {"detections", options.out.string()}},
              fmt::format("{} pictures, {} bright patterns, {} of them named\n{}", pictures.size(),
                          patterns, named, options.out.string()));
  return kExitGood;
}

}  // namespace

void SetUpClassify(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto options = std::make_shared<ClassifyOptions>();
  CLI::App* command = app.add_subcommand("classify", "Name the markers in grey pictures");
  command->footer(
      "Sees the pictures only, of any size, 8 or 16 bit; colours are turned to grey.\n"
      "A pattern cut by the border of the picture is not looked at; one that matches no marker is\n"
      "written with \"marker\": null. Coordinates in px, (0, 0) = centre of the top-left pixel.");
  command->add_option("IMAGE", options->images, "Pictures (PNG, TIFF, EXR, ...)")->required();
  command->add_option("--method", options->method, "Identification method")
      ->type_name(ChoiceType(MethodNames()))
      ->capture_default_str();
  command->add_option("--set", options->set,
                      "Marker set, a JSON file with lengths in mm [default: the built-in six]");
  command->add_option("--debug", options->debug,
                      "Folder for a picture of each stage; a sub-folder each of several pictures");
  command->add_option("--out", options->out, "File for the result, e.g. detections.json")
      ->required();
  command->callback([options, &global, &run] {
    run = [options, &global] { return RunClassify(*options, global); };
  });
}

}  // namespace retrolux::cli
