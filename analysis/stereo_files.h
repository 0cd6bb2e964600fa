// What a reconstruction leaves: stereo.json, markers3d.csv, constellation.json, report.html
// (docs/file-formats.md).
#pragma once

#include "analysis/stereo_folder.h"

namespace retrolux {

nlohmann::ordered_json StereoJson(const StereoFolder& folder, const StereoOptions& options);

// All but the report.
void WriteStereoFiles(const StereoFolder& folder, const StereoOptions& options,
                      const std::filesystem::path& out);

// `pictures`: the folder that was reconstructed; pictures that are not there are left out.
void WriteStereoReport(const StereoFolder& folder, const StereoOptions& options,
                       const std::filesystem::path& pictures, const std::filesystem::path& out,
                       const std::string& command_line);

// Root of the mean square of the distances from the truth, of the markers that have one.
std::optional<double> RmsError_mm(const StereoFolder& folder);

}  // namespace retrolux
