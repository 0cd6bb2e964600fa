// The size of a picture as it is typed.
#pragma once

#include <string>
#include <utility>

namespace retrolux::cli {

// Width and height in pixels of "WxH", each from 1 to 16384. InputError.
std::pair<int, int> ParseSize(const std::string& text);

}  // namespace retrolux::cli
