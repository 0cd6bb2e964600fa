// The YAML that OpenCV's FileStorage writes, read by ourselves: the library's own reader (4.6)
// never ends on some damaged files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace retrolux {

// Maps and lists by indentation or in brackets, quoted and plain values, comments; tags
// (!!opencv-matrix) are passed over. No anchors, no text over several lines. Numbers that a double
// can't hold stay text. InputError with the line for all else.
nlohmann::json JsonOfYaml(const std::string& text, const std::filesystem::path& file);

}  // namespace retrolux
