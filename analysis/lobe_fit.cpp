#include "analysis/lobe_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "core/error.h"

namespace retrolux {

namespace {

// The residuals ln(model / table) over the logarithms of widths, albedos and weights, so that all
// stay positive.
class Residuals {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Residuals(const RaTable& table, int lobes, FacetShape shape)
      : table_(table), lobes_(lobes), shape_(shape) {}

  int inputs() const { return 2 * lobes_ + static_cast<int>(table_.entrance_deg.size()) - 1; }
  int values() const {
    return static_cast<int>(table_.observation_deg.size() * table_.entrance_deg.size());
  }
  int operator()(const InputType& x, ValueType& residuals) const {
    const LobeFit fit = At(x);
    Eigen::Index next = 0;
    for (const std::vector<double>& row : fit.residuals) {
      for (const double residual : row) residuals[next++] = residual;
    }
    return 0;
  }

  LobeFit At(const InputType& x) const {
    LobeFit fit;
    for (int k = 0; k < lobes_; ++k) {
      const auto alpha = static_cast<float>(std::clamp(std::exp(x[2 * k]), 5e-4, 1.0));
      fit.lobes.push_back({{shape_, alpha}, static_cast<float>(std::exp(x[2 * k + 1]))});
    }
    fit.entrance_weight.assign(1, 1.0);
    for (int k = 2 * lobes_; k < inputs(); ++k) fit.entrance_weight.push_back(std::exp(x[k]));
    double sum2 = 0.0;
    for (size_t i = 0; i < table_.observation_deg.size(); ++i) {
      std::vector<double>& row = fit.residuals.emplace_back();
      for (size_t j = 0; j < table_.entrance_deg.size(); ++j) {
        const double ra = fit.entrance_weight[j] * LobesAt(fit.lobes, i, j);
        row.push_back(std::log(std::max(ra, 1e-30) / table_.ra[i][j]));
        sum2 += row.back() * row.back();
      }
    }
    fit.rms_ln_ra = std::sqrt(sum2 / values());
    return fit;
  }

 private:
  double LobesAt(const std::vector<RetroLobe>& lobes, size_t i, size_t j) const {
    const CoplanarDirections at = CoplanarAt(table_.observation_deg[i], table_.entrance_deg[j]);
    const Vec3f wo = at.to_observer.cast<float>(), wi = at.to_light.cast<float>();
    double sum = 0.0;
    for (const RetroLobe& lobe : lobes) {
      sum += static_cast<double>(lobe.Evaluate(wo, wi).f_cos * wo.z());
    }
    return sum;
  }

  const RaTable& table_;
  int lobes_;
  FacetShape shape_;
};

// Widths spread by powers of `ratio` from half the smallest observation angle times `first`;
// albedos equal.
Eigen::VectorXd Start(const RaTable& table, const Residuals& residuals, int lobes, double first,
                      double ratio) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(residuals.inputs());
  const double half = 0.5 * RadFromDeg(table.observation_deg.front());
  for (int k = 0; k < lobes; ++k) {
    x[2 * k] = std::log(first * half * std::pow(ratio, k));
    x[2 * k + 1] = std::log(0.1);
  }
  return x;
}

bool ReflectsLessThanArrives(const LobeFit& fit) {
  double albedo = 0.0;
  for (const RetroLobe& lobe : fit.lobes) albedo += static_cast<double>(lobe.albedo);
  return albedo <= 1.0 && std::isfinite(fit.rms_ln_ra);
}

}  // namespace

LobeFit FitLobes(const RaTable& table, int lobes, FacetShape shape) {
  const Residuals residuals(table, lobes, shape);
  if (residuals.values() < residuals.inputs()) {
    throw InputError(
        fmt::format("{} lobes and the entrance weights have {} parameters, the table {} points; "
                    "expected no more parameters than points",
                    lobes, residuals.inputs(), residuals.values()));
  }
  std::optional<LobeFit> best;
  for (const double first : {0.7, 1.5, 3.0}) {
    for (const double ratio : {2.5, 6.0, 15.0}) {
      Eigen::VectorXd x = Start(table, residuals, lobes, first, ratio);
      // The lobes are evaluated in single precision: steps of 1e-3, central.
      Eigen::NumericalDiff<Residuals, Eigen::Central> with_derivatives(residuals, 1e-6);
      Eigen::LevenbergMarquardt<decltype(with_derivatives)> optimiser(with_derivatives);
      optimiser.parameters.maxfev = 2000;
      optimiser.minimize(x);
      LobeFit fit = residuals.At(x);
      if (ReflectsLessThanArrives(fit) && (!best || fit.rms_ln_ra < best->rms_ln_ra)) best = fit;
    }
  }
  if (!best) {
    throw InputError(fmt::format(
        "no {} lobes fit that reflect less light than arrives; expected fewer lobes", lobes));
  }
  std::sort(best->lobes.begin(), best->lobes.end(),
            [](const RetroLobe& a, const RetroLobe& b) { return a.facets.alpha < b.facets.alpha; });
  return *best;
}

}  // namespace retrolux
