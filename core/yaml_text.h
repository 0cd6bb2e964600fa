// YAML text as JSON, for the files of OpenCV's FileStorage. By yaml-cpp: OpenCV's own reader (4.6)
// never ends on some damaged files, and believes the rows and columns that they claim.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace retrolux {

// Maps, lists, texts and numbers; tags (!!opencv-matrix) are passed over. Plain words that are
// numbers of a double become numbers. InputError with the line if it is no YAML, for aliases, and
// for more than kMaxJsonDepth levels.
nlohmann::json JsonOfYaml(const std::string& text, const std::filesystem::path& file);

}  // namespace retrolux
