#include "scenes/gltf.h"

#include <cmath>

#include "core/error.h"
#include "scenes/gltf_material.h"

namespace retrolux {

Mat3d GltfFromWorld(UpAxis up) {
  Mat3d map;
  if (up == UpAxis::kX) {
    map << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  } else {
    map << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  }
  return map;
}

namespace {

constexpr double kMmPerM = 1000.0;
constexpr double kMaxCoordinate_mm = 1e9;

std::string PlaceOf(const GltfNode& node) {
  return fmt::format("node '{}'", node.name);
}

// The same surface with three vertices of its own for each triangle, and the triangle's normal at
// them.
TriangleMesh WithFlatNormals(const TriangleMesh& mesh) {
  TriangleMesh flat;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3f p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
    const Vec3f cross = (q - p).cross(r - p);
    const Vec3f normal = cross.norm() > 0.0f ? cross.normalized() : Vec3f(0, 0, 1);
    const auto first = static_cast<uint32_t>(flat.positions.size());
    flat.positions.insert(flat.positions.end(), {p, q, r});
    flat.normals.insert(flat.normals.end(), 3, normal);
    if (!mesh.uvs.empty()) flat.uvs.insert(flat.uvs.end(), {mesh.uvs[a], mesh.uvs[b], mesh.uvs[c]});
    flat.triangles.push_back({first, first + 1, first + 2});
  }
  return flat;
}

// Normals go with the inverse transpose. Its length is that of the input where that is a unit
// vector up to rounding, so that a uniform scale changes no bit.
Vec3f TransformedNormal(const Mat3d& cofactor, const Vec3f& normal) {
  const Vec3d n = normal.cast<double>();
  const double length = n.norm();
  const Vec3d turned = cofactor * n;
  if (!(length > 0.0) || !(turned.norm() > 0.0)) return Vec3f(0, 0, 1);
  const double wanted = std::abs(length - 1.0) < 1e-5 ? length : 1.0;
  return (turned * (wanted / turned.norm())).cast<float>();
}

// Walks the tree and gathers the meshes in world mm.
class MeshGatherer {
 public:
  MeshGatherer(const GltfModel& model, UpAxis up)
      : model_(model), world_from_gltf_(GltfFromWorld(up).transpose()), memory_(model.memory) {}

  void Visit(size_t index, const Eigen::Affine3d& file_from_node) {
    const GltfNode& node = model_.nodes[index];
    if (node.mesh) {
      for (const GltfPrimitive& part : model_.meshes[*node.mesh])
        Add(node, part.mesh, file_from_node);
    }
    for (const size_t child : node.children) {
      Visit(child, file_from_node * model_.nodes[child].parent_from_node);
    }
  }

  TriangleMesh Take() {
    bool smooth = false, textured = true;
    for (const TriangleMesh& part : parts_) {
      smooth |= !part.normals.empty();
      textured &= !part.uvs.empty();
    }
    TriangleMesh all;
    for (TriangleMesh& part : parts_) {
      if (!textured) part.uvs.clear();
      if (smooth && part.normals.empty()) part = WithFlatNormals(part);
      if (all.positions.empty()) {
        all = std::move(part);
      } else {
        all.Append(part);
      }
    }
    return all;
  }

 private:
  void Add(const GltfNode& node, const TriangleMesh& part, const Eigen::Affine3d& file_from_node) {
    const Mat3d linear = world_from_gltf_ * file_from_node.linear() * kMmPerM;
    const Vec3d shift = world_from_gltf_ * file_from_node.translation() * kMmPerM;
    const double determinant = linear.determinant();
    if (!(std::abs(determinant) > 0.0) || !std::isfinite(determinant)) {
      throw InputError::At(model_.file, PlaceOf(node), "a singular transform",
                           "one that keeps a volume");
    }
    memory_.Take(model_.file, PlaceOf(node), part.Bytes());
    triangles_ += part.triangles.size();
    if (triangles_ > kMaxTriangles) {
      throw InputError::At(model_.file, PlaceOf(node),
                           fmt::format("more than {} triangles", kMaxTriangles), "a smaller mesh");
    }
    const Mat3d cofactor = linear.inverse().transpose();
    TriangleMesh moved = part;
    for (Vec3f& p : moved.positions) {
      const Vec3d x = linear * p.cast<double>() + shift;
      if (!(x.cwiseAbs().maxCoeff() < kMaxCoordinate_mm)) {
        throw InputError::At(
            model_.file, PlaceOf(node),
            fmt::format("a vertex at ({:.3g}, {:.3g}, {:.3g}) mm", x.x(), x.y(), x.z()),
            fmt::format("coordinates below {:.0e} mm", kMaxCoordinate_mm));
      }
      p = x.cast<float>();
    }
    for (Vec3f& n : moved.normals) n = TransformedNormal(cofactor, n);
    if (determinant < 0.0) {
      for (auto& triangle : moved.triangles) std::swap(triangle[1], triangle[2]);
    }
    parts_.push_back(std::move(moved));
  }

  const GltfModel& model_;
  const Mat3d world_from_gltf_;
  GltfMemory memory_;
  std::vector<TriangleMesh> parts_;
  size_t triangles_ = 0;
};

bool HasMesh(const GltfModel& model, size_t index) {
  const GltfNode& node = model.nodes[index];
  if (node.mesh) return true;
  for (const size_t child : node.children) {
    if (HasMesh(model, child)) return true;
  }
  return false;
}

struct PlacedNode {
  size_t index;
  Eigen::Affine3d file_from_node;
};

void AddPlaced(const GltfModel& model, size_t index, const Eigen::Affine3d& file_from_parent,
               std::vector<PlacedNode>& placed) {
  const Eigen::Affine3d file_from_node = file_from_parent * model.nodes[index].parent_from_node;
  placed.push_back({index, file_from_node});
  for (const size_t child : model.nodes[index].children)
    AddPlaced(model, child, file_from_node, placed);
}

// Every node of the scene with its place, parents before children.
std::vector<PlacedNode> PlacedNodes(const GltfModel& model) {
  std::vector<PlacedNode> placed;
  for (const size_t root : model.roots) AddPlaced(model, root, Eigen::Affine3d::Identity(), placed);
  return placed;
}

PlacedNode FindMeshNode(const GltfModel& model, const std::string& name) {
  std::optional<PlacedNode> found;
  std::vector<std::string> names;
  for (const PlacedNode& placed : PlacedNodes(model)) {
    if (!HasMesh(model, placed.index)) continue;
    names.push_back(model.nodes[placed.index].name);
    if (names.back() != name) continue;
    if (found) {
      throw InputError::At(model.file, fmt::format("node '{}'", name), "two nodes of that name",
                           "names of their own");
    }
    found = placed;
  }
  if (found) return *found;
  throw InputError::At(
      model.file, "", fmt::format("no node '{}' with a mesh", name),
      names.empty() ? "a file with meshes" : fmt::format("one of {}", JoinNames(names)));
}

// The scale of a transform that is a scale followed by a rotation.
Vec3d ScaleOf(const GltfModel& model, const GltfNode& node, const Mat3d& linear) {
  const Vec3d scale = linear.colwise().norm();
  const Mat3d rotation = linear * scale.cwiseInverse().asDiagonal();
  const bool rigid = (rotation.transpose() * rotation - Mat3d::Identity()).norm() < 1e-5;
  if (!rigid || rotation.determinant() < 0.0) {
    throw InputError::At(
        model.file, PlaceOf(node), "a transform that mirrors, shears or flattens",
        "scale, rotation and translation only for a mesh in the frame of its node");
  }
  return scale;
}

}  // namespace

TriangleMesh GltfFile::Mesh(UpAxis up) const {
  MeshGatherer gatherer(model_, up);
  for (const size_t root : model_.roots) gatherer.Visit(root, model_.nodes[root].parent_from_node);
  TriangleMesh mesh = gatherer.Take();
  if (mesh.triangles.empty()) throw InputError::At(model_.file, "", "no mesh", "triangles");
  return mesh;
}

TriangleMesh GltfFile::NodeMesh(const std::string& name, MeshFrame frame, UpAxis up) const {
  PlacedNode placed = FindMeshNode(model_, name);
  if (frame == MeshFrame::kNode) {
    const Vec3d scale = ScaleOf(model_, model_.nodes[placed.index], placed.file_from_node.linear());
    placed.file_from_node = Eigen::Scaling(scale);
  }
  MeshGatherer gatherer(model_, up);
  gatherer.Visit(placed.index, placed.file_from_node);
  return gatherer.Take();
}

Material GltfFile::MeshMaterial() const {
  return SharedGltfMaterial(model_, model_.roots, "");
}

Material GltfFile::NodeMaterial(const std::string& name) const {
  const PlacedNode placed = FindMeshNode(model_, name);
  return SharedGltfMaterial(model_, std::span(&placed.index, 1),
                            PlaceOf(model_.nodes[placed.index]));
}

std::vector<CameraModel> GltfFile::Cameras(UpAxis up) const {
  const Mat3d world_from_gltf = GltfFromWorld(up).transpose();
  const Mat3d gltf_camera_from_camera = Vec3d(1, -1, -1).asDiagonal();
  std::vector<CameraModel> cameras;
  for (const PlacedNode& placed : PlacedNodes(model_)) {
    const GltfNode& node = model_.nodes[placed.index];
    if (!node.camera || !model_.cameras[*node.camera]) continue;
    const GltfCamera& given = *model_.cameras[*node.camera];
    const Mat3d linear = placed.file_from_node.linear();
    const Mat3d rotation = linear * ScaleOf(model_, node, linear).cwiseInverse().asDiagonal();
    const RigidTransform world_from_camera = {
        world_from_gltf * rotation * gltf_camera_from_camera,
        world_from_gltf * placed.file_from_node.translation() * kMmPerM};
    CameraModel camera;
    if (given.opencv) {
      camera = *given.opencv;
    } else {
      const int height = std::max(1, static_cast<int>(std::lround(640.0 / given.aspect_ratio)));
      const double vertical_deg = DegFromRad(given.vertical_fov_rad);
      camera = CameraModel::FromFieldOfView(node.name, 640, height, vertical_deg, vertical_deg, {});
      camera.fx = camera.fy;
    }
    camera.name = node.name;
    camera.camera_from_world = world_from_camera.Inverse();
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace retrolux
