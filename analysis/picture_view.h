// A picture file as a page: any channel in false colour, value by value.
#pragma once

#include "analysis/picture_channels.h"

namespace retrolux {

// `chosen`: names of channels, empty: all. InputError that lists the channels if one is not there.
Report PictureView(const std::filesystem::path& file, const std::vector<std::string>& chosen,
                   const std::string& command);

}  // namespace retrolux
