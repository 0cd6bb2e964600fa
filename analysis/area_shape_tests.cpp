#include <algorithm>
#include <cmath>

#include "analysis/area_shapes.h"
#include "analysis/area_tests.h"
#include "analysis/cap_area.h"
#include "analysis/disc_area.h"
#include "analysis/ellipsoid_area.h"
#include "core/rng.h"
#include "scenes/mesh_shapes.h"
#include "scenes/rig_layout.h"

namespace retrolux {

namespace {

constexpr double kRadius = kAreaSphereRadius_mm;
constexpr double kShapePart_mm2 = 0.4;  // of discs and ovals
constexpr int kDiscRings = 58;          // 20,184 triangles
const Vec3d kOval(100.0, 100.0, 140.0);

double AreaOfFirst(const Mask& mask, const SampleSet& seen, size_t triangles) {
  double area = 0.0;
  for (size_t i = 0; i < mask.Samples().Size(); ++i) {
    if (mask.Samples().triangles[i] < triangles && Contains(seen, i))
      area += static_cast<double>(mask.Samples().areas_mm2[i]);
  }
  return area;
}

AreaRow DiscRow(AreaBench& bench, const Mask& disc, double tilt_deg, bool two_sided) {
  const double tilt = RadFromDeg(tilt_deg);
  const Vec3d direction(std::sin(tilt), 0.0, std::cos(tilt));
  // The random rotation turns disc and camera alike: pixels lie at random on it.
  const Mat3d& turn = bench.Rotation();
  const CameraModel camera = bench.Camera(turn * direction);
  AreaRow row;
  row.test = "disc";
  row.group = two_sided ? "two-sided" : "one-sided";
  row.name = fmt::format("tilt {:g} deg", tilt_deg);
  row.x = tilt_deg;
  row.rendered_mm2 = disc.AreaOf(AreaBench::Seen(disc, turn, {camera})[0]);
  const Vec3d facing(0.0, 0.0, two_sided && direction.z() < 0.0 ? -1.0 : 1.0);
  row.analytic_mm2 =
      DiscVisibleArea({Vec3d::Zero(), facing, kRadius}, bench.Distance_mm() * direction);
  return row;
}

}  // namespace

std::vector<AreaRow> MeasureDiscs(AreaBench& bench) {
  std::vector<AreaRow> rows;
  for (const bool two_sided : {false, true}) {
    TriangleMesh mesh = DiscMesh(kRadius, kDiscRings);
    if (two_sided) mesh = WithBack(std::move(mesh));
    const Mask disc("disc", mesh, bench.Options().rule, kShapePart_mm2, bench.Options().seed);
    for (const double tilt_deg : {0.0, 30.0, 60.0, 75.0, 85.0, 89.0, 91.0, 120.0, 180.0})
      rows.push_back(DiscRow(bench, disc, tilt_deg, two_sided));
  }
  return rows;
}

namespace {

struct NamedDirection {
  const char* name;
  Vec3d direction;
};

const NamedDirection kOvalViews[] = {{"end on", {0.0, 0.0, 1.0}},
                                     {"side on", {1.0, 0.0, 0.0}},
                                     {"30 deg off the end", {0.5, 0.0, 0.8660254037844386}},
                                     {"60 deg off the end", {0.8660254037844386, 0.0, 0.5}},
                                     {"oblique", {-0.3, 0.7, -0.5}},
                                     {"oblique, behind", {0.6, -0.2, 0.4}}};

// As far away as the vault lets cameras stand: from 1600 mm the oval is longer than the picture is
// high.
AreaRow OvalRow(const AreaBench& bench, const Mask& oval,
                const std::vector<NamedDirection>& views) {
  const double distance = bench.Room().rigs.max_distance_mm;
  std::vector<CameraModel> cameras;
  std::vector<Vec3d> centres;
  std::string name;
  for (const NamedDirection& view : views) {
    centres.push_back(distance * view.direction.normalized());
    cameras.push_back(VaultCamera(bench.Room(), "camera", bench.Rotation() * centres.back()));
    name += fmt::format("{}{}", name.empty() ? "" : " and ", view.name);
  }
  const std::vector<SampleSet> seen = AreaBench::Seen(oval, bench.Rotation(), cameras);
  AreaRow row;
  row.test = "ellipsoid";
  row.group = views.size() == 1 ? "single" : "pair";
  row.name = name;
  row.rendered_mm2 = oval.AreaOf(seen.size() == 1 ? seen[0] : InBoth(seen[0], seen[1]));
  row.analytic_mm2 = EllipsoidVisibleArea(kOval, centres);
  if (seen.size() == 2)
    row.psi_deg = DegFromRad(std::acos(centres[0].normalized().dot(centres[1].normalized())));
  return row;
}

}  // namespace

std::vector<AreaRow> MeasureEllipsoids(AreaBench& bench) {
  const Mask oval("oval", EllipsoidMesh(kOval, bench.Options().levels), bench.Options().rule,
                  kShapePart_mm2, bench.Options().seed);
  std::vector<AreaRow> rows;
  for (const NamedDirection& view : kOvalViews) rows.push_back(OvalRow(bench, oval, {view}));
  rows.push_back(OvalRow(bench, oval, {kOvalViews[0], kOvalViews[1]}));
  rows.push_back(OvalRow(bench, oval, {kOvalViews[3], kOvalViews[4]}));
  return rows;
}

namespace {

// What is varied along an axis while the others stay as they are asked for. Of the sphere's samples
// a triangle has 4 x 4: 1.3 million by default.
constexpr int kBaseParts = 4;

struct Setting {
  int width_px, height_px, levels;
  double part_area_mm2;
};

double TriangleArea(int levels) {
  return 4.0 * kPi * kRadius * kRadius / (20.0 * std::pow(4.0, levels));
}

// That each triangle is cut into parts x parts: the sphere's largest ones are up to 1.3 times the
// mean.
double PartOf(int levels, int parts) {
  return 1.3 * TriangleArea(levels) / (parts * parts);
}

Setting SettingOf(const AreaStudyOptions& options, const AreaSetting& asked) {
  Setting setting{options.width_px, options.height_px, options.levels,
                  PartOf(options.levels, kBaseParts)};
  if (asked.axis == AreaAxis::kResolution) {
    setting.width_px = asked.value;
    setting.height_px = std::max(1, options.height_px * asked.value / options.width_px);
  }
  if (asked.axis == AreaAxis::kSamples) setting.part_area_mm2 = PartOf(options.levels, asked.value);
  if (asked.axis == AreaAxis::kTriangles) setting.levels = asked.value;
  return setting;
}

// A disc that is as good as a sphere of that many levels: triangles of the same size.
int RingsOf(int levels) {
  return static_cast<int>(
      std::lround(std::sqrt(kPi * kRadius * kRadius / TriangleArea(levels) / 6.0)));
}

double AxisValue(const AreaSetting& setting, const Mask& mask, size_t triangles) {
  if (setting.axis == AreaAxis::kResolution) return setting.value;
  if (setting.axis == AreaAxis::kTriangles) return static_cast<double>(triangles);
  const auto& of = mask.Samples().triangles;
  return static_cast<double>(
      std::count_if(of.begin(), of.end(), [&](uint32_t t) { return t < triangles; }));
}

AreaRow SettingRow(const AreaSetting& asked, const char* shape, double x, int rotation) {
  AreaRow row;
  row.test = "convergence";
  row.group = fmt::format("{}, {}, {}", shape, NameOf(asked.rule), NameOf(asked.axis));
  row.name = fmt::format("{:.0f}, rotation {}", x, rotation + 1);
  row.x = x;
  return row;
}

std::vector<AreaRow> MeasureSphereSetting(AreaBench& bench, const AreaSetting& asked) {
  constexpr double kPsi = 2.0 * kPi / 3.0;
  const Setting setting = SettingOf(bench.Options(), asked);
  const Mask sphere("sphere", EllipsoidMesh(Vec3d::Constant(kRadius), setting.levels), asked.rule,
                    setting.part_area_mm2, bench.Options().seed);
  const double x = AxisValue(asked, sphere, sphere.Mesh().triangles.size());
  const double half_angle = std::acos(kRadius / bench.Distance_mm());
  const std::vector<CameraModel> cameras = {
      bench.Camera(Vec3d::UnitX()).Resized(setting.width_px, setting.height_px),
      bench.Camera({std::cos(kPsi), std::sin(kPsi), 0.0})
          .Resized(setting.width_px, setting.height_px)};
  const auto rotations = static_cast<size_t>(bench.Options().rotations);
  std::vector<AreaRow> rows(2 * rotations);
  ParallelFor(bench.Options().rotations, [&](int64_t i) {
    const int rotation = static_cast<int>(i);
    const Mat3d turn =
        RandomRotation(CombineKeys(bench.Options().seed, 1000 + static_cast<uint64_t>(i)));
    const std::vector<SampleSet> seen = AreaBench::Seen(sphere, turn, cameras);
    AreaRow cap = SettingRow(asked, "cap", x, rotation);
    cap.rendered_mm2 = sphere.AreaOf(seen[0]);
    cap.analytic_mm2 = CapArea(kRadius, half_angle);
    AreaRow pair = SettingRow(asked, "pair at 120 deg", x, rotation);
    pair.psi_deg = 120.0;
    pair.rendered_mm2 = sphere.AreaOf(InBoth(seen[0], seen[1]));
    pair.analytic_mm2 = TwoCapArea(kRadius, half_angle, half_angle, kPsi);
    rows[static_cast<size_t>(i)] = cap;
    rows[rotations + static_cast<size_t>(i)] = pair;
  });
  return rows;
}

// A sheet 100 mm before the disc, as small as it may be to hide a half of it from all views.
constexpr double kSheetHeight_mm = 100.0, kSheetReach_mm = 130.0;

TriangleMesh HalfHiddenDisc(int rings) {
  TriangleMesh mesh = DiscMesh(kRadius, rings);
  mesh.Append(RectangleMesh({0.0, -kSheetReach_mm, kSheetHeight_mm}, {kSheetReach_mm, 0.0, 0.0},
                            {0.0, 2.0 * kSheetReach_mm, 0.0}));
  return mesh;
}

// A view from within 10 degrees of the normal, the picture turned at random.
CameraModel ViewOfDisc(const AreaBench& bench, const Mat3d& turn, uint64_t key,
                       const Setting& setting, Vec3d& centre) {
  KeyedRng rng(key);
  const double tilt = RadFromDeg(10.0 * rng.NextDouble()), azimuth = 2.0 * kPi * rng.NextDouble();
  const Vec3d direction(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                        std::cos(tilt));
  centre = bench.Distance_mm() * direction;
  return bench.Camera(turn * direction).Resized(setting.width_px, setting.height_px);
}

std::vector<AreaRow> MeasureDiscSetting(AreaBench& bench, const AreaSetting& asked) {
  const Setting setting = SettingOf(bench.Options(), asked);
  const int rings = RingsOf(setting.levels);
  const auto triangles = static_cast<size_t>(6 * rings * rings);
  const Mask disc("disc", HalfHiddenDisc(rings), asked.rule, setting.part_area_mm2,
                  bench.Options().seed);
  const double x = AxisValue(asked, disc, triangles);
  std::vector<AreaRow> rows(static_cast<size_t>(bench.Options().rotations));
  ParallelFor(bench.Options().rotations, [&](int64_t i) {
    const uint64_t key = CombineKeys(bench.Options().seed, 1000 + static_cast<uint64_t>(i));
    const Mat3d turn = RandomRotation(key);
    Vec3d centre;
    const CameraModel camera = ViewOfDisc(bench, turn, key, setting, centre);
    AreaRow row = SettingRow(asked, "half-hidden disc", x, static_cast<int>(i));
    row.rendered_mm2 = AreaOfFirst(disc, AreaBench::Seen(disc, turn, {camera})[0], triangles);
    row.analytic_mm2 =
        DiscVisibleArea({Vec3d::Zero(), Vec3d::UnitZ(), kRadius},
                        {{0.0, 0.0, kSheetHeight_mm}, Vec3d::UnitY(), Vec3d::UnitX()}, centre);
    rows[static_cast<size_t>(i)] = row;
  });
  return rows;
}

}  // namespace

const char* NameOf(AreaAxis axis) {
  constexpr const char* kNames[] = {"pixels across", "samples", "triangles"};
  return kNames[static_cast<size_t>(axis)];
}

std::vector<AreaSetting> AreaSettings(const AreaStudyOptions& options) {
  std::vector<AreaSetting> settings;
  for (const bool disc : {false, true}) {
    for (const VisibilityRule rule :
         {VisibilityRule::kIdBuffer, VisibilityRule::kRays, VisibilityRule::kTriangles}) {
      for (const int quarters : {1, 2, 4, 8})
        settings.push_back({disc, rule, AreaAxis::kResolution, options.width_px * quarters / 4});
      if (rule != VisibilityRule::kTriangles) {  // which has one sample a triangle
        for (const int parts : {1, 2, 4, 8})
          settings.push_back({disc, rule, AreaAxis::kSamples, parts});
      }
      for (int levels = std::min(3, options.levels); levels <= options.levels + 1; ++levels)
        settings.push_back({disc, rule, AreaAxis::kTriangles, levels});
    }
  }
  return settings;
}

std::vector<AreaRow> MeasureSetting(AreaBench& bench, const AreaSetting& setting) {
  return setting.disc ? MeasureDiscSetting(bench, setting) : MeasureSphereSetting(bench, setting);
}

}  // namespace retrolux
