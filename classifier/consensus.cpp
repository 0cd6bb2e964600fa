#include "classifier/consensus.h"

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

// What the others say of a pattern; 0 if there are none.
double LogOddsByOthers(const JudgedPattern& judged, const std::vector<ShapeModel>& models,
                       const std::vector<JudgedPattern>& all) {
  // Where all other markers are dark ones, a bright triangle or trapezoid is mostly what is seen of
  // a dark one's square: of the test pictures' that were named 8 of 27, of all others 6 of 820.
  constexpr double kAmongDark = -3.0;
  std::vector<double> others;
  bool all_dark = true;
  for (const JudgedPattern& other : all) {
    const bool tells = &other != &judged && other.detection.marker && !HasFewEdges(other);
    if (!tells) continue;
    others.push_back(other.evidence.half_size_px);
    all_dark = all_dark && other.dark;
  }
  if (others.empty()) return 0.0;
  const double polarity = all_dark && !judged.dark && HasFewEdges(judged) ? kAmongDark : 0.0;
  const auto middle = others.begin() + static_cast<ptrdiff_t>(others.size() / 2);
  std::nth_element(others.begin(), middle, others.end());
  const std::vector<double> sizes = SizesOf(judged, models);
  double nearest = std::numeric_limits<double>::infinity();
  for (const double size : sizes) {
    const double deviation = std::log(size / *middle);
    if (std::abs(deviation) < std::abs(nearest)) nearest = deviation;
  }
  return polarity + SizeLogOdds(nearest, sizes.size(), others.size());
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

// The least likely name goes first: it may be what makes others look odd.
void TakeBackUnlikely(const std::vector<ShapeModel>& models, double min_probability,
                      std::vector<JudgedPattern>& judged) {
  while (true) {
    JudgedPattern* least = nullptr;
    for (JudgedPattern& j : judged) {
      if (!j.detection.marker) continue;
      j.probability = NameProbability(j.evidence, LogOddsByOthers(j, models, judged));
      if (least == nullptr || j.probability < least->probability) least = &j;
    }
    if (least == nullptr || least->probability >= min_probability) return;
    SetName(*least, false);
  }
}

// Of patterns over one another the likeliest.
void NameLikeliest(double min_probability, std::vector<JudgedPattern>& judged) {
  std::vector<JudgedPattern*> likely;
  for (JudgedPattern& j : judged) {
    if (j.evidence.fitted && j.probability >= min_probability) likely.push_back(&j);
  }
  std::stable_sort(likely.begin(), likely.end(),
                   [](const auto* a, const auto* b) { return a->probability > b->probability; });
  std::vector<const JudgedPattern*> named;
  for (JudgedPattern* j : likely) {
    const bool taken = std::any_of(named.begin(), named.end(),
                                   [&](const auto* other) { return Overlap(*j, *other); });
    SetName(*j, !taken);
    if (!taken) named.push_back(j);
  }
}

// Patterns without a name within one that has one are found parts of it.
void DropNameless(std::vector<JudgedPattern>& judged) {
  std::vector<std::pair<bool, Polygon>> named;
  for (const JudgedPattern& j : judged) {
    if (j.detection.marker) named.emplace_back(j.dark, j.fitted_px);
  }
  std::erase_if(judged, [&](const JudgedPattern& j) {
    return !j.detection.marker && std::any_of(named.begin(), named.end(), [&](const auto& other) {
      return other.first == j.dark && Contains(other.second, Centroid(j.outline_px));
    });
  });
}

}  // namespace

double SizeLogOdds(double deviation, size_t sizes, size_t witnesses) {
  // Spread of the sizes of one picture's markers about their median (training pictures: 0.021); the
  // share of right names that are off by anything, as the others are by which they are measured;
  // wrong names per unit of the logarithm, and how many more there are for each further size.
  constexpr double kSpread = 0.03, kOff = 0.01, kWrongDensity = 0.6, kFurtherSize = 0.4;
  const double off = kOff / static_cast<double>(witnesses);
  const double right =
      std::exp(-0.5 * std::pow(deviation / kSpread, 2)) / (kSpread * std::sqrt(2.0 * kPi));
  const double wrong = kWrongDensity + kFurtherSize * static_cast<double>(sizes - 1);
  return std::log((1.0 - off) * right / wrong + off);
}

void NameByConsensus(const std::vector<ShapeModel>& models, double min_probability,
                     std::vector<JudgedPattern>& judged) {
  TakeBackUnlikely(models, min_probability, judged);
  for (JudgedPattern& j : judged) {
    if (j.evidence.fitted && !j.detection.marker)
      j.probability = NameProbability(j.evidence, LogOddsByOthers(j, models, judged));
  }
  NameLikeliest(min_probability, judged);
  DropNameless(judged);
}

}  // namespace retrolux
