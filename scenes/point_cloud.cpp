#include "scenes/point_cloud.h"

#include <cmath>
#include <iterator>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/rng.h"

namespace retrolux {

namespace {

// Two independent normal deviates (Box and Muller 1958).
Vec2d NormalPair(KeyedRng& rng) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - rng.NextDouble()));
  const double angle = 2.0 * kPi * rng.NextDouble();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Uniform on the triangle (Osada et al. 2002).
Vec3d PointOn(const TriangleMesh& mesh, size_t triangle, KeyedRng& rng) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const double root = std::sqrt(rng.NextDouble()), v = rng.NextDouble();
  return (1.0 - root) * mesh.positions[a].cast<double>() +
         root * (1.0 - v) * mesh.positions[b].cast<double>() +
         root * v * mesh.positions[c].cast<double>();
}

std::vector<double> CumulativeAreas(const TriangleMesh& mesh) {
  std::vector<double> cumulative;
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d p = mesh.positions[a].cast<double>();
    sum +=
        0.5 *
        (mesh.positions[b].cast<double>() - p).cross(mesh.positions[c].cast<double>() - p).norm();
    cumulative.push_back(sum);
  }
  return cumulative;
}

}  // namespace

std::vector<Vec3f> SampleSurface(const TriangleMesh& mesh, int count, double noise_mm,
                                 uint64_t seed) {
  RETROLUX_CHECK(!mesh.triangles.empty() && count > 0 && noise_mm >= 0.0, "{} points, {} mm", count,
                 noise_mm);
  const std::vector<double> cumulative = CumulativeAreas(mesh);
  std::vector<Vec3f> points;
  for (int i = 0; i < count; ++i) {
    KeyedRng rng(CombineKeys(seed, static_cast<uint64_t>(i)));
    const double area = (i + rng.NextDouble()) / count * cumulative.back();
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, area);
    const Vec3d on_surface = PointOn(mesh, static_cast<size_t>(found - cumulative.begin()), rng);
    const Vec2d xy = NormalPair(rng), z = NormalPair(rng);
    points.push_back((on_surface + noise_mm * Vec3d(xy.x(), xy.y(), z.x())).cast<float>());
  }
  return points;
}

void WritePointCloud(const std::vector<Vec3f>& points, const std::filesystem::path& file) {
  const bool is_ply = file.extension() == ".ply";
  if (!is_ply && file.extension() != ".xyz") {
    throw InputError::At(file, "", fmt::format("the extension '{}'", file.extension().string()),
                         ".ply or .xyz");
  }
  std::string text;
  auto out = std::back_inserter(text);
  if (is_ply) {
    fmt::format_to(out,
                   "ply\nformat ascii 1.0\ncomment lengths in mm\nelement vertex {}\n"
                   "property float x\nproperty float y\nproperty float z\nend_header\n",
                   points.size());
  } else {
    fmt::format_to(out, "# x y z in mm\n");
  }
  for (const Vec3f& p : points) fmt::format_to(out, "{} {} {}\n", p.x(), p.y(), p.z());
  WriteTextFile(file, text);
}

}  // namespace retrolux
