#include "classifier/mask_pose.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace retrolux {

namespace {

using Chosen = std::vector<size_t>;

std::vector<PointPair> Those(std::span<const PointPair> pairs, const Chosen& chosen) {
  std::vector<PointPair> those;
  for (const size_t i : chosen) those.push_back(pairs[i]);
  return those;
}

double Residual_mm(const PointPair& pair, const RigidTransform& b_from_a) {
  return (b_from_a * pair.in_a - pair.in_b).norm();
}

// The chosen without the one that leaves the best fit; nothing if no three others are left.
std::optional<Chosen> WithoutWorst(std::span<const PointPair> pairs, const Chosen& chosen) {
  std::optional<Chosen> best;
  double least_mm = std::numeric_limits<double>::infinity();
  for (size_t out = 0; out < chosen.size(); ++out) {
    Chosen rest = chosen;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(out));
    const std::vector<PointPair> those = Those(pairs, rest);
    if (RegistrationFault(those)) continue;
    const double fre_mm = RegisterPoints(those).fre_mm;
    if (fre_mm >= least_mm) continue;
    least_mm = fre_mm;
    best = std::move(rest);
  }
  return best;
}

MaskPose PoseOf(std::span<const PointPair> pairs, const Chosen& chosen,
                const Registration& registration) {
  MaskPose pose;
  pose.world_from_mask = registration.b_from_a;
  pose.pairs = Those(pairs, chosen);
  pose.used.assign(pairs.size(), false);
  for (const size_t i : chosen) pose.used[i] = true;
  for (const PointPair& pair : pairs)
    pose.residuals_mm.push_back(Residual_mm(pair, registration.b_from_a));
  pose.fre_mm = registration.fre_mm;
  pose.fle_mm = FleFromFre_mm(registration.fre_mm, chosen.size());
  return pose;
}

}  // namespace

double MaskPose::Tre_mm(const Vec3d& x_in_mask) const {
  return ExpectedTre_mm(pairs, fle_mm, x_in_mask);
}

PoseEstimate EstimatePose(std::span<const PointPair> pairs, double max_residual_mm) {
  Chosen chosen(pairs.size());
  for (size_t i = 0; i < chosen.size(); ++i) chosen[i] = i;
  if (const auto fault = RegistrationFault(pairs)) return {std::nullopt, *fault};
  for (;;) {
    const Registration registration = RegisterPoints(Those(pairs, chosen));
    const bool fits = std::all_of(chosen.begin(), chosen.end(), [&](size_t i) {
      return Residual_mm(pairs[i], registration.b_from_a) <= max_residual_mm;
    });
    if (fits) return {PoseOf(pairs, chosen, registration), ""};
    std::optional<Chosen> rest = WithoutWorst(pairs, chosen);
    if (!rest) break;
    chosen = std::move(*rest);
  }
  return {std::nullopt, fmt::format("no three of {} markers are where the constellation has them, "
                                    "to within {:g} mm",
                                    pairs.size(), max_residual_mm)};
}

}  // namespace retrolux
