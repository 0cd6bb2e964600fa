// The size of a picture as it is typed, and a scene whose cameras have it.
#pragma once

#include <string>
#include <utility>

#include "scenes/scene.h"

namespace retrolux::cli {

// Width and height in pixels of "WxH", each from 1 to 16384. InputError.
std::pair<int, int> ParseSize(const std::string& text);

// A scene by name or file, in one of its poses and with pictures of that size and the same field of
// view; empty: as it is given. InputError.
Scene LoadSceneAs(const std::string& scene, const std::string& pose, const std::string& size);

}  // namespace retrolux::cli
