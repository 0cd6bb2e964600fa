// Share of the light that a rough surface reflects by single scattering, over the angle.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace retrolux {

class DirectionalAlbedo {
 public:
  // Tabulated by quadrature for GGX of width `alpha` and a dielectric of index `ior`.
  DirectionalAlbedo(float ior, float alpha);
  // Of facets that reflect all light.
  static DirectionalAlbedo OfMirrors(float alpha);

  float At(float cos_theta) const {
    const float x = std::clamp(cos_theta, 0.0f, 1.0f) * static_cast<float>(table_.size() - 1);
    const size_t i = std::min(static_cast<size_t>(x), table_.size() - 2);
    const float t = x - static_cast<float>(i);
    return table_[i] + t * (table_[i + 1] - table_[i]);
  }
  // 2 * integral of At(c) c dc: the share reflected under diffuse light.
  float Mean() const { return mean_; }

 private:
  // Share that a facet reflects, over the cosine of its incidence.
  using Fresnel = std::function<float(float cosine)>;
  DirectionalAlbedo(const Fresnel& fresnel, float alpha);

  std::vector<float> table_;
  float mean_ = 0.0f;
};

}  // namespace retrolux
