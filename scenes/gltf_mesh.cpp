#include "scenes/gltf_mesh.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

class MeshConverter {
 public:
  MeshConverter(const fs::path& file, const tinygltf::Model& model, GltfMemory& memory)
      : file_(file), model_(model), memory_(memory) {}

  std::vector<GltfPrimitive> Convert(size_t index) const {
    const tinygltf::Mesh& mesh = model_.meshes[index];
    const std::string name =
        mesh.name.empty() ? fmt::format("mesh {}", index) : fmt::format("mesh '{}'", mesh.name);
    if (mesh.primitives.empty()) Fail(name, "no primitives", "triangles");
    std::vector<GltfPrimitive> parts;
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
      parts.push_back(
          ConvertPrimitive(mesh.primitives[i], fmt::format("{} primitive {}", name, i)));
    }
    return parts;
  }

 private:
  [[noreturn]] void Fail(std::string_view place, std::string_view found,
                         std::string_view expected) const {
    throw InputError::At(file_, place, found, expected);
  }
  size_t Index(std::string_view place, int index, size_t size) const {
    return CheckedGltfIndex(file_, place, index, size);
  }

  // The bytes of an accessor, all of them inside their buffer.
  struct Elements {
    const unsigned char* data;
    size_t count, stride;
    int component;

    template <typename T>
    T At(size_t i, size_t k = 0) const {  // accessors need not be aligned in memory
      T value;
      std::memcpy(&value, data + i * stride + k * sizeof(T), sizeof(T));
      return value;
    }
  };

  Elements ElementsOf(int index, const std::string& place, int type) const {
    const tinygltf::Accessor& accessor =
        model_.accessors[Index(place, index, model_.accessors.size())];
    if (accessor.sparse.isSparse) Fail(place, "a sparse accessor", "a plain one");
    if (accessor.type != type)
      Fail(place, "an accessor of another type",
           type == TINYGLTF_TYPE_VEC3   ? "VEC3"
           : type == TINYGLTF_TYPE_VEC2 ? "VEC2"
                                        : "SCALAR");
    const int component_size =
        tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    if (component_size <= 0)
      Fail(place, fmt::format("component type {}", accessor.componentType), "one of glTF 2.0");
    const size_t element =
        static_cast<size_t>(component_size) *
        static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    const std::span<const unsigned char> view =
        GltfViewBytes(file_, model_, place, accessor.bufferView);
    const size_t given = model_.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
    const size_t stride = given == 0 ? element : given;
    if (stride < element)
      Fail(place, fmt::format("a stride of {} bytes", stride), fmt::format("at least {}", element));
    if (accessor.count == 0) Fail(place, "an empty accessor", "at least one element");
    const bool first_fits =
        accessor.byteOffset <= view.size() && element <= view.size() - accessor.byteOffset;
    if (!first_fits ||
        accessor.count - 1 > (view.size() - accessor.byteOffset - element) / stride) {
      Fail(place,
           fmt::format("{} elements from byte {} in a buffer view of {} bytes", accessor.count,
                       accessor.byteOffset, view.size()),
           "bytes that are there");
    }
    // Indices of any size take four bytes, and four more in their triangle.
    memory_.Take(file_, place, accessor.count * std::max<size_t>(element, 8));
    return {view.data() + accessor.byteOffset, accessor.count, stride, accessor.componentType};
  }

  std::vector<Vec3f> Vectors(int index, const std::string& place) const {
    const Elements elements = ElementsOf(index, place, TINYGLTF_TYPE_VEC3);
    if (elements.component != TINYGLTF_COMPONENT_TYPE_FLOAT)
      Fail(place, fmt::format("component type {}", elements.component), "5126 (float)");
    std::vector<Vec3f> vectors(elements.count);
    for (size_t i = 0; i < elements.count; ++i) {
      vectors[i] = {elements.At<float>(i, 0), elements.At<float>(i, 1), elements.At<float>(i, 2)};
      if (!vectors[i].allFinite())
        Fail(place, fmt::format("a coordinate of element {} that is not a number", i),
             "finite numbers");
    }
    return vectors;
  }

  // None if they are not given as floats, which few do: then the mesh can't be textured.
  std::vector<Vec2f> TextureCoordinates(int index, const std::string& place, size_t count) const {
    const Elements elements = ElementsOf(index, place, TINYGLTF_TYPE_VEC2);
    if (elements.component != TINYGLTF_COMPONENT_TYPE_FLOAT) return {};
    if (elements.count != count) {
      Fail(place, fmt::format("{} coordinates", elements.count),
           fmt::format("{}, as many as positions", count));
    }
    std::vector<Vec2f> uvs(elements.count);
    for (size_t i = 0; i < elements.count; ++i) {
      uvs[i] = {elements.At<float>(i, 0), elements.At<float>(i, 1)};
      if (!uvs[i].allFinite())
        Fail(place, fmt::format("a coordinate of element {} that is not a number", i),
             "finite numbers");
    }
    return uvs;
  }

  std::vector<uint32_t> Indices(int index, const std::string& place) const {
    const Elements elements = ElementsOf(index, place, TINYGLTF_TYPE_SCALAR);
    std::vector<uint32_t> indices(elements.count);
    for (size_t i = 0; i < elements.count; ++i) {
      switch (elements.component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
          indices[i] = elements.At<uint8_t>(i);
          break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
          indices[i] = elements.At<uint16_t>(i);
          break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
          indices[i] = elements.At<uint32_t>(i);
          break;
        default:
          Fail(place, fmt::format("component type {}", elements.component),
               "unsigned bytes, shorts or ints");
      }
    }
    return indices;
  }

  GltfPrimitive ConvertPrimitive(const tinygltf::Primitive& primitive,
                                 const std::string& place) const {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
      Fail(place, fmt::format("mode {}", primitive.mode), "4 (triangles)");
    if (!primitive.targets.empty()) Fail(place, "morph targets", "a mesh without");
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
      Fail(place, "no POSITION", "an accessor of positions");
    TriangleMesh mesh;
    mesh.positions = Vectors(position->second, place + " POSITION");
    if (const auto normal = primitive.attributes.find("NORMAL");
        normal != primitive.attributes.end()) {
      mesh.normals = Vectors(normal->second, place + " NORMAL");
      if (mesh.normals.size() != mesh.positions.size()) {
        Fail(place + " NORMAL", fmt::format("{} normals", mesh.normals.size()),
             fmt::format("{}, as many as positions", mesh.positions.size()));
      }
    }
    if (const auto uv = primitive.attributes.find("TEXCOORD_0"); uv != primitive.attributes.end())
      mesh.uvs = TextureCoordinates(uv->second, place + " TEXCOORD_0", mesh.positions.size());
    AddTriangles(primitive, place + " indices", mesh);
    GltfPrimitive result = {std::move(mesh), std::nullopt};
    if (primitive.material != -1) {
      result.material = Index(place + " material", primitive.material, model_.materials.size());
    }
    return result;
  }

  void AddTriangles(const tinygltf::Primitive& primitive, const std::string& place,
                    TriangleMesh& mesh) const {
    const size_t vertices = mesh.positions.size();
    std::vector<uint32_t> indices;
    if (primitive.indices >= 0) {
      indices = Indices(primitive.indices, place);
    } else {
      memory_.Take(file_, place, 8 * vertices);
      for (uint32_t i = 0; i < vertices; ++i) indices.push_back(i);
    }
    if (indices.size() % 3 != 0)
      Fail(place, fmt::format("{} indices", indices.size()), "a multiple of three");
    for (size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] >= vertices) {
        Fail(place, fmt::format("index {} at {} with {} vertices", indices[i], i, vertices),
             "vertices that exist");
      }
    }
    for (size_t i = 0; i < indices.size(); i += 3) {
      mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
  }

  const fs::path& file_;
  const tinygltf::Model& model_;
  GltfMemory& memory_;
};

}  // namespace

size_t CheckedGltfIndex(const fs::path& file, std::string_view place, int index, size_t size) {
  if (index < 0 || static_cast<size_t>(index) >= size) {
    throw InputError::At(file, place, fmt::format("the index {} into {} elements", index, size),
                         "an index of one of them");
  }
  return static_cast<size_t>(index);
}

std::span<const unsigned char> GltfViewBytes(const fs::path& file, const tinygltf::Model& model,
                                             const std::string& place, int index) {
  const tinygltf::BufferView& view = model.bufferViews[CheckedGltfIndex(
      file, place + " bufferView", index, model.bufferViews.size())];
  const tinygltf::Buffer& buffer =
      model.buffers[CheckedGltfIndex(file, place + " buffer", view.buffer, model.buffers.size())];
  if (view.byteOffset > buffer.data.size() ||
      view.byteLength > buffer.data.size() - view.byteOffset) {
    throw InputError::At(
        file, place,
        fmt::format("a buffer view of {} bytes from byte {} in a buffer of {} bytes",
                    view.byteLength, view.byteOffset, buffer.data.size()),
        "bytes that are there");
  }
  return std::span(buffer.data).subspan(view.byteOffset, view.byteLength);
}

void GltfMemory::Take(const fs::path& file, std::string_view place, size_t bytes) {
  if (bytes > left_) {
    throw InputError::At(file, place,
                         fmt::format("data that are shared so often that they would take more than "
                                     "{} MiB",
                                     size_ >> 20),
                         "at most 256 MiB and eight times what the file holds");
  }
  left_ -= bytes;
}

std::vector<GltfPrimitive> ReadGltfMesh(const fs::path& file, const tinygltf::Model& model,
                                        size_t index, GltfMemory& memory) {
  return MeshConverter(file, model, memory).Convert(index);
}

}  // namespace retrolux
