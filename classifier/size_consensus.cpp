#include "classifier/size_consensus.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

bool HasFewEdges(const JudgedPattern& judged) {
  return judged.evidence.straight_edges == 3 || judged.evidence.straight_edges == 4;
}

// The sizes that a pattern's marker may have.
std::vector<double> SizesOf(const JudgedPattern& judged, const std::vector<ShapeModel>& models) {
  const Polygon& found = judged.detection.corners_px;
  if (found.size() != 3) return {judged.evidence.half_size_px};
  const auto model = std::find_if(models.begin(), models.end(), [&](const ShapeModel& m) {
    return m.number == judged.evidence.number;
  });
  const Polygon& seen = model->corners;
  Eigen::Matrix2d sides;
  sides << seen[1] - seen[0], seen[2] - seen[0];
  std::vector<double> sizes;
  for (size_t first = 0; first < 3; ++first) {
    const Vec2d& corner = found[first];
    Eigen::Matrix2d mapped;
    mapped << found[(first + 1) % 3] - corner, found[(first + 2) % 3] - corner;
    sizes.push_back(ViewOf(mapped * sides.inverse()).half_size_px);
  }
  return sizes;
}

// What the others say of a pattern's size; 0 if there are none.
double SizeLogOddsOf(const JudgedPattern& judged, const std::vector<ShapeModel>& models,
                     const std::vector<JudgedPattern>& all) {
  std::vector<double> others;
  for (const JudgedPattern& other : all) {
    const bool tells = &other != &judged && other.detection.marker && !HasFewEdges(other);
    if (tells) others.push_back(other.evidence.half_size_px);
  }
  if (others.empty()) return 0.0;
  const auto middle = others.begin() + static_cast<ptrdiff_t>(others.size() / 2);
  std::nth_element(others.begin(), middle, others.end());
  const std::vector<double> sizes = SizesOf(judged, models);
  double nearest = std::numeric_limits<double>::infinity();
  for (const double size : sizes) {
    const double deviation = std::log(size / *middle);
    if (std::abs(deviation) < std::abs(nearest)) nearest = deviation;
  }
  return SizeLogOdds(nearest, sizes.size(), others.size());
}

void SetName(JudgedPattern& judged, bool named) {
  if (named) {
    judged.detection.marker = judged.evidence.number;
    judged.detection.confidence = judged.probability;
  } else {
    judged.detection.marker.reset();
    judged.detection.confidence = 0.0;
  }
}

// Whether one lies over the middle of the other.
bool Overlap(const JudgedPattern& a, const JudgedPattern& b) {
  return Contains(a.fitted_px, b.detection.centre_px.value_or(b.detection.centroid_px)) ||
         Contains(b.fitted_px, a.detection.centre_px.value_or(a.detection.centroid_px));
}

}  // namespace

double SizeLogOdds(double deviation, size_t sizes, size_t witnesses) {
  // Spread of the sizes of one picture's markers about their median (training pictures: 0.021); the
  // share of right names that are off by anything, as the others are by which they are measured;
  // wrong names per unit of the logarithm, and how many more there are for each further size.
  constexpr double kSpread = 0.03, kOff = 0.1, kWrongDensity = 0.6, kFurtherSize = 0.4;
  const double off = kOff / static_cast<double>(witnesses);
  const double right =
      std::exp(-0.5 * std::pow(deviation / kSpread, 2)) / (kSpread * std::sqrt(2.0 * kPi));
  const double wrong = kWrongDensity + kFurtherSize * static_cast<double>(sizes - 1);
  return std::log((1.0 - off) * right / wrong + off);
}

void NameBySize(const std::vector<ShapeModel>& models, double min_probability,
                std::vector<JudgedPattern>& judged) {
  // The least likely name goes first: it may be what makes others look odd.
  while (true) {
    JudgedPattern* least = nullptr;
    for (JudgedPattern& j : judged) {
      if (!j.detection.marker) continue;
      j.probability = NameProbability(j.evidence, SizeLogOddsOf(j, models, judged));
      if (least == nullptr || j.probability < least->probability) least = &j;
    }
    if (least == nullptr || least->probability >= min_probability) break;
    SetName(*least, false);
  }
  std::vector<size_t> likely;
  for (size_t i = 0; i < judged.size(); ++i) {
    JudgedPattern& j = judged[i];
    if (!j.evidence.fitted) continue;
    if (!j.detection.marker)
      j.probability = NameProbability(j.evidence, SizeLogOddsOf(j, models, judged));
    if (j.probability >= min_probability) likely.push_back(i);
  }
  std::stable_sort(likely.begin(), likely.end(), [&](size_t a, size_t b) {
    return judged[a].probability > judged[b].probability;
  });
  std::vector<size_t> named;
  for (const size_t i : likely) {
    const bool taken = std::any_of(named.begin(), named.end(),
                                   [&](size_t k) { return Overlap(judged[i], judged[k]); });
    SetName(judged[i], !taken);
    if (!taken) named.push_back(i);
  }
  std::vector<JudgedPattern> kept;
  for (size_t i = 0; i < judged.size(); ++i) {
    const JudgedPattern& j = judged[i];
    const bool within = std::any_of(named.begin(), named.end(), [&](size_t k) {
      return k != i && judged[k].dark == j.dark &&
             Contains(judged[k].fitted_px, Centroid(j.outline_px));
    });
    if (j.detection.marker || !within) kept.push_back(j);
  }
  judged = std::move(kept);
}

}  // namespace retrolux
