#include "analysis/evaluation_scores.h"

#include <numeric>
#include <set>

#include "analysis/evaluation_targets.h"
#include "core/marker_set.h"

namespace retrolux {

namespace {

// A counter that sees each detection in the pictures.
void CountVerdicts(const MethodResult& method, const EvaluationChoice& choice, Scores& scores) {
  for (const size_t picture : choice.pictures) {
    ++scores.pictures;
    for (const JudgedDetection& judged : method.verdicts[picture]) {
      scores.false_positives += judged.verdict == Verdict::kNothing;
      scores.false_positives += judged.verdict == Verdict::kDuplicate;
      scores.duplicates += judged.verdict == Verdict::kDuplicate;
      scores.unnamed += judged.verdict == Verdict::kUnnamed;
    }
  }
}

// Those of the set, of the labels and of the names; the standard marker last.
std::vector<int> Classes(const Evaluation& evaluation, const MethodResult& method) {
  std::set<int> numbers;
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) numbers.insert(shape.number);
  for (const EvaluatedMarker& marker : evaluation.markers) numbers.insert(marker.label->number);
  for (const std::vector<Detection>& detections : method.detections) {
    for (const Detection& detection : detections) numbers.insert(detection.marker.value_or(0));
  }
  numbers.erase(0);
  std::vector<int> classes(numbers.begin(), numbers.end());
  classes.push_back(0);
  return classes;
}

}  // namespace

EvaluationChoice Everything(const Evaluation& evaluation) {
  EvaluationChoice choice;
  choice.markers.resize(evaluation.markers.size());
  choice.pictures.resize(evaluation.pictures.size());
  std::iota(choice.markers.begin(), choice.markers.end(), size_t{0});
  std::iota(choice.pictures.begin(), choice.pictures.end(), size_t{0});
  return choice;
}

std::optional<double> Scores::F1() const {
  if (markers + Named() == 0) return std::nullopt;
  return 2.0 * static_cast<double>(found) / static_cast<double>(markers + Named());
}

Scores ScoresOf(const Evaluation& evaluation, const MethodResult& method,
                const EvaluationChoice& choice) {
  Scores scores;
  std::vector<PlaceError> centroids, outlines, corners;
  for (const size_t i : choice.markers) {
    const MarkerResult& result = method.markers[i];
    const bool counts = evaluation.markers[i].shape.counts || choice.all_markers;
    const bool found = result.match.outcome == LabelOutcome::kFound;
    scores.markers += counts;
    scores.misnamed += result.match.wrong_names;
    scores.found += counts && found;
    scores.ignored += !counts && found;
    if (!counts || !found) continue;
    if (result.centroid) centroids.push_back(*result.centroid);
    if (result.outline) outlines.push_back(*result.outline);
    corners.insert(corners.end(), result.corners.begin(), result.corners.end());
  }
  CountVerdicts(method, choice, scores);
  scores.centroid = PlaceErrorsOf(centroids);
  scores.outline = PlaceErrorsOf(outlines);
  scores.corners = PlaceErrorsOf(corners);
  return scores;
}

Confusion ConfusionOf(const Evaluation& evaluation, const MethodResult& method) {
  const std::vector<int> classes = Classes(evaluation, method);
  const auto place = [&](int number) {
    return static_cast<size_t>(std::find(classes.begin(), classes.end(), number) - classes.begin());
  };
  const size_t nothing = classes.size(), unnamed = classes.size(), none = unnamed + 1;
  Confusion confusion;
  for (const int number : classes) confusion.truth.push_back(MarkerName(number));
  confusion.named = confusion.truth;
  confusion.truth.emplace_back("nothing");
  confusion.named.emplace_back("unnamed");
  confusion.named.emplace_back("none");
  confusion.counts.assign(nothing + 1, std::vector<int64_t>(none + 1, 0));
  for (size_t p = 0; p < evaluation.pictures.size(); ++p) {
    for (size_t i = 0; i < method.verdicts[p].size(); ++i) {
      const JudgedDetection& judged = method.verdicts[p][i];
      const std::optional<int>& name = method.detections[p][i].marker;
      if (judged.verdict == Verdict::kUnnamed || judged.verdict == Verdict::kIgnored) continue;
      const bool on_marker =
          judged.verdict == Verdict::kFound || judged.verdict == Verdict::kMisnamed;
      const size_t row =
          on_marker ? place(evaluation.markers[evaluation.pictures[p].first_marker + *judged.marker]
                                .label->number)
                    : nothing;
      ++confusion.counts[row][place(*name)];
    }
  }
  for (size_t i = 0; i < evaluation.markers.size(); ++i) {
    const LabelOutcome outcome = method.markers[i].match.outcome;
    if (!evaluation.markers[i].shape.counts) continue;
    const size_t row = place(evaluation.markers[i].label->number);
    if (outcome == LabelOutcome::kUnnamed) ++confusion.counts[row][unnamed];
    if (outcome == LabelOutcome::kMissed) ++confusion.counts[row][none];
  }
  return confusion;
}

std::vector<PairedResult> PairedResults(const Evaluation& evaluation) {
  std::vector<PairedResult> results;
  for (size_t a = 0; a < evaluation.methods.size(); ++a) {
    for (size_t b = a + 1; b < evaluation.methods.size(); ++b) {
      for (const MarkerCondition& condition : PairedConditions(evaluation.limits)) {
        const MethodResult &first = evaluation.methods[a], &second = evaluation.methods[b];
        PairedResult result{first.method, second.method, condition.name};
        for (size_t i = 0; i < evaluation.markers.size(); ++i) {
          if (!evaluation.markers[i].shape.counts || !condition.holds(evaluation.markers[i]))
            continue;
          const bool by_first = first.markers[i].match.outcome == LabelOutcome::kFound;
          const bool by_second = second.markers[i].match.outcome == LabelOutcome::kFound;
          result.both += by_first && by_second;
          result.first_only += by_first && !by_second;
          result.second_only += !by_first && by_second;
          result.neither += !by_first && !by_second;
        }
        results.push_back(std::move(result));
      }
    }
  }
  return results;
}

}  // namespace retrolux
