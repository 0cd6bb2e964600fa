#include "classifier/polygon_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace retrolux {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Blur rounds the outline for about this far from a corner: those points tell nothing about the
// edges.
constexpr double kRounded_px = 1.25;
// Half the width of a blurred edge.
constexpr double kBlur_px = 2.0;

struct Line {
  Vec2d point, direction;
  double squares = 0.0;  // sum of squared distances of the points, px2
  int count = 0;
};

// Lines of least squared distance through any run of points of a closed outline, in constant time.
class RunningLines {
 public:
  explicit RunningLines(const Polygon& points) : centre_(points.front()), sums_(points.size() + 2) {
    for (size_t i = 0; i <= points.size(); ++i) {
      const Vec2d p = points[i % points.size()] - centre_;
      sums_[i + 1] = sums_[i];
      sums_[i + 1].x += p.x();
      sums_[i + 1].y += p.y();
      sums_[i + 1].xx += p.x() * p.x();
      sums_[i + 1].xy += p.x() * p.y();
      sums_[i + 1].yy += p.y() * p.y();
    }
  }

  // Through the points first .. last (last <= size: the first point again).
  Line Fit(int first, int last) const {
    const Sums& a = sums_[static_cast<size_t>(first)];
    const Sums& b = sums_[static_cast<size_t>(last) + 1];
    const int count = last - first + 1;
    const double n = count;
    const Vec2d mean((b.x - a.x) / n, (b.y - a.y) / n);
    const double xx = (b.xx - a.xx) / n - mean.x() * mean.x();
    const double xy = (b.xy - a.xy) / n - mean.x() * mean.y();
    const double yy = (b.yy - a.yy) / n - mean.y() * mean.y();
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    return {centre_ + mean, Vec2d(std::cos(angle), std::sin(angle)), n * Least(xx, xy, yy), count};
  }

  // Only the squares of Fit.
  double Squares(int first, int last) const {
    const Sums& a = sums_[static_cast<size_t>(first)];
    const Sums& b = sums_[static_cast<size_t>(last) + 1];
    const double n = last - first + 1;
    const double x = (b.x - a.x) / n;
    const double y = (b.y - a.y) / n;
    return n *
           Least((b.xx - a.xx) / n - x * x, (b.xy - a.xy) / n - x * y, (b.yy - a.yy) / n - y * y);
  }

 private:
  struct Sums {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  };

  // Smaller eigenvalue of the covariance.
  static double Least(double xx, double xy, double yy) {
    const double half = 0.5 * (xx - yy);
    return std::max(0.5 * (xx + yy) - std::sqrt(half * half + xy * xy), 0.0);
  }

  Vec2d centre_;
  std::vector<Sums> sums_;
};

// The best way to cut an outline into k edges, for every k up to a maximum, by dynamic programming:
// over the sum of squared distances of the points from the lines of their edges. The first cut is
// fixed.
class Partition {
 public:
  Partition(const Polygon& outline, double step_px, const PolygonFitLimits& limits)
      : lines_(outline),
        size_(static_cast<int>(outline.size())),
        step_px_(step_px),
        min_length_(std::max(static_cast<int>(std::ceil(limits.min_edge_px / step_px)), 2)),
        limits_(limits) {
    Search();
  }

  // The cuts 0 = c0 < c1 < ... < ck = size of k edges; empty if k edges do not fit.
  std::vector<int> Cuts(int k) const {
    if (Cost(k, size_) == kInfinity) return {};
    std::vector<int> cuts{size_};
    for (int edges = k; edges > 0; --edges) {
      cuts.push_back(from_[Index(edges, cuts.back())]);
    }
    std::reverse(cuts.begin(), cuts.end());
    return cuts;
  }

  // The line of an edge without its rounded ends, of which at most a third each is left out.
  Line EdgeLine(int first, int last, double first_rounded_px, double last_rounded_px) const {
    const int most = (last - first) / 3;
    return lines_.Fit(first + std::min(Steps(first_rounded_px), most),
                      last - std::min(Steps(last_rounded_px), most));
  }

  // rms distance over its limit, of the worst edge.
  double Misfit(const std::vector<int>& cuts) const {
    if (cuts.empty()) return kInfinity;
    double worst = 0.0;
    for (size_t e = 0; e + 1 < cuts.size(); ++e) {
      const Line line = EdgeLine(cuts[e], cuts[e + 1], kRounded_px, kRounded_px);
      const double limit = limits_.straight_px + limits_.bend * step_px_ * (cuts[e + 1] - cuts[e]);
      worst = std::max(worst, std::sqrt(line.squares / line.count) / limit);
    }
    return worst;
  }

 private:
  size_t Index(int k, int end) const {
    return static_cast<size_t>(k) * static_cast<size_t>(size_ + 1) + static_cast<size_t>(end);
  }
  double Cost(int k, int end) const { return cost_[Index(k, end)]; }
  int Steps(double px) const { return std::max(1, static_cast<int>(std::lround(px / step_px_))); }

  void Search() {
    const auto cells = static_cast<size_t>(limits_.max_edges + 1) * static_cast<size_t>(size_ + 1);
    cost_.assign(cells, kInfinity);
    from_.assign(cells, 0);
    cost_[Index(0, 0)] = 0.0;
    const int rounded = Steps(kRounded_px);
    for (int end = min_length_; end <= size_; ++end) {
      for (int begin = 0; begin + min_length_ <= end; ++begin) {
        const int trim = std::min(rounded, (end - begin) / 3);
        const double squares = lines_.Squares(begin + trim, end - trim);
        for (int k = 1; k <= limits_.max_edges; ++k) {
          const double cost = Cost(k - 1, begin) + squares;
          if (cost < Cost(k, end)) {
            cost_[Index(k, end)] = cost;
            from_[Index(k, end)] = begin;
          }
        }
      }
    }
  }

  RunningLines lines_;
  int size_;
  double step_px_;
  int min_length_;  // in steps
  PolygonFitLimits limits_;
  std::vector<double> cost_;
  std::vector<int> from_;
};

double Cross(const Vec2d& a, const Vec2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The outline from its point farthest from the centre on, which is a corner of any polygon.
Polygon FromACorner(const Polygon& outline) {
  const Vec2d centre = Centroid(outline);
  const auto farthest =
      std::max_element(outline.begin(), outline.end(), [&](const Vec2d& a, const Vec2d& b) {
        return (a - centre).squaredNorm() < (b - centre).squaredNorm();
      });
  Polygon rotated(outline);
  std::rotate(rotated.begin(), rotated.begin() + (farthest - outline.begin()), rotated.end());
  return rotated;
}

std::vector<Line> EdgeLines(const Polygon& outline, const Partition& partition,
                            const std::vector<int>& cuts, const std::vector<double>& rounded_px) {
  const size_t k = cuts.size() - 1;
  std::vector<Line> lines;
  for (size_t e = 0; e < k; ++e) {
    Line line = partition.EdgeLine(cuts[e], cuts[e + 1], rounded_px[e], rounded_px[(e + 1) % k]);
    const Vec2d& first = outline[static_cast<size_t>(cuts[e])];
    const Vec2d& last = outline[static_cast<size_t>(cuts[e + 1]) % outline.size()];
    if (line.direction.dot(last - first) < 0.0) line.direction *= -1.0;
    lines.push_back(line);
  }
  return lines;
}

// Where the lines of neighbouring edges meet. Nothing if two go on in nearly the same direction, or
// meet far from the outline: blur takes about 1.5 px / sin(half the angle) off the tip of a corner.
std::optional<Polygon> Corners(const Polygon& outline, const Partition& partition,
                               const std::vector<int>& cuts, double min_turn_rad) {
  const size_t k = cuts.size() - 1;
  std::vector<double> rounded_px(k, kRounded_px);
  Polygon corners;
  // The first round finds the angles, which say how far from the corners the lines can be trusted.
  for (int round = 0; round < 2; ++round) {
    const std::vector<Line> lines = EdgeLines(outline, partition, cuts, rounded_px);
    corners.clear();
    for (size_t e = 0; e < k; ++e) {
      const Line& before = lines[(e + k - 1) % k];
      const Line& after = lines[e];
      const double sine = Cross(before.direction, after.direction);
      const double turn = std::abs(std::atan2(sine, before.direction.dot(after.direction)));
      if (turn < min_turn_rad || std::abs(sine) < 1e-3) return std::nullopt;
      const double along = Cross(after.point - before.point, after.direction) / sine;
      corners.push_back(before.point + along * before.direction);
      const double gap = (corners.back() - outline[static_cast<size_t>(cuts[e])]).norm();
      if (gap > 1.0 + 1.5 / std::cos(0.5 * turn)) return std::nullopt;
      // Closer than kBlur_px to the other edge the two blur into each other.
      const double blurred = kBlur_px / std::sin(std::max(turn, 0.5 * kPi));
      rounded_px[e] = std::max(kRounded_px, blurred - gap);
    }
  }
  return corners;
}

}  // namespace

std::optional<PolygonFit> FitPolygon(const Polygon& outline, double step_px,
                                     const PolygonFitLimits& limits) {
  const Polygon points = FromACorner(outline);
  const Partition partition(points, step_px, limits);
  std::optional<PolygonFit> best;
  double misfit_fewer = partition.Misfit(partition.Cuts(2));
  for (int k = 3; k <= limits.max_edges; ++k) {
    const std::vector<int> cuts = partition.Cuts(k);
    const double misfit = partition.Misfit(cuts);
    const double gain = misfit_fewer / misfit;
    misfit_fewer = misfit;
    if (misfit > 1.0 || (best && gain <= best->gain)) continue;
    auto corners = Corners(points, partition, cuts, limits.min_turn_rad);
    if (corners) best = PolygonFit{std::move(*corners), misfit, gain};
  }
  return best;
}

}  // namespace retrolux
