#include "scenes/scene_json_values.h"

#include "core/data_path.h"

namespace retrolux {

namespace {

constexpr double kMaxLength_mm = 1e7;

}  // namespace

std::string Quoted(const std::string& text) {
  return '"' + text + '"';
}

bool HasSome(JsonReader& json, const std::string& key) {
  return json.Has(key) && !json.Child(key).Raw().is_null();
}

std::string TableName(JsonReader& json, const std::string& key, const std::string& fallback) {
  if (!json.Has(key)) return fallback;
  const std::string name = json.PathBelow(key);
  try {
    DataPath(name);
  } catch (const InputError&) {
    json.Child(key).Fail(fmt::format("no table {}", Quoted(name)),
                         "a table of the data folder, such as materials/data/fluorescent.csv");
  }
  return name;
}

Mat3d Matrix3(const JsonReader& node) {
  const std::vector<double> numbers = node.Numbers(9);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
}

Mat3d Rotation(const JsonReader& node) {
  const Mat3d r = Matrix3(node);
  if (!((r * r.transpose() - Mat3d::Identity()).norm() < 1e-6) || r.determinant() < 0.0) {
    node.Fail("a matrix that is no rotation", "orthonormal rows with determinant +1");
  }
  return r;
}

Vec3d Position(JsonReader& json, const std::string& key) {
  const JsonReader node = json.Child(key);
  const std::vector<double> v = node.Numbers(3);
  for (size_t i = 0; i < 3; ++i) node.Child(i).AsNumber(-kMaxLength_mm, kMaxLength_mm);
  return {v[0], v[1], v[2]};
}

Vec3d Position(JsonReader& json, const std::string& key, const Vec3d& fallback) {
  return json.Has(key) ? Position(json, key) : fallback;
}

}  // namespace retrolux
