#include "renderer/lights.h"

#include <cmath>

#include "core/data_path.h"
#include "core/sampling.h"

namespace retrolux {

namespace {

constexpr float kSquareMetrePerSquareMm = 1e-6f;

// Density over area (1/mm2) to density over directions (1/sr).
float SolidAnglePdf(float area_pdf, float distance2, float cosine) { return area_pdf * distance2 / cosine; }

}  // namespace

// Intensity I0 cos^m over a disc of area A: radiance I0 cos^(m-1) / A. The disc is small, so that its intensity
// is that of the LED.
float Lights::Ring::RadianceAt(float cos_theta) const {
  return cos_theta > 0.0f ? intensity * std::pow(cos_theta, exponent - 1.0f) / led_area_m2 : 0.0f;
}

int Lights::SpectrumIndex(double peak_nm, double fwhm_nm) {
  const std::pair<double, double> type(peak_nm, fwhm_nm);
  for (size_t i = 0; i < led_types_.size(); ++i) {
    if (led_types_[i] == type) return static_cast<int>(i);
  }
  led_types_.push_back(type);
  spectra_.push_back(LedSpectrum(peak_nm, fwhm_nm));
  return static_cast<int>(spectra_.size()) - 1;
}

Lights::Lights(const Scene& scene, const RayScene& rays, RingChoice choice, const std::string& own_camera)
    : panels_(scene.ambient.panels) {
  uint32_t body = rays.ObjectCount();
  group_of_body_.assign(rays.BodyNames().size(), -1);
  for (const CameraSpec& camera : scene.cameras) {
    if (!camera.ring) continue;
    const uint32_t ring_body = body++;
    if (choice == RingChoice::kOwn && camera.model.name != own_camera) continue;
    const DiodeRing& spec = *camera.ring;
    Ring ring;
    for (int i = 0; i < spec.count; ++i) ring.leds.push_back(LedCentre(camera, i).cast<float>());
    ring.axis = camera.model.Forward().cast<float>();
    const Frame frame(ring.axis);
    ring.tangent = frame.tangent;
    ring.bitangent = frame.bitangent;
    ring.led_radius = static_cast<float>(spec.led_radius_mm);
    ring.led_area_m2 = kPiF * ring.led_radius * ring.led_radius * kSquareMetrePerSquareMm;
    ring.intensity = static_cast<float>(spec.radiant_intensity_w_sr);
    ring.exponent = static_cast<float>(spec.LambertExponent());
    group_of_body_[ring_body] = GroupCount();
    groups_.push_back({camera.model.name, Kind::kRing, SpectrumIndex(spec.peak_nm, spec.fwhm_nm), ring_body});
    rings_.push_back(std::move(ring));
  }
  spectra_.push_back(Spectrum::FromTable(DataPath(scene.ambient.spectrum)).Normalised());
  const int ambient = static_cast<int>(spectra_.size()) - 1;
  panel_radiance_ = static_cast<float>(scene.ambient.radiance_w_m2_sr);
  environment_radiance_ = static_cast<float>(scene.ambient.environment_w_m2_sr);
  if (!panels_.empty()) {
    group_of_body_[body] = GroupCount();
    groups_.push_back({"ambient", Kind::kPanels, ambient, body});
    double area = 0.0;
    for (const LightPanel& panel : panels_) panel_areas_cumulative_.push_back(area += panel.edge_u.cross(panel.edge_v).norm());
  } else if (environment_radiance_ > 0.0f) {
    groups_.push_back({"ambient", Kind::kEnvironment, ambient, body});
  }  // panels and environment together are one group
  if (GroupCount() > kMaxLightGroups) {
    throw InputError(fmt::format("{} light groups; expected at most {}", GroupCount(), kMaxLightGroups));
  }
}

std::vector<std::string> Lights::GroupNames() const {
  std::vector<std::string> names;
  for (const Group& group : groups_) names.push_back(group.name);
  return names;
}

std::optional<LightSample> Lights::Sample(int group, const Vec3f& x, float pick, const Vec2f& u) const {
  switch (groups_[static_cast<size_t>(group)].kind) {
    case Kind::kRing: return SampleRing(rings_[static_cast<size_t>(group)], x, pick, u);
    case Kind::kPanels: return SamplePanels(x, pick, u);
    case Kind::kEnvironment: return std::nullopt;
  }
  return std::nullopt;
}

std::optional<LightSample> Lights::SampleRing(const Ring& ring, const Vec3f& x, float pick, const Vec2f& u) const {
  const auto count = static_cast<float>(ring.leds.size());
  const Vec3f& centre = ring.leds[std::min(static_cast<size_t>(pick * count), ring.leds.size() - 1)];
  const Vec2f d = SampleUnitDisc(u) * ring.led_radius;
  LightSample sample;
  sample.position = centre + d.x() * ring.tangent + d.y() * ring.bitangent;
  const Vec3f offset = sample.position - x;
  const float distance2 = offset.squaredNorm();
  sample.direction = offset / std::sqrt(distance2);
  const float cos_led = -sample.direction.dot(ring.axis);
  if (cos_led <= 0.0f) return std::nullopt;
  sample.radiance = ring.RadianceAt(cos_led);
  const float area_mm2 = kPiF * ring.led_radius * ring.led_radius;
  sample.pdf = SolidAnglePdf(1.0f / (count * area_mm2), distance2, cos_led);
  return sample;
}

std::optional<LightSample> Lights::SamplePanels(const Vec3f& x, float pick, const Vec2f& u) const {
  const double target = static_cast<double>(pick) * panel_areas_cumulative_.back();
  size_t index = 0;
  while (index + 1 < panels_.size() && panel_areas_cumulative_[index] <= target) ++index;
  const LightPanel& panel = panels_[index];
  LightSample sample;
  sample.position = (panel.corner + static_cast<double>(u.x()) * panel.edge_u +
                     static_cast<double>(u.y()) * panel.edge_v).cast<float>();
  const Vec3f offset = sample.position - x;
  sample.direction = offset.normalized();
  const float cos_panel = -sample.direction.dot(panel.edge_u.cross(panel.edge_v).normalized().cast<float>());
  if (cos_panel <= 0.0f) return std::nullopt;
  sample.radiance = panel_radiance_;
  sample.pdf = PanelPdf(x, sample.position, cos_panel);
  return sample;
}

float Lights::PanelPdf(const Vec3f& x, const Vec3f& position, float cos_panel) const {
  return SolidAnglePdf(1.0f / static_cast<float>(panel_areas_cumulative_.back()), (position - x).squaredNorm(), cos_panel);
}

std::optional<Lights::Emission> Lights::Emitted(const Vec3f& origin, const Vec3f& direction,
                                                const SurfaceHit& hit) const {
  const int group = group_of_body_[hit.body];
  if (group < 0) return std::nullopt;
  if (groups_[static_cast<size_t>(group)].kind == Kind::kRing) {
    const Ring& ring = rings_[static_cast<size_t>(group)];
    const float cos_led = -direction.dot(ring.axis);
    if (cos_led <= 0.0f) return std::nullopt;
    const float area = kPiF * ring.led_radius * ring.led_radius * static_cast<float>(ring.leds.size());
    return Emission{group, ring.RadianceAt(cos_led),
                    SolidAnglePdf(1.0f / area, (hit.position - origin).squaredNorm(), cos_led)};
  }
  const LightPanel& panel = panels_[hit.primitive / 2];
  const float cos_panel = -direction.dot(panel.edge_u.cross(panel.edge_v).normalized().cast<float>());
  if (cos_panel <= 0.0f) return std::nullopt;
  return Emission{group, panel_radiance_, PanelPdf(origin, hit.position, cos_panel)};
}

std::optional<Lights::Emission> Lights::Environment() const {
  if (environment_radiance_ <= 0.0f) return std::nullopt;
  return Emission{GroupCount() - 1, environment_radiance_, 0.0f};
}

}  // namespace retrolux
