// cameras.yml: the cameras of a shot in the form of OpenCV's FileStorage, as CamerasYaml writes it.
#pragma once

#include <filesystem>
#include <vector>

#include "core/camera_model.h"

namespace retrolux {

// InputError with what is missing or wrong: a matrix of another size, a rotation that is none, a
// name twice, no camera at all. Four distortion coefficients stand for five with k3 = 0.
std::vector<CameraModel> ReadCameras(const std::filesystem::path& file);

}  // namespace retrolux
