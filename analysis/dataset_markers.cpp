#include "analysis/dataset_markers.h"

#include <algorithm>
#include <cmath>

#include "analysis/dataset_touching.h"
#include "scenes/marker_placement.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

constexpr int kTries = 60;
constexpr const char* kSheeting = "sheeting";
// What sheeting becomes where it is worn: its beads gone, a matt grey.
constexpr double kWornReflectance = 0.3;

// How far from the mask's rim a cut marker's middle lies: on the mask, and near enough that the rim
// cuts it.
constexpr Range kFromRim_mm{1.5, 5.0, false};

struct Kind {
  int number = 0;
  bool dark = false;
};

// The identifiable ones first, in random order, without repeat until all have come.
std::vector<Kind> DrawKinds(const MarkerRange& range, const std::string& polarity,
                            const SceneDraw& draw) {
  std::vector<std::pair<double, int>> order;
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) {
    if (shape.number != 0)
      order.emplace_back(draw.Uniform(fmt::format("order of {}", shape.number)), shape.number);
  }
  std::sort(order.begin(), order.end());
  const auto identifiable = static_cast<size_t>(range.identifiable.Draw(draw, "identifiable"));
  const auto standard = static_cast<size_t>(range.standard.Draw(draw, "standard"));
  std::vector<Kind> kinds;
  for (size_t i = 0; i < identifiable + standard; ++i) {
    const bool dark = polarity == "dark" ||
                      (polarity == "mixed" && draw.Chance(fmt::format("marker {} dark", i), 0.5));
    kinds.push_back({i < identifiable ? order[i % order.size()].second : 0, dark});
  }
  return kinds;
}

double RadiusOf(const MarkerSpec& marker) {
  const MarkerSet& set = DefaultMarkerSet();
  return marker.dark ? std::numbers::sqrt2 * 0.5 * set.dark_square_mm
                     : set.ByNumber(marker.number).Radius();
}

class Placer {
 public:
  Placer(const MarkerRange& range, const DatasetMask& mask, const SceneDraw& draw,
         DrawnScene& drawn)
      : range_(range), mask_(mask), draw_(draw), drawn_(drawn) {}

  // Whether there was room.
  bool Anywhere(MarkerSpec marker) {
    for (int i = 0; i < kTries; ++i) {
      const std::string name = fmt::format("{} try {}", marker.name, i);
      const SurfacePoint point =
          Nearest(mask_.PointAt(draw_.Uniform(name + " triangle"), draw_.Uniform(name + " u"),
                                draw_.Uniform(name + " v")));
      if (CanBeSeen(point) && IsFree(marker, point, false) && IsWhole(marker, point))
        return Put(marker, point);
    }
    return false;
  }

  bool AtRim(MarkerSpec marker) {
    for (int i = 0; i < kTries && !mask_.rim.empty(); ++i) {
      const std::string name = fmt::format("{} rim try {}", marker.name, i);
      const Vec3d rim = mask_.RimPointAt(draw_.Uniform(name));
      const Vec3d inward = (mask_.middle + Vec3d(mask_.middle.x(), 0, 0) - rim).normalized();
      const SurfacePoint point =
          Nearest(rim + kFromRim_mm.Draw(draw_, name + " distance") * inward);
      if (CanBeSeen(point) && IsFree(marker, point, false) && !IsWhole(marker, point))
        return Put(marker, point);
    }
    return false;
  }

  // Beside a marker that is there.
  bool Touching(MarkerSpec marker) {
    for (int i = 0; i < kTries && !drawn_.scene.markers.empty(); ++i) {
      const std::string name = fmt::format("{} touching try {}", marker.name, i);
      const size_t count = drawn_.scene.markers.size();
      const auto other =
          static_cast<size_t>(draw_.Uniform(name + " which") * static_cast<double>(count));
      const SurfacePoint point = TouchingPlace(mask_.mesh, drawn_.scene.markers[other], marker,
                                               2.0 * kPi * draw_.Uniform(name + " direction"));
      if (CanBeSeen(point) && IsFree(marker, point, true) && IsWhole(marker, point))
        return Put(marker, point);
    }
    return false;
  }

 private:
  SurfacePoint Nearest(const Vec3d& x) const { return NearestSurfacePoint(mask_.mesh, x); }

  // By one of the cameras, but for what may stand in between.
  bool CanBeSeen(const SurfacePoint& point) const {
    const RigidTransform& world_from_mask = drawn_.scene.Object(kMaskObject).world_from_object;
    const Vec3d position = world_from_mask * point.position;
    const Vec3d normal = world_from_mask.rotation * point.normal;
    const double least = std::cos(RadFromDeg(range_.max_incidence_deg));
    return std::any_of(drawn_.cameras.begin(), drawn_.cameras.end(), [&](const std::string& name) {
      const CameraModel& camera = drawn_.scene.Camera(name).model;
      const auto px = camera.Project(position);
      return px && camera.InFrame(*px) &&
             normal.dot((camera.Centre() - position).normalized()) >= least;
    });
  }

  // Far enough from all others; `but_for_one`: one neighbour may be nearer.
  bool IsFree(const MarkerSpec& marker, const SurfacePoint& point, bool but_for_one) const {
    int near = 0;
    for (const MarkerSpec& other : drawn_.scene.markers) {
      const double apart = RadiusOf(marker) + RadiusOf(other) + range_.clearance_mm;
      if ((other.at - point.position).norm() < apart) ++near;
    }
    return near <= (but_for_one ? 1 : 0);
  }

  // Whether the surface goes on under all of its outline.
  bool IsWhole(const MarkerSpec& marker, const SurfacePoint& point) const {
    if (mask_.rim.empty()) return true;
    constexpr int kAround = 8;
    constexpr double kBeside_mm = 0.3;
    const RigidTransform marker_from_mask = MarkerFromObject(point, marker.roll_deg);
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * kPi * i / kAround;
      const Vec3d place = RadiusOf(marker) * Vec3d(std::cos(angle), std::sin(angle), 0.0);
      const Vec3d on_surface =
          marker_from_mask * Nearest(marker_from_mask.Inverse() * place).position;
      // Off the rim the nearest point lies beside; on a bent surface above or below.
      if (std::abs(on_surface.z()) > DefaultMarkerSet().Side_mm(marker.dark)) return false;
      if ((on_surface - place).head<2>().norm() > kBeside_mm + std::abs(on_surface.z()))
        return false;
    }
    return true;
  }

  bool Put(MarkerSpec& marker, const SurfacePoint& point) {
    marker.at = point.position;
    drawn_.scene.markers.push_back(marker);
    return true;
  }

  const MarkerRange& range_;
  const DatasetMask& mask_;
  const SceneDraw& draw_;
  DrawnScene& drawn_;
};

void UseSheeting(Scene& scene, const std::string& material, double wear) {
  scene.UseMaterial(material);
  const Json worn = {{"type", "blend"},
                     {"share", wear},
                     {"one", {{"type", "diffuse"}, {"reflectance", kWornReflectance}}},
                     {"zero", scene.materials.at(material).spec}};
  scene.materials[kSheeting] =
      ReadMaterial(kSheeting, JsonReader::FromText(worn.dump(), kSheeting));
  scene.exposure.marker_material = material;
}

}  // namespace

void DrawMarkers(const MarkerRange& range, const DatasetMask& mask, const SceneDraw& draw,
                 DrawnScene& drawn) {
  const std::string& material = range.material.Draw(draw, "material");
  const std::string& polarity = range.polarity.Draw(draw, "polarity");
  const double wear = range.wear.Draw(draw, "wear");
  UseSheeting(drawn.scene, material, wear);

  const bool wants_rim = draw.Chance("at rim", range.at_rim);
  const bool wants_touching = draw.Chance("touching", range.touching);
  bool at_rim = false, touching = false;
  Placer placer(range, mask, draw, drawn);
  const std::vector<Kind> kinds = DrawKinds(range, polarity, draw);
  for (size_t i = 0; i < kinds.size(); ++i) {
    MarkerSpec marker;
    marker.name = fmt::format("marker-{}", i + 1);
    marker.number = kinds[i].number;
    marker.dark = kinds[i].dark;
    marker.object = kMaskObject;
    marker.material = kSheeting;
    marker.roll_deg = range.roll_deg.Draw(draw, marker.name + " roll");
    if (wants_rim && !at_rim && placer.AtRim(marker)) {
      at_rim = true;
    } else if (wants_touching && !touching && placer.Touching(marker)) {
      touching = true;
    } else {
      placer.Anywhere(marker);
    }
  }
  drawn.nuisances.update({{"material", material},
                          {"wear", wear},
                          {"polarity", polarity},
                          {"markers", drawn.scene.markers.size()},
                          {"at_rim", at_rim},
                          {"touching", touching}});
}

}  // namespace retrolux
