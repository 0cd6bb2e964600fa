#include "scenes/built_in.h"

namespace retrolux {

const std::vector<BuiltInEntry>& BuiltInScenes() {
  static const std::vector<BuiltInEntry> scenes = {
      {"ct-room",
       "the CT scanner room: oval on the couch, gantry, six ring-lit cameras, three poses", CtRoom},
      {"oval", "the oval (280 x 200 x 200 mm) with all markers, one ring-lit camera at 1600 mm",
       OvalScene},
      {"face",
       "a face mask (76,459 mm2) with all markers, three ring-lit cameras at 2000 mm: front, "
       "oblique, side",
       FaceScene},
      {"body",
       "a body mask (450 x 360 mm) with all markers, two ring-lit cameras at 2400 mm: above, "
       "oblique",
       BodyScene},
      {"sphere", "a sphere of radius 100 mm, one ring-lit camera at 1600 mm", SphereScene},
      {"vault",
       "the treatment vault as the thesis chose to build it: face mask with all markers, both "
       "nozzles, nine ring-lit cameras on two rigs",
       VaultRoom},
      {"chessboard",
       "10 x 7 squares of 30 mm for calibration, one wide camera with lens distortion",
       ChessboardScene},
      {"flat-field", "an even wall of radiance 1 W/(m2 sr) in front of one camera", FlatFieldScene},
      {"goniometer",
       "retro-reflective sheeting, a lamp and receivers at four observation angles, 15 m away as "
       "in ASTM E810",
       GoniometerScene},
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
