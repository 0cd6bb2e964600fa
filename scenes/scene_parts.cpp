#include "scenes/scene_parts.h"

namespace retrolux {

void AddObject(Scene& scene, const std::string& name, TriangleMesh mesh,
               const std::string& material, bool moves_with_pose) {
  scene.UseMaterial(material);
  scene.objects.push_back({name, std::move(mesh), {}, material, moves_with_pose});
}

CameraSpec ThesisCamera(const std::string& name, const Vec3d& eye, const Vec3d& up) {
  CameraSpec camera;
  camera.model =
      CameraModel::FromFieldOfView(name, 640, 480, 12.18, 9.15, LookAt(eye, Vec3d::Zero(), up));
  camera.filter = DichroicFilter{};
  camera.ring = DiodeRing{};
  return camera;
}

}  // namespace retrolux
