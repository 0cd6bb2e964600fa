#include "classifier/triangulation.h"

#include <algorithm>
#include <cmath>

#include "classifier/projection.h"
#include "core/error.h"

namespace retrolux {

namespace {

using Group = std::vector<size_t>;  // of sightings, by index

struct Fit {
  Vec3d position;
  Mat3d information;  // inverse covariance, 1/mm2
};

// The point with the least sum of squared distances from the rays.
Vec3d NearestToRays(std::span<const Ray> rays, const Group& group) {
  Mat3d matrix = Mat3d::Zero();
  Vec3d right = Vec3d::Zero();
  for (const size_t i : group) {
    const Vec3d& d = rays[i].direction;
    const Mat3d across = Mat3d::Identity() - d * d.transpose();
    matrix += across;
    right += across * rays[i].origin;
  }
  return matrix.ldlt().solve(right);
}

// Gauss-Newton from the linear start; nothing if the point leaves a camera's view on the way.
std::optional<Fit> FitPoint(std::span<const Sighting> sightings, std::span<const Ray> rays,
                            const Group& group) {
  constexpr int kSteps = 50;
  constexpr double kConverged_mm = 1e-10;
  Fit fit{NearestToRays(rays, group), Mat3d::Zero()};
  for (int step = 0; step < kSteps; ++step) {
    fit.information.setZero();
    Vec3d gradient = Vec3d::Zero();
    for (const size_t i : group) {
      const auto projected = ProjectWithSlope(*sightings[i].camera, fit.position);
      if (!projected) return std::nullopt;
      const double weight = 1.0 / (sightings[i].sigma_px * sightings[i].sigma_px);
      const Eigen::Matrix<double, 3, 2> slope = weight * projected->per_mm.transpose();
      fit.information += slope * projected->per_mm;
      gradient += slope * (sightings[i].px - projected->px);
    }
    const Vec3d change = fit.information.ldlt().solve(gradient);
    if (!change.allFinite()) return std::nullopt;
    fit.position += change;
    if (change.norm() < kConverged_mm) break;
  }
  return fit;
}

// Seen minus projected; nothing for a camera that has the point behind it.
std::optional<Vec2d> Residual(const Sighting& sighting, const Vec3d& position) {
  const auto px = sighting.camera->Project(position);
  if (!px) return std::nullopt;
  return Vec2d(sighting.px - *px);
}

bool Agree(std::span<const Sighting> sightings, const Group& group, const Vec3d& position,
           double max_residual_px) {
  return std::all_of(group.begin(), group.end(), [&](size_t i) {
    const auto residual = Residual(sightings[i], position);
    return residual && residual->norm() <= max_residual_px;
  });
}

double AngleOfGroup(std::span<const Ray> rays, const Group& group) {
  std::vector<Ray> chosen;
  for (const size_t i : group) chosen.push_back(rays[i]);
  return LargestAngle(chosen);
}

// All groups of `size` out of `count`, in the order of their indices.
std::vector<Group> GroupsOf(size_t size, size_t count) {
  std::vector<Group> groups;
  std::vector<bool> chosen(count, false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(size), true);
  do {
    Group group;
    for (size_t i = 0; i < count; ++i) {
      if (chosen[i]) group.push_back(i);
    }
    groups.push_back(std::move(group));
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return groups;
}

TriangulatedPoint Finished(std::span<const Sighting> sightings, const Group& group,
                           const Fit& fit) {
  TriangulatedPoint point;
  point.position = fit.position;
  point.covariance = fit.information.inverse();
  point.used.assign(sightings.size(), false);
  for (const size_t i : group) point.used[i] = true;
  double sum = 0.0;
  for (size_t i = 0; i < sightings.size(); ++i) {
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    const Vec2d residual = Residual(sightings[i], fit.position).value_or(Vec2d(kNowhere, kNowhere));
    point.residuals_px.push_back(residual);
    if (point.used[i]) sum += residual.squaredNorm();
  }
  point.rms_px = std::sqrt(sum / (2.0 * static_cast<double>(group.size())));
  return point;
}

}  // namespace

double LargestAngle(std::span<const Ray> rays) {
  double largest = 0.0;
  for (size_t i = 0; i < rays.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const Vec3d &a = rays[i].direction, &b = rays[j].direction;
      largest = std::max(largest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return largest;
}

Triangulation Triangulate(std::span<const Sighting> sightings,
                          const TriangulationOptions& options) {
  if (sightings.size() < 2) {
    throw InputError(fmt::format("a point seen by {} cameras; expected at least two to triangulate",
                                 sightings.size()));
  }
  std::vector<Ray> rays;
  for (const Sighting& sighting : sightings) {
    if (!sighting.camera->PlanePoint(sighting.px)) {
      throw InputError(fmt::format("{}: the distorted lens brings no light to ({:.1f}, {:.1f}) px",
                                   sighting.camera->name, sighting.px.x(), sighting.px.y()));
    }
    rays.push_back(sighting.camera->RayThrough(sighting.px));
  }
  const double min_angle = RadFromDeg(options.min_angle_deg);
  if (LargestAngle(rays) < min_angle) {
    throw InputError(fmt::format(
        "the rays of {} and the other cameras are parallel to within {:.3g} degrees; expected "
        "at least {:g}",
        sightings.front().camera->name, DegFromRad(LargestAngle(rays)), options.min_angle_deg));
  }
  for (size_t size = sightings.size(); size >= 2; --size) {
    std::vector<std::pair<Group, Fit>> agreeing;
    for (Group& group : GroupsOf(size, sightings.size())) {
      if (AngleOfGroup(rays, group) < min_angle) continue;
      const auto fit = FitPoint(sightings, rays, group);
      if (fit && Agree(sightings, group, fit->position, options.max_residual_px))
        agreeing.emplace_back(std::move(group), *fit);
    }
    if (agreeing.size() == 1) {
      const auto& [group, fit] = agreeing.front();
      return {Finished(sightings, group, fit), ""};
    }
    if (agreeing.size() > 1) {
      return {std::nullopt, fmt::format("{} groups of {} of {} views agree, each on another place",
                                        agreeing.size(), size, sightings.size())};
    }
  }
  return {std::nullopt, fmt::format("no two of {} views agree within {:g} px", sightings.size(),
                                    options.max_residual_px)};
}

}  // namespace retrolux
