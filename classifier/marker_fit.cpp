#include "classifier/marker_fit.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

constexpr int kGeometry = 2 * OutlineMap::kTerms;
constexpr int kVariance = kGeometry;  // index of the blur
constexpr int kLight = kGeometry + 1;
constexpr int kSurroundings = 3, kMarker = 6;
constexpr int kUnknowns = kLight + kSurroundings + kMarker;
constexpr int kRow = 24;  // the unknowns' derivatives, the residual, and one to fill up
constexpr int kResidual = kUnknowns;

using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
// A pixel a row. Single precision: sums of 2000 products with errors of 1e-7 are ample for a step.
using Rows = Eigen::Matrix<float, Eigen::Dynamic, kRow, Eigen::RowMajor>;

// Of the logarithm of the marker's light before the pixels are seen, standard deviations: its slope
// and its bend over half the patch. The default sheeting loses 7 times over 15 mm at worst.
constexpr double kLightSlope = 1.5, kLightBend = 0.5;
// No more is added to that logarithm in one step.
constexpr double kLightStep = 0.7;
// The blur of a picture, before it is seen: mean and standard deviation of its variance, px^2.
constexpr double kUsualBlur_px2 = 0.15, kBlurSpread_px2 = 0.7;
// No corner moves further in one step, px: the derivatives see about as far.
constexpr double kLongestStep_px = 1.0;
// Holds what nothing says, as the turn of a disc; of the mean diagonal of the geometry.
constexpr double kHold = 1e-4;
// Coverage nearer to 0 or 1 than this is neither edge.
constexpr float kPure = 1e-3f;

struct Equations {
  Normal normal = Normal::Zero();
  Unknowns right = Unknowns::Zero();
  double squares = 0.0;
  double bend = 0.0;  // chi-square of the bend
};

// MarkerLightAt of the pixels of one row, from left to right: the logarithm is of second degree, so
// that each pixel's light is the last one's times a factor that changes by a factor of its own.
class LightAlongRow {
 public:
  LightAlongRow(const Light& light, const Patch& patch, int y) {
    const Vec2d first = PlaceInPatch(patch, Vec2d(0, y));
    const double step = PlaceInPatch(patch, Vec2d(1, y)).x() - first.x();
    const auto l = light.tail<kMarker>();
    value_ = MarkerLightAt(light, first);
    factor_ = std::exp(step * (l(1) + l(3) * (2.0 * first.x() + step) + l(4) * first.y()));
    change_ = std::exp(2.0 * l(3) * step * step);
  }
  double Value() const { return value_; }
  void Next() {
    value_ *= factor_;
    factor_ *= change_;
  }

 private:
  double value_, factor_, change_;
};

// Sums over the pixels of one row that lie wholly in the marker or wholly outside, which know of
// nothing but the light. y is the same for all, so that powers of x are summed.
class RowSums {
 public:
  void AddOutside(double x, double residual) {
    outside_ += Vec3d(1.0, x, x * x);
    outside_right_ += residual * Vec2d(1.0, x);
  }
  void AddInside(double x, double marker_light, double residual) {
    double power = marker_light * marker_light;
    for (double& sum : inside_) {
      sum += power;
      power *= x;
    }
    inside_right_ += residual * marker_light * Vec3d(1.0, x, x * x);
  }
  void AddTo(double y, Equations& sums) const {
    auto surroundings = sums.normal.block<kSurroundings, kSurroundings>(kLight, kLight);
    auto marker =
        sums.normal.block<kMarker, kMarker>(kLight + kSurroundings, kLight + kSurroundings);
    AddTerms<kSurroundings>(outside_.data(), outside_right_.data(), y, surroundings,
                            sums.right.segment<kSurroundings>(kLight));
    AddTerms<kMarker>(inside_.data(), inside_right_.data(), y, marker,
                      sums.right.segment<kMarker>(kLight + kSurroundings));
  }

 private:
  // Terms x^px y^py, in the order of OutlineMap::TermsAt; `moments[k]` goes with x^k.
  template <int Terms, typename Matrix, typename Vector>
  static void AddTerms(const double* moments, const double* right, double y, Matrix&& normal,
                       Vector&& rights) {
    constexpr int kPowerOfX[] = {0, 1, 0, 2, 1, 0}, kPowerOfY[] = {0, 0, 1, 0, 1, 2};
    const double powers[] = {1.0, y, y * y, y * y * y, y * y * y * y};
    for (int i = 0; i < Terms; ++i) {
      rights(i) += powers[kPowerOfY[i]] * right[kPowerOfX[i]];
      for (int j = 0; j < Terms; ++j) {
        normal(i, j) += powers[kPowerOfY[i] + kPowerOfY[j]] * moments[kPowerOfX[i] + kPowerOfX[j]];
      }
    }
  }

  Vec3d outside_ = Vec3d::Zero();
  Vec2d outside_right_ = Vec2d::Zero();
  std::array<double, 5> inside_{};
  Vec3d inside_right_ = Vec3d::Zero();
};

// What an edge pixel says of all unknowns, and its residual.
void FillRow(const Coverage& coverage, int x, int y, const Vec2d& p, double m, double b,
             double residual, float* row) {
  const float* c = coverage.At(x, y);
  const auto contrast = static_cast<float>(m - b);
  const Vec2d seen = coverage.PlaceAt(x, y);
  const auto u = static_cast<float>(seen.x());
  const auto v = static_cast<float>(seen.y());
  const float terms[] = {1.0f, u, v, u * u, u * v, v * v};
  for (int k = 0; k < OutlineMap::kTerms; ++k) {
    row[k] = contrast * c[1] * terms[k];
    row[OutlineMap::kTerms + k] = contrast * c[2] * terms[k];
  }
  row[kVariance] = contrast * coverage.ByVariance(x, y);
  const auto px = static_cast<float>(p.x());
  const auto py = static_cast<float>(p.y());
  const float free = 1.0f - c[0];
  const auto lit = static_cast<float>(static_cast<double>(c[0]) * m);
  const float light[] = {free,     free * px,     free * py,     lit,          lit * px,
                         lit * py, lit * px * px, lit * px * py, lit * py * py};
  std::copy(std::begin(light), std::end(light), row + kLight);
  row[kResidual] = static_cast<float>(residual);
  row[kResidual + 1] = 0.0f;
}

// Edge pixels know everything, others only the light: their sums are made apart.
Equations Assemble(const Patch& patch, const MarkerFit& fit, const Coverage& coverage) {
  thread_local Rows rows;
  rows.resize(patch.count, kRow);
  Eigen::Index edges = 0;
  Equations sums;
  for (int y = 0; y < patch.dn.height; ++y) {
    LightAlongRow marker_light(fit.light, patch, y);
    RowSums row;
    for (int x = 0; x < patch.dn.width; ++x, marker_light.Next()) {
      if (patch.used(x, y) == 0) continue;
      const float covered = coverage.At(x, y)[0];
      const Vec2d p = PlaceInPatch(patch, Vec2d(x, y));
      const double b = SurroundingsAt(fit.light, p);
      const bool outside = covered < kPure;
      const double m = outside ? b : marker_light.Value();
      const double residual =
          static_cast<double>(patch.dn(x, y)) - b - static_cast<double>(covered) * (m - b);
      if (residual < 0.0 && patch.dn(x, y) >= patch.white_dn) continue;  // as bright as can be
      sums.squares += residual * residual;
      if (outside) {
        row.AddOutside(p.x(), residual);
      } else if (covered > 1.0f - kPure) {
        row.AddInside(p.x(), m, residual);
      } else {
        FillRow(coverage, x, y, p, m, b, residual, rows.row(edges++).data());
      }
    }
    row.AddTo(PlaceInPatch(patch, Vec2d(0, y)).y(), sums);
  }
  Eigen::Matrix<float, kRow, kRow> products = Eigen::Matrix<float, kRow, kRow>::Zero();
  products.selfadjointView<Eigen::Lower>().rankUpdate(rows.topRows(edges).transpose());
  products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  sums.normal += products.topLeftCorner<kUnknowns, kUnknowns>().cast<double>();
  sums.right += products.block<kUnknowns, 1>(0, kResidual).cast<double>();
  return sums;
}

void AddPrior(Equations& sums, int index, double off, double deviation, double variance) {
  const double weight = variance / (deviation * deviation);
  sums.normal(index, index) += weight;
  sums.right(index) -= weight * off;
}

// `variance`: of a pixel, DN^2.
void AddPriors(const MarkerFit& fit, const FitOptions& options, double variance, Equations& sums) {
  constexpr double kFloor_px = 0.01;
  const ViewOfPlane view = ViewOf(fit.map.Linear());
  const double sine = std::sqrt(std::max(0.0, 1.0 - view.foreshortening * view.foreshortening));
  // A curved surface bends the outline along the way of the tilt, perspective along both.
  const double reach = view.half_size_px * sine;
  const double pull = reach * view.half_size_px / (options.focal_px);
  const double along = std::hypot(options.curvature * reach, pull, kFloor_px);
  const double across = std::hypot(pull, kFloor_px);
  const Eigen::Matrix2d way = view.shortened * view.shortened.transpose();
  const Eigen::Matrix2d weight =
      variance * (way / (along * along) + (Eigen::Matrix2d::Identity() - way) / (across * across));
  for (int term = 3; term < OutlineMap::kTerms; ++term) {
    const int x = term;
    const int y = OutlineMap::kTerms + term;
    sums.normal(x, x) += weight(0, 0);
    sums.normal(x, y) += weight(0, 1);
    sums.normal(y, x) += weight(1, 0);
    sums.normal(y, y) += weight(1, 1);
    const Vec2d bend = fit.map.coefficients.col(term);
    const Vec2d back = weight * bend;
    sums.bend += bend.dot(back) / variance;
    sums.right(x) -= back.x();
    sums.right(y) -= back.y();
  }
  AddPrior(sums, kVariance, fit.blur_variance - kUsualBlur_px2, kBlurSpread_px2, variance);
  for (int k = 1; k < kMarker; ++k) {
    const int index = kLight + kSurroundings + k;
    AddPrior(sums, index, fit.light(kSurroundings + k), k < 3 ? kLightSlope : kLightBend, variance);
  }
  const double hold = kHold * sums.normal.diagonal().head<kGeometry>().mean();
  sums.normal.diagonal().head<kGeometry>().array() += hold;
  sums.normal.diagonal().array() += 1e-9;
}

// The bend along the way of the tilt is the surface's second form; its eigenvalues have one sign
// unless the surface is a saddle.
double Saddle(const OutlineMap& map) {
  constexpr double kFrontal = 0.35;  // sine of the tilt below which bends say nothing
  const ViewOfPlane view = ViewOf(map.Linear());
  const double sine = std::sqrt(std::max(0.0, 1.0 - view.foreshortening * view.foreshortening));
  const Eigen::RowVector3d form = view.shortened.transpose() * map.coefficients.rightCols<3>();
  const double mean = 0.5 * (form(0) + form(2));
  const double half = std::hypot(0.5 * (form(0) - form(2)), 0.5 * form(1));
  return std::max(0.0, half - std::abs(mean)) / (view.half_size_px * std::max(sine, kFrontal));
}

// Returns how far the farthest corner moved, px.
double Move(const Unknowns& change, const ShapeModel& model, double most_variance, MarkerFit& fit) {
  OutlineMap step;
  step.coefficients.row(0) = change.head<OutlineMap::kTerms>().transpose();
  step.coefficients.row(1) = change.segment<OutlineMap::kTerms>(OutlineMap::kTerms).transpose();
  double moved = 0.0;
  for (const Vec2d& p : model.outline) moved = std::max(moved, step.At(p).norm());
  const double shorter = std::min(1.0, kLongestStep_px / std::max(moved, 1e-12));
  fit.map.coefficients += shorter * step.coefficients;
  const double blur = std::clamp(change(kVariance), -0.4, 0.4);
  fit.blur_variance = std::clamp(fit.blur_variance + blur, 0.0, most_variance);
  const auto light = change.tail<kSurroundings + kMarker>();
  fit.light.head<kSurroundings>() += light.head<kSurroundings>();
  fit.light.tail<kMarker>() += light.tail<kMarker>().cwiseMax(-kLightStep).cwiseMin(kLightStep);
  return moved;
}

}  // namespace

double SurroundingsAt(const Light& light, const Vec2d& place) {
  return light(0) + light(1) * place.x() + light(2) * place.y();
}

double MarkerLightAt(const Light& light, const Vec2d& place) {
  return std::exp(light.tail<kMarker>().dot(OutlineMap::TermsAt(place)));
}

Vec2d PlaceInPatch(const Patch& patch, const Vec2d& px) {
  const Vec2d middle(0.5 * (patch.dn.width - 1), 0.5 * (patch.dn.height - 1));
  return (px - middle) / (0.5 * patch.dn.width);
}

std::optional<MarkerFit> FitMarker(const Patch& patch, const ShapeModel& model, MarkerFit guess,
                                   double noise, const FitOptions& options, Coverage& coverage) {
  MarkerFit fit = std::move(guess);
  const double most_variance =
      std::min(options.max_blur_px * options.max_blur_px, Coverage::kMaxVariance_px2);
  for (int step = 0;; ++step) {
    if (!coverage.Render(model.outline, fit.map, patch.dn.width, patch.dn.height,
                         fit.blur_variance)) {
      return std::nullopt;
    }
    Equations sums = Assemble(patch, fit, coverage);
    AddPriors(fit, options, noise * noise, sums);
    fit.mean_squares = sums.squares / patch.count;
    fit.bend = sums.bend;
    fit.saddle = Saddle(fit.map);
    const bool hopeless = step >= 2 && fit.mean_squares > options.hopeless;
    if (fit.converged || hopeless || step == options.max_steps) return fit;
    const Unknowns change = sums.normal.ldlt().solve(sums.right);
    if (!change.allFinite()) return std::nullopt;
    const double moved = Move(change, model, most_variance, fit);
    const Vec2d place = PlaceInPatch(patch, fit.map.At(model.mean));
    fit.contrast = MarkerLightAt(fit.light, place) - SurroundingsAt(fit.light, place);
    fit.converged = moved < options.converged_px;
  }
}

}  // namespace retrolux
