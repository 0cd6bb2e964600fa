// Checks of geometry: what a surface receives of another, and how much of a surface is seen.
#include <cmath>

#include "analysis/area_tests.h"
#include "analysis/cap_area.h"
#include "analysis/check.h"
#include "analysis/scene_tracer.h"
#include "core/sampling.h"

namespace retrolux {

namespace {

// A flat ring of triangles around the z axis at height z, facing +z or -z.
TriangleMesh DiscMesh(double radius, double z, bool faces_up) {
  constexpr uint32_t kCorners = 720;  // a polygon of the disc's area but for 1.3e-5
  TriangleMesh mesh;
  mesh.positions.emplace_back(0.0f, 0.0f, static_cast<float>(z));
  for (uint32_t i = 0; i < kCorners; ++i) {
    const double phi = 2.0 * kPi * i / kCorners;
    mesh.positions.push_back(
        Vec3d(radius * std::cos(phi), radius * std::sin(phi), z).cast<float>());
    const uint32_t a = i + 1, b = (i + 1) % kCorners + 1;
    mesh.triangles.push_back(faces_up ? std::array{0u, a, b} : std::array{0u, b, a});
  }
  return mesh;
}

// Mean over a white disc at z = 0 of what it sends upwards, where a black disc `height` above it
// hides a part of the even surroundings of radiance 1.
double MeanRadianceUnderDisc(double white_radius, double black_radius, double height, int samples) {
  Scene scene;
  scene.UseMaterial("black");
  scene.materials["white"] = ReadMaterial(
      "white", JsonReader::FromText(R"({"type": "diffuse", "reflectance": 1.0})", "white"));
  scene.objects.push_back({"white", DiscMesh(white_radius, 0.0, true), {}, "white"});
  scene.objects.push_back({"black", DiscMesh(black_radius, height, false), {}, "black"});
  scene.ambient.environment_w_m2_sr = 1.0;
  CameraSpec camera;
  camera.model = CameraModel::FromFieldOfView(
      "camera", 64, 64, 10.0, 10.0, LookAt({0, 0, 0.5 * height}, Vec3d::Zero(), Vec3d::UnitX()));
  scene.cameras.push_back(camera);
  const SceneTracer tracer(scene);
  double sum = 0.0;
  for (int s = 0; s < samples; ++s) {
    PixelSampler sampler(Mix64(17), static_cast<uint32_t>(s));
    const Vec2f place = SampleUnitDisc(sampler.Next2D());
    const auto radius = static_cast<float>(0.9999 * white_radius);
    const Vec3f below(radius * place.x(), radius * place.y(), 0.0f);
    const Vec3f above(below.x(), below.y(), static_cast<float>(0.5 * height));
    sum += tracer.Radiance(above, below, sampler);
  }
  return sum / samples;
}

}  // namespace

std::vector<Check> CheckFormFactor() {
  // Howell's catalogue, C-41: coaxial parallel discs of radii r1, r2 at distance h, with R = r / h,
  // X = 1 + (1 + R2^2) / R1^2: F12 = (X - sqrt(X^2 - 4 (R2 / R1)^2)) / 2. What of the white disc's
  // surroundings the black one does not hide is seen reflected: 1 - F12.
  constexpr int kSamples = 1 << 20;
  std::vector<Check> checks;
  for (const auto& [r1, r2, h] : {std::array{100.0, 100.0, 100.0}, std::array{100.0, 50.0, 40.0},
                                  std::array{50.0, 200.0, 300.0}}) {
    const double ra = r1 / h, rb = r2 / h;
    const double x = 1.0 + (1.0 + rb * rb) / (ra * ra);
    const double f12 = 0.5 * (x - std::sqrt(x * x - 4.0 * std::pow(rb / ra, 2)));
    // Each sample is 0 or 1 over the survival: a binomial count, 4 standard errors.
    const double error = std::sqrt(f12 * (1.0 - f12) / kSamples / 0.95);
    checks.push_back(
        {fmt::format("form factor of discs of radius {:g} and {:g} mm, {:g} mm apart", r1, r2, h),
         1.0 - MeanRadianceUnderDisc(r1, r2, h, kSamples), f12, 4.0 * error + 3e-5, "",
         "Howell, Catalog of Radiation Heat Transfer Configuration Factors, C-41; 4 standard "
         "errors"});
  }
  return checks;
}

std::vector<Check> CheckVisibleCaps() {
  // From the id pass, at the vault study's resolution: `retrolux study areas` does it at length.
  AreaStudyOptions options;
  AreaBench bench(options);
  std::vector<Check> checks;
  const auto worst = [](const std::vector<AreaRow>& rows) {
    const AreaRow* worst_row = &rows.front();
    for (const AreaRow& row : rows) {
      if (std::abs(*row.RelError()) > std::abs(*worst_row->RelError())) worst_row = &row;
    }
    return *worst_row;
  };
  const AreaRow single = worst(MeasureSingles(bench));
  checks.push_back({"cap that one camera sees of a sphere, worst of nine", *single.rendered_mm2,
                    *single.analytic_mm2, 1e-3 * *single.analytic_mm2, "mm2",
                    "2 pi r^2 (1 - r / d)"});
  const AreaRow pair = worst(MeasurePairs(bench, 3));
  checks.push_back({"what two cameras 120 degrees apart both see, worst of nine",
                    *pair.rendered_mm2, *pair.analytic_mm2, 2e-3 * *pair.analytic_mm2, "mm2",
                    "intersection of two spherical caps (Gauss-Bonnet)"});
  return checks;
}

}  // namespace retrolux
