#include "scenes/mesh_import.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scenes/gltf.h"
#include "scenes/mesh_weld.h"
#include "scenes/ply_file.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMeshFormats = ".glb, .gltf, .ply, .obj or .stl";
constexpr float kMaxCoordinate_mm = 1e9f;

// Lower case, without the dot.
std::string ExtensionOf(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ? extension : extension.substr(1);
}

bool IsAssimpFormat(const fs::path& file) {
  const std::string extension = ExtensionOf(file);
  return extension == "obj" || extension == "stl";
}

double MillimetresPer(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return 1.0;
    case LengthUnit::kCentimetre:
      return 10.0;
    case LengthUnit::kMetre:
      return 1000.0;
  }
  RETROLUX_CHECK(false, "unit {}", static_cast<int>(unit));
}

// Materials and pictures beside the file are of no use to us.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

// What the library says, or our words where it names its internals.
std::string ReasonOf(const std::string& message) {
  const std::string line = message.substr(0, message.find('\n'));
  return line.empty() || line.find("$$$") != std::string::npos ? "not what its name says" : line;
}

// A file as the library reads it; what it returns lives as long as this.
class AssimpFile {
 public:
  AssimpFile(const fs::path& file, unsigned int steps) {
    const std::string bytes = ReadTextFile(file);
    importer_.SetIOHandler(new NoOtherFiles);  // the importer owns it
    scene_ =
        importer_.ReadFileFromMemory(bytes.data(), bytes.size(), steps, ExtensionOf(file).c_str());
    if (scene_ == nullptr) {
      throw InputError::At(file, "",
                           fmt::format("cannot be read: {}", ReasonOf(importer_.GetErrorString())),
                           fmt::format("a whole {} file", ExtensionOf(file)));
    }
  }

  std::vector<const aiMesh*> Meshes() const {
    return {scene_->mMeshes, scene_->mMeshes + scene_->mNumMeshes};
  }

 private:
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
};

Vec3f Vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

bool IsUsableNormal(const Vec3f& normal) {
  return std::isfinite(normal.norm()) && normal.norm() > 0.0f;
}

Vec3f ScaledPosition(const fs::path& file, size_t index, const Vec3f& given, double scale) {
  Vec3f p = (given.cast<double>() * scale).cast<float>();
  if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kMaxCoordinate_mm) {
    throw InputError::At(file, fmt::format("vertex {}", index),
                         fmt::format("({}, {}, {})", given.x(), given.y(), given.z()),
                         fmt::format("finite coordinates below {:g} mm", kMaxCoordinate_mm));
  }
  return p;
}

bool HaveUsableNormals(const std::vector<const aiMesh*>& parts) {
  for (const aiMesh* part : parts) {
    if (!part->HasNormals()) return false;
    for (unsigned int i = 0; i < part->mNumVertices; ++i) {
      if (!IsUsableNormal(Vector(part->mNormals[i]))) return false;
    }
  }
  return true;
}

void AddPart(const fs::path& file, const aiMesh& part, double scale, bool with_normals,
             TriangleMesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (unsigned int i = 0; i < part.mNumVertices; ++i) {
    mesh.positions.push_back(ScaledPosition(file, i, Vector(part.mVertices[i]), scale));
    if (with_normals) mesh.normals.push_back(Vector(part.mNormals[i]).normalized());
  }
  for (unsigned int i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // what is left after the cut: points and lines
    const unsigned int* index = face.mIndices;
    for (int k = 0; k < 3; ++k) {
      if (index[k] >= part.mNumVertices) {
        throw InputError::At(file, fmt::format("face {}", i), fmt::format("vertex {}", index[k]),
                             fmt::format("one below {}", part.mNumVertices));
      }
    }
    mesh.triangles.push_back({first + index[0], first + index[1], first + index[2]});
  }
}

TriangleMesh ImportByAssimp(const fs::path& file, double scale) {
  const AssimpFile read(file, aiProcess_Triangulate);
  const std::vector<const aiMesh*> parts = read.Meshes();
  const bool with_normals = ExtensionOf(file) != "stl" && HaveUsableNormals(parts);
  TriangleMesh mesh;
  for (const aiMesh* part : parts) AddPart(file, *part, scale, with_normals, mesh);
  return mesh;
}

std::vector<Vec3f> VerticesByAssimp(const fs::path& file, double scale) {
  const AssimpFile read(file, 0);
  std::vector<Vec3f> points;
  for (const aiMesh* part : read.Meshes()) {
    for (unsigned int i = 0; i < part->mNumVertices; ++i)
      points.push_back(ScaledPosition(file, i, Vector(part->mVertices[i]), scale));
  }
  return points;
}

TriangleMesh ImportPly(const fs::path& file, double scale) {
  TriangleMesh mesh = ReadPly(file, ReadTextFile(file));
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = ScaledPosition(file, i, mesh.positions[i], scale);
  if (!std::all_of(mesh.normals.begin(), mesh.normals.end(), IsUsableNormal)) mesh.normals.clear();
  for (Vec3f& normal : mesh.normals) normal.normalize();
  return mesh;
}

// The numbers of a line up to a comment; nothing if it holds anything else.
std::optional<std::vector<double>> NumbersOf(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<double> numbers;
  const auto is_separator = [](char c) {
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
  };
  const char *at = line.data(), *end = line.data() + line.size();
  while (true) {
    at = std::find_if_not(at, end, is_separator);
    if (at == end) return numbers;
    double number = 0.0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || (rest != end && !is_separator(*rest))) return std::nullopt;
    numbers.push_back(number);
    at = rest;
  }
}

std::vector<Vec3f> ReadTextPoints(const fs::path& file, double scale) {
  const std::string text = ReadTextFile(file);
  std::vector<Vec3f> points;
  size_t number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    const std::string place = fmt::format("line {}", ++number);
    begin = end + 1;
    const std::optional<std::vector<double>> row = NumbersOf(line);
    if (row && row->empty()) continue;
    const bool has_columns = row && (row->size() == 3 || row->size() == 6);
    if (!has_columns ||
        !std::all_of(row->begin(), row->end(), [](double x) { return std::isfinite(x); })) {
      throw InputError::At(file, place, fmt::format("'{}'", line.substr(0, 60)),
                           "x y z, or x y z and a normal, as finite numbers");
    }
    points.push_back(ScaledPosition(file, points.size(),
                                    Vec3d((*row)[0], (*row)[1], (*row)[2]).cast<float>(), scale));
  }
  return points;
}

}  // namespace

LengthUnit ParseLengthUnit(const std::string& name) {
  if (name == "mm") return LengthUnit::kMillimetre;
  if (name == "cm") return LengthUnit::kCentimetre;
  if (name == "m") return LengthUnit::kMetre;
  throw InputError(fmt::format("unit '{}'; expected one of mm, cm, m", name));
}

bool IsGltf(const fs::path& file) {
  const std::string extension = ExtensionOf(file);
  return extension == "glb" || extension == "gltf";
}

TriangleMesh ImportMesh(const fs::path& file, LengthUnit unit) {
  TriangleMesh mesh;
  if (IsGltf(file)) {
    if (unit != LengthUnit::kMetre) {
      throw InputError::At(file, "", "a glTF file with a unit other than m",
                           "m: glTF is in metres by definition");
    }
    mesh = GltfFile(file).Mesh(UpAxis::kZ);
  } else if (ExtensionOf(file) == "ply") {
    mesh = ImportPly(file, MillimetresPer(unit));
  } else if (IsAssimpFormat(file)) {
    mesh = ImportByAssimp(file, MillimetresPer(unit));
  } else {
    throw InputError::At(file, "", fmt::format("the extension '{}'", file.extension().string()),
                         kMeshFormats);
  }
  if (mesh.triangles.empty())
    throw InputError::At(file, "", "no triangles",
                         "a mesh (for points: retrolux mask reconstruct)");
  mesh = WeldedExactly(mesh);
  if (!(mesh.Area() > 0.0)) throw InputError::At(file, "", "a mesh without area", "a surface");
  return mesh;
}

std::vector<Vec3f> ReadPointCloud(const fs::path& file, LengthUnit unit) {
  const std::string extension = ExtensionOf(file);
  std::vector<Vec3f> points;
  if (IsGltf(file)) {
    points = ImportMesh(file, unit).positions;
  } else if (extension == "ply") {
    points = ImportPly(file, MillimetresPer(unit)).positions;
  } else if (IsAssimpFormat(file)) {
    points = VerticesByAssimp(file, MillimetresPer(unit));
  } else if (extension == "xyz" || extension == "txt") {
    points = ReadTextPoints(file, MillimetresPer(unit));
  } else {
    throw InputError::At(file, "", fmt::format("the extension '{}'", file.extension().string()),
                         fmt::format(".xyz, .txt, {}", kMeshFormats));
  }
  if (points.empty()) throw InputError::At(file, "", "no points", "a point cloud");
  return points;
}

}  // namespace retrolux
