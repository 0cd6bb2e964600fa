// One pose of the layout study: every camera's picture of all markers at once, the names in them,
// and what each pair of cameras makes of these.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "analysis/layout_study.h"

namespace retrolux {

// The scene stands in the pose, its markers on the object "mask". As JSON, for the task manifest.
// Writes POSE_CAMERA.png into `pictures`, unless that is empty.
nlohmann::json RunLayoutPose(const Scene& posed, const LayoutStudyOptions& options,
                             const std::string& pose, const std::filesystem::path& pictures);

// Adds a result of RunLayoutPose to the study, as that of its pose number `pose`.
void CollectLayoutPose(const nlohmann::json& result, size_t pose, LayoutStudy& study);

}  // namespace retrolux
