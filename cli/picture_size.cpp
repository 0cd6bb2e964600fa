#include "cli/picture_size.h"

#include <charconv>

#include "core/error.h"
#include "scenes/scene_json.h"

namespace retrolux::cli {

std::pair<int, int> ParseSize(const std::string& text) {
  int width = 0, height = 0;
  const char* const end = text.data() + text.size();
  const auto [cross, width_error] = std::from_chars(text.data(), end, width);
  const bool split = width_error == std::errc{} && cross != end && *cross == 'x';
  const auto [rest, height_error] = std::from_chars(split ? cross + 1 : end, end, height);
  if (!split || height_error != std::errc{} || rest != end || width < 1 || height < 1 ||
      width > 16384 || height > 16384) {
    throw InputError(
        fmt::format("--size {}: expected WIDTHxHEIGHT in px, each from 1 to 16384", text));
  }
  return {width, height};
}

Scene LoadSceneAs(const std::string& name, const std::string& pose, const std::string& size) {
  Scene scene = LoadScene(name);
  if (!pose.empty()) scene = scene.AtPose(pose);
  if (!size.empty()) {
    const auto [width, height] = ParseSize(size);
    for (CameraSpec& camera : scene.cameras) camera.model = camera.model.Resized(width, height);
  }
  return scene;
}

}  // namespace retrolux::cli
