// The light sources of a scene, by light group: each ring is its own group, the room's light
// another. Groups are kept apart in every result, so that rings can be switched, strobed and
// re-weighted after rendering.
#pragma once

#include <optional>

#include "materials/spectrum.h"
#include "renderer/ray_scene.h"

namespace retrolux {

inline constexpr int kMaxLightGroups = 16;
using GroupValues = Eigen::Array<float, kMaxLightGroups, 1>;

enum class RingChoice { kAll, kOwn };

// A direction towards a light, with what comes from there if nothing is in between.
struct LightSample {
  Vec3f position;         // on the emitter
  Vec3f direction;        // unit, from the shaded point
  float radiance = 0.0f;  // W/(m2 sr), over the light's whole spectrum
  float pdf = 0.0f;       // 1/sr, of the direction within its group
};

class Lights {
 public:
  // `own_camera`: with RingChoice::kOwn only this camera's ring is on. InputError for too many
  // groups.
  Lights(const Scene& scene, const RayScene& rays, RingChoice rings, const std::string& own_camera);

  int GroupCount() const { return static_cast<int>(groups_.size()); }
  std::vector<std::string> GroupNames() const;
  // Which of the scene's spectra the group emits.
  int SpectrumOf(int group) const { return groups_[static_cast<size_t>(group)].spectrum; }
  const std::vector<Spectrum>& Spectra() const { return spectra_; }

  // A point on the group's emitters as seen from x; nothing for the environment, which is found by
  // scattering only, and for points that none of the group's light can reach. `pick` and `u` are
  // uniform on [0, 1).
  std::optional<LightSample> Sample(int group, const Vec3f& x, float pick, const Vec2f& u) const;

  // What a ray along `direction` that meets an emitter there receives.
  struct Emission {
    int group = 0;
    float radiance = 0.0f;
    float pdf =
        0.0f;  // 1/sr, of Sample to choose that direction within the group; 0 if it never does
  };
  std::optional<Emission> Emitted(const Vec3f& origin, const Vec3f& direction,
                                  const SurfaceHit& hit) const;
  // What a ray receives that meets nothing.
  std::optional<Emission> Environment() const;

 private:
  enum class Kind { kRing, kPanels, kEnvironment };
  struct Group {
    std::string name;
    Kind kind;
    int spectrum;
    uint32_t body;  // in the RayScene
  };
  struct Ring {
    std::vector<Vec3f> centres;
    std::vector<std::array<Vec3f, kLedCorners>> outlines;
    Vec3f axis;
    float led_area_mm2, intensity, exponent;
    float RadianceAt(float cos_theta) const;
  };
  int SpectrumIndex(const LedType& type);
  std::optional<LightSample> SampleRing(const Ring& ring, const Vec3f& x, float pick,
                                        const Vec2f& u) const;
  std::optional<LightSample> SamplePanels(const Vec3f& x, float pick, const Vec2f& u) const;
  static float RingPdf(const Ring& ring, float distance2, float cos_led);
  float PanelPdf(const Vec3f& x, const Vec3f& position, float cos_panel) const;

  std::vector<Group> groups_;
  std::vector<Ring> rings_;        // one for each ring group, in order
  std::vector<Spectrum> spectra_;  // each with integral 1
  std::vector<LedType> led_types_;
  std::vector<LightPanel> panels_;
  std::vector<double> panel_areas_cumulative_;
  float panel_radiance_ = 0.0f;
  float environment_radiance_ = 0.0f;
  std::vector<int> group_of_body_;  // -1: no emitter that is on
};

}  // namespace retrolux
