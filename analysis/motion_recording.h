// A frame of the motion study: the scene at that time, what the two cameras record, and what the
// method finds in it.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "analysis/motion_study.h"

namespace retrolux {

// The mask where the planning had it: its frame is the world.
Scene MotionReferenceScene(const MotionStudyOptions& options);

// As JSON, for the task manifest: detections of each camera, ms that a core needed to find them,
// and the pictures that were kept, below `folder`.
nlohmann::json RecordMotionFrame(const MotionStudyOptions& options, int frame,
                                 const std::filesystem::path& folder);

// What camera `camera` found, of a frame's record.
std::vector<Detection> RecordedDetections(const nlohmann::json& record, size_t camera);

}  // namespace retrolux
