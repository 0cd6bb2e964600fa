#include "scenes/built_in.h"

namespace retrolux {

const std::vector<BuiltInEntry>& BuiltInScenes() {
  static const std::vector<BuiltInEntry> scenes = {
      {"ct-room",
       "the CT scanner room: oval on the couch, gantry, six ring-lit cameras, three poses", CtRoom},
      {"oval", "the oval (280 x 200 x 200 mm) with all markers, one ring-lit camera at 1600 mm",
       OvalScene},
      {"sphere", "a sphere of radius 100 mm, one ring-lit camera at 1600 mm", SphereScene},
  };
  return scenes;
}

Scene BuiltInScene(const std::string& name) {
  std::vector<std::string> names;
  for (const BuiltInEntry& entry : BuiltInScenes()) {
    if (name == entry.name) return entry.make();
    names.emplace_back(entry.name);
  }
  throw InputError(
      fmt::format("no built-in scene '{}'; expected one of {}", name, JoinNames(names)));
}

}  // namespace retrolux
