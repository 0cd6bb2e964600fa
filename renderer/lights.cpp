#include "renderer/lights.h"

#include <cmath>

#include "core/data_path.h"

namespace retrolux {

namespace {

constexpr float kSquareMetrePerSquareMm = 1e-6f;

// Density over area (1/mm2) to density over directions (1/sr).
float SolidAnglePdf(float area_pdf, float distance2, float cosine) {
  return area_pdf * distance2 / cosine;
}

}  // namespace

// Intensity I0 cos^m over a disc of area A: radiance I0 cos^(m-1) / A. The disc is small, so that
// its intensity is that of the LED.
float Lights::Ring::RadianceAt(float cos_theta) const {
  if (cos_theta <= 0.0f) return 0.0f;
  return intensity * std::pow(cos_theta, exponent - 1.0f) /
         (led_area_mm2 * kSquareMetrePerSquareMm);
}

int Lights::SpectrumIndex(const LedType& type) {
  for (size_t i = 0; i < led_types_.size(); ++i) {
    if (led_types_[i] == type) return static_cast<int>(i);
  }
  led_types_.push_back(type);
  spectra_.push_back(LedSpectrum(type));
  return static_cast<int>(spectra_.size()) - 1;
}

Lights::Lights(const Scene& scene, const RayScene& rays, RingChoice choice,
               const std::string& own_camera)
    : panels_(scene.ambient.panels) {
  uint32_t body = rays.ObjectCount();
  group_of_body_.assign(rays.BodyNames().size(), -1);
  for (const CameraSpec& camera : scene.cameras) {
    if (!camera.ring) continue;
    const uint32_t ring_body = body++;
    if (choice == RingChoice::kOwn && camera.model.name != own_camera) continue;
    const DiodeRing& spec = *camera.ring;
    Ring ring;
    for (int i = 0; i < spec.count; ++i) {
      ring.centres.push_back(LedCentre(camera, i).cast<float>());
      const std::array<Vec3d, kLedCorners> outline = LedOutline(camera, i);
      std::array<Vec3f, kLedCorners>& corners = ring.outlines.emplace_back();
      for (size_t k = 0; k < corners.size(); ++k) corners[k] = outline[k].cast<float>();
    }
    ring.axis = camera.model.Forward().cast<float>();
    ring.led_area_mm2 = static_cast<float>(kPi * spec.led_radius_mm * spec.led_radius_mm);
    ring.intensity = static_cast<float>(spec.Intensity_w_sr());
    ring.exponent = static_cast<float>(spec.LambertExponent());
    group_of_body_[ring_body] = GroupCount();
    groups_.push_back({camera.model.name, Kind::kRing, SpectrumIndex(spec.Led()), ring_body});
    rings_.push_back(std::move(ring));
  }
  spectra_.push_back(Spectrum::FromTable(DataPath(scene.ambient.spectrum)).Normalised());
  const int ambient = static_cast<int>(spectra_.size()) - 1;
  panel_radiance_ = static_cast<float>(scene.ambient.radiance_w_m2_sr);
  environment_radiance_ = static_cast<float>(scene.ambient.environment_w_m2_sr);
  if (!panels_.empty()) {
    group_of_body_[body] = GroupCount();
    groups_.push_back({kAmbientGroup, Kind::kPanels, ambient, body});
    double area = 0.0;
    for (const LightPanel& panel : panels_)
      panel_areas_cumulative_.push_back(area += panel.edge_u.cross(panel.edge_v).norm());
  } else if (environment_radiance_ > 0.0f) {
    groups_.push_back({kAmbientGroup, Kind::kEnvironment, ambient, body});
  }  // panels and environment together are one group
  if (GroupCount() > kMaxLightGroups) {
    throw InputError(
        fmt::format("{} light groups; expected at most {}", GroupCount(), kMaxLightGroups));
  }
}

std::vector<std::string> Lights::GroupNames() const {
  std::vector<std::string> names;
  for (const Group& group : groups_) names.push_back(group.name);
  return names;
}

std::optional<LightSample> Lights::Sample(int group, const Vec3f& x, float pick,
                                          const Vec2f& u) const {
  switch (groups_[static_cast<size_t>(group)].kind) {
    case Kind::kRing:
      return SampleRing(rings_[static_cast<size_t>(group)], x, pick, u);
    case Kind::kPanels:
      return SamplePanels(x, pick, u);
    case Kind::kEnvironment:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<LightSample> Lights::SampleRing(const Ring& ring, const Vec3f& x, float pick,
                                              const Vec2f& u) const {
  // `pick` chooses the LED, u the triangle and the place in it: all triangles have the same area.
  // Angles are counted from the direction away from the ring's centre, so that u alone decides how
  // far from the axis the point is, on which retro-reflection depends: else it would depend on how
  // u and `pick` fall together, and only each of them is well spread.
  const auto count = static_cast<float>(ring.centres.size());
  const size_t led = std::min(static_cast<size_t>(pick * count), ring.centres.size() - 1);
  const float turn = u.x() + static_cast<float>(led) / count;
  const float along = (turn - std::floor(turn)) * kLedCorners;
  const size_t corner = std::min(static_cast<size_t>(along), ring.outlines[led].size() - 1);
  const float root = std::sqrt(u.y());
  const float b = root * (along - static_cast<float>(corner));
  const Vec3f& centre = ring.centres[led];
  const Vec3f& first = ring.outlines[led][corner];
  const Vec3f& second = ring.outlines[led][(corner + 1) % kLedCorners];
  LightSample sample;
  sample.position = centre + (root - b) * (first - centre) + b * (second - centre);
  const Vec3f offset = sample.position - x;
  const float distance2 = offset.squaredNorm();
  sample.direction = offset / std::sqrt(distance2);
  const float cos_led = -sample.direction.dot(ring.axis);
  if (cos_led <= 0.0f) return std::nullopt;
  sample.radiance = ring.RadianceAt(cos_led);
  sample.pdf = RingPdf(ring, distance2, cos_led);
  return sample;
}

float Lights::RingPdf(const Ring& ring, float distance2, float cos_led) {
  return SolidAnglePdf(1.0f / (static_cast<float>(ring.centres.size()) * ring.led_area_mm2),
                       distance2, cos_led);
}

std::optional<LightSample> Lights::SamplePanels(const Vec3f& x, float pick, const Vec2f& u) const {
  const double target = static_cast<double>(pick) * panel_areas_cumulative_.back();
  size_t index = 0;
  while (index + 1 < panels_.size() && panel_areas_cumulative_[index] <= target) ++index;
  const LightPanel& panel = panels_[index];
  LightSample sample;
  sample.position = (panel.corner + static_cast<double>(u.x()) * panel.edge_u +
                     static_cast<double>(u.y()) * panel.edge_v)
                        .cast<float>();
  const Vec3f offset = sample.position - x;
  sample.direction = offset.normalized();
  const float cos_panel =
      -sample.direction.dot(panel.edge_u.cross(panel.edge_v).normalized().cast<float>());
  if (cos_panel <= 0.0f) return std::nullopt;
  sample.radiance = panel_radiance_;
  sample.pdf = PanelPdf(x, sample.position, cos_panel);
  return sample;
}

float Lights::PanelPdf(const Vec3f& x, const Vec3f& position, float cos_panel) const {
  return SolidAnglePdf(1.0f / static_cast<float>(panel_areas_cumulative_.back()),
                       (position - x).squaredNorm(), cos_panel);
}

std::optional<Lights::Emission> Lights::Emitted(const Vec3f& origin, const Vec3f& direction,
                                                const SurfaceHit& hit) const {
  const int group = group_of_body_[hit.body];
  if (group < 0) return std::nullopt;
  if (groups_[static_cast<size_t>(group)].kind == Kind::kRing) {
    const Ring& ring = rings_[static_cast<size_t>(group)];
    const float cos_led = -direction.dot(ring.axis);
    if (cos_led <= 0.0f) return std::nullopt;
    return Emission{group, ring.RadianceAt(cos_led),
                    RingPdf(ring, (hit.position - origin).squaredNorm(), cos_led)};
  }
  const LightPanel& panel = panels_[hit.primitive / 2];
  const float cos_panel =
      -direction.dot(panel.edge_u.cross(panel.edge_v).normalized().cast<float>());
  if (cos_panel <= 0.0f) return std::nullopt;
  return Emission{group, panel_radiance_, PanelPdf(origin, hit.position, cos_panel)};
}

std::optional<Lights::Emission> Lights::Environment() const {
  if (environment_radiance_ <= 0.0f) return std::nullopt;
  return Emission{GroupCount() - 1, environment_radiance_, 0.0f};
}

}  // namespace retrolux
