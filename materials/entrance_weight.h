// How retro-reflection falls off with the entrance angle, beyond what the microfacet model gives.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

namespace retrolux {

// w(beta), 1 at normal incidence. A table over the angle, interpolated with ln w linear in beta^2
// (a Gaussian between points) and continued so beyond its last point. Tabulated over the cosine, in
// which beta^2 is nearly linear.
class EntranceWeight {
 public:
  EntranceWeight();  // 1 at every angle
  // Columns entrance_deg, weight; angles ascending, weights positive and not rising.
  static EntranceWeight FromTable(const std::filesystem::path& file);

  float At(float cos_beta) const {
    const float x = std::clamp(cos_beta, 0.0f, 1.0f) * static_cast<float>(table_.size() - 1);
    const size_t i = std::min(static_cast<size_t>(x), table_.size() - 2);
    const float t = x - static_cast<float>(i);
    return table_[i] + t * (table_[i + 1] - table_[i]);
  }

 private:
  std::vector<float> table_;
};

}  // namespace retrolux
