// The files that a file from elsewhere names. It may name what lies in its own folder or below, and
// nothing else, whatever way out it tries: "..", an absolute name, a symbolic link. And ordinary
// files only: a device or a pipe could keep us reading for ever.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace retrolux {

// What speaks against reading the file that is called `name` in `folder`, for "found ..."; nothing
// if it may be read.
std::optional<std::string> ObjectionToFile(const std::filesystem::path& folder,
                                           const std::filesystem::path& name);

// Whether a name alone, before any link is followed, stays below the folder that it is taken in.
bool StaysBelow(const std::filesystem::path& name);

}  // namespace retrolux
