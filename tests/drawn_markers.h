// Pictures of markers that tests make themselves, so that neither renderer nor scene can share
// their mistakes with the identification methods: layers drawn over one another, each a light over
// the picture plane that is sampled 16 x 16 times in a pixel where it ends, blurred, and laid over
// what is there; then noise and rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "classifier/contour.h"
#include "core/marker_set.h"
#include "core/plane.h"
#include "core/rng.h"

namespace retrolux {

// The light of a layer at a place in the picture, DN; nothing where one sees through.
using LayerLight = std::function<std::optional<double>(const Vec2d&)>;

// Sum and first moment of the light that a layer sends.
struct LightMoment {
  double sum = 0.0;
  Vec2d first = Vec2d::Zero();
  double covered_px2 = 0.0;
  Vec2d Centroid() const { return first / sum; }
};

class DrawnPicture {
 public:
  DrawnPicture(int width, int height, double background) : mean_(width, height, background) {}

  Plane<double>& mean() { return mean_; }

  // Lays the light over the pixels of `box`, after a Gaussian blur of standard deviation `blur_px`.
  // The moment is that of the light before the blur, which keeps both.
  LightMoment Lay(const PixelBox& box, double blur_px, const LayerLight& light) {
    const int margin = static_cast<int>(std::ceil(3.5 * blur_px)) + 1;
    const int x0 = box.x0 - margin, y0 = box.y0 - margin;
    const int columns = kCells * (box.x1 + margin - x0), rows = kCells * (box.y1 + margin - y0);
    Plane<double> cover(columns, rows), sent(columns, rows);
    const auto centre = [&](int i, int j) {
      return Vec2d(x0 - 0.5 + (i + 0.5) / kCells, y0 - 0.5 + (j + 0.5) / kCells);
    };
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const auto here = light(centre(i, j));
        cover(i, j) = here ? 1.0 : 0.0;
        sent(i, j) = here.value_or(0.0);
      }
    }
    const Plane<double> first = cover;
    LightMoment moment;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        Vec2d place = centre(i, j) * sent(i, j);
        if (AtEdge(first, i, j)) {
          cover(i, j) = sent(i, j) = 0.0;
          place = Vec2d::Zero();
          for (int k = 0; k < kParts * kParts; ++k) {
            const Vec2d p = centre(i, j) + Vec2d((k % kParts + 0.5) / kParts - 0.5,
                                                 (k / kParts + 0.5) / kParts - 0.5) /
                                               kCells;
            const auto part = light(p);
            if (!part) continue;
            cover(i, j) += 1.0 / (kParts * kParts);
            sent(i, j) += *part / (kParts * kParts);
            place += p * *part / (kParts * kParts);
          }
        }
        moment.sum += sent(i, j);
        moment.first += place;
        moment.covered_px2 += cover(i, j) / (kCells * kCells);
      }
    }
    if (blur_px > 0.0) {
      Blur(cover, blur_px * kCells);
      Blur(sent, blur_px * kCells);
    }
    for (int j = 0; j < rows; j += kCells) {
      for (int i = 0; i < columns; i += kCells) {
        const int x = x0 + i / kCells, y = y0 + j / kCells;
        if (!mean_.Contains(x, y)) continue;
        const double share = BoxMean(cover, i, j);
        mean_(x, y) = mean_(x, y) * (1.0 - share) + BoxMean(sent, i, j);
      }
    }
    return moment;
  }

  // Noise of variance read^2 + gain * light + (pattern * light)^2 DN^2, rounded to `bits`.
  DigitalImage Digitise(double read, double gain, double pattern, uint64_t seed,
                        int bits = 8) const {
    DigitalImage image{Plane<uint16_t>(mean_.width, mean_.height), bits};
    KeyedRng rng(seed);
    const double top = std::pow(2.0, bits) - 1.0;
    for (size_t i = 0; i < mean_.data.size(); i += 2) {
      const double radius = std::sqrt(-2.0 * std::log(1.0 - rng.NextDouble()));
      const double angle = 2.0 * kPi * rng.NextDouble();
      for (size_t k = i; k < std::min(i + 2, mean_.data.size()); ++k) {
        const double normal = radius * (k == i ? std::cos(angle) : std::sin(angle));
        const double light = std::max(mean_.data[k], 0.0);
        const double sigma =
            std::sqrt(read * read + gain * light + pattern * light * pattern * light);
        const double dn = std::round(mean_.data[k] + sigma * normal);
        image.dn.data[k] = static_cast<uint16_t>(std::clamp(dn, 0.0, top));
      }
    }
    return image;
  }

 private:
  static constexpr int kCells = 4;  // along a pixel
  static constexpr int kParts = 4;  // along a cell, where a layer ends

  static bool AtEdge(const Plane<double>& cover, int i, int j) {
    for (int y = std::max(j - 1, 0); y <= std::min(j + 1, cover.height - 1); ++y) {
      for (int x = std::max(i - 1, 0); x <= std::min(i + 1, cover.width - 1); ++x) {
        if (cover(x, y) != cover(i, j)) return true;
      }
    }
    return false;
  }

  static double BoxMean(const Plane<double>& cells, int i, int j) {
    double sum = 0.0;
    for (int y = j; y < j + kCells; ++y) {
      for (int x = i; x < i + kCells; ++x) sum += cells(x, y);
    }
    return sum / (kCells * kCells);
  }

  static void Blur(Plane<double>& cells, double sigma) {
    const int reach = static_cast<int>(std::ceil(3.5 * sigma));
    std::vector<double> weights;
    double sum = 0.0;
    for (int n = -reach; n <= reach; ++n) {
      weights.push_back(std::exp(-0.5 * n * n / (sigma * sigma)));
      sum += weights.back();
    }
    for (const bool along_rows : {true, false}) {
      const Plane<double> from = cells;
      for (int y = 0; y < cells.height; ++y) {
        for (int x = 0; x < cells.width; ++x) {
          double value = 0.0;
          for (int n = -reach; n <= reach; ++n) {
            const int u = along_rows ? std::clamp(x + n, 0, cells.width - 1) : x;
            const int v = along_rows ? y : std::clamp(y + n, 0, cells.height - 1);
            value += weights[static_cast<size_t>(n + reach)] * from(u, v);
          }
          cells(x, y) = value / sum;
        }
      }
    }
  }

  Plane<double> mean_;
};

// A marker on a curved surface before a pinhole camera, whose axis passes the picture's middle.
struct MarkerPose {
  double focal_px = 3000.0;
  double tilt_deg = 0.0;     // between the normal and the line of sight
  double azimuth_deg = 0.0;  // the way the normal leans, counter-clockwise from picture right
  double roll_deg = 0.0;     // of the marker about its normal
  double distance_mm = 1600.0;
  Vec2d at_px{60.0, 60.0};  // where the marker's origin is seen
  // Of the surface z = -(x^2 / (2 radius_x) + y^2 / (2 radius_y)), turned by curve_deg about the
  // normal; 0: flat.
  double radius_x_mm = 0.0, radius_y_mm = 0.0, curve_deg = 0.0;
};

class PosedMarker {
 public:
  PosedMarker(const MarkerPose& pose, int width, int height)
      : pose_(pose), principal_(0.5 * (width - 1), 0.5 * (height - 1)) {
    const Vec3d sight = Direction(pose.at_px).normalized();
    centre_ = pose.distance_mm * sight;
    const Vec3d right = Vec3d(0.0, 1.0, 0.0).cross(sight).normalized();
    const Vec3d up = right.cross(sight);
    const double azimuth = RadFromDeg(pose.azimuth_deg);
    const Vec3d lean = std::cos(azimuth) * right + std::sin(azimuth) * up;
    const Vec3d side = -std::sin(azimuth) * right + std::cos(azimuth) * up;
    const double tilt = RadFromDeg(pose.tilt_deg);
    normal_ = -std::cos(tilt) * sight + std::sin(tilt) * lean;
    const Vec3d along = std::cos(tilt) * lean + std::sin(tilt) * sight;
    const double roll = RadFromDeg(pose.roll_deg);
    x_ = std::cos(roll) * along + std::sin(roll) * side;
    y_ = normal_.cross(x_);
    const double kx = pose.radius_x_mm > 0.0 ? 1.0 / pose.radius_x_mm : 0.0;
    const double ky = pose.radius_y_mm > 0.0 ? 1.0 / pose.radius_y_mm : 0.0;
    const double curve = RadFromDeg(pose.curve_deg);
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(curve).toRotationMatrix();
    bend_ = turn * Vec2d(kx, ky).asDiagonal() * turn.transpose();
  }

  Vec2d Project(const Vec2d& in_marker) const {
    const double height = -0.5 * in_marker.dot(bend_ * in_marker);
    const Vec3d p = centre_ + in_marker.x() * x_ + in_marker.y() * y_ + height * normal_;
    return principal_ + pose_.focal_px * p.head<2>() / p.z();
  }

  // Where the ray of a pixel first meets the surface, and the angle between ray and normal there.
  struct Meeting {
    Vec2d in_marker;
    double incidence_deg;
  };
  std::optional<Meeting> Meet(const Vec2d& px) const {
    const Vec3d ray = Direction(px).normalized();
    const Vec2d u(x_.dot(ray), y_.dot(ray));
    const Vec2d o(-x_.dot(centre_), -y_.dot(centre_));
    // Height above the surface: a t^2 + 2 b t + c = 0.
    const double a = 0.5 * u.dot(bend_ * u);
    const double b = 0.5 * (u.dot(bend_ * o) + normal_.dot(ray));
    const double c = 0.5 * o.dot(bend_ * o) - normal_.dot(centre_);
    double t = 0.0;
    if (std::abs(a) < 1e-15) {
      t = -0.5 * c / b;
    } else {
      const double root = b * b - a * c;
      if (root < 0.0) return std::nullopt;
      t = c / (-b + std::sqrt(root));
    }
    const Vec2d in_marker = o + t * u;
    const Vec2d slope = bend_ * in_marker;
    const Vec3d normal = (normal_ + slope.x() * x_ + slope.y() * y_).normalized();
    const double cosine = -normal.dot(ray);
    if (cosine <= 0.0) return std::nullopt;
    return Meeting{in_marker, DegFromRad(std::acos(std::min(cosine, 1.0)))};
  }

  // Pixels that may show the inside of a circle of that radius in the marker's plane.
  PixelBox Box(double radius_mm) const {
    const double reach = pose_.focal_px * radius_mm / (pose_.distance_mm - radius_mm) + 1.0;
    const Vec2d c = Project({0.0, 0.0});
    return {static_cast<int>(std::floor(c.x() - reach)),
            static_cast<int>(std::floor(c.y() - reach)), static_cast<int>(std::ceil(c.x() + reach)),
            static_cast<int>(std::ceil(c.y() + reach))};
  }

  Polygon Corners(const MarkerShape& shape) const {
    Polygon corners;
    for (const Vec2d& corner : shape.outline_mm) corners.push_back(Project(corner));
    return corners;
  }

 private:
  Vec3d Direction(const Vec2d& px) const {
    const Vec2d xy = (px - principal_) / pose_.focal_px;
    return {xy.x(), xy.y(), 1.0};
  }

  MarkerPose pose_;
  Vec2d principal_;
  Vec3d centre_, normal_, x_, y_;
  Eigen::Matrix2d bend_;
};

}  // namespace retrolux
