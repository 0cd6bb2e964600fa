#include "analysis/evaluation_targets.h"

namespace retrolux {

namespace {

// The limits of the markers that they are about are in EvaluationLimits.
constexpr double kFoundAim = 0.99, kSteepFoundAim = 0.9;
constexpr double kWrongAim = 1e-3;
constexpr double kRmsAim_px = 0.05, kBiasAim_px = 0.01;

constexpr const char* kAll = "all";

MarkerCondition Whole(const EvaluationLimits& limits, double from_deg, double to_deg) {
  const std::string incidence = from_deg > 0.0 ? fmt::format("{:g} to {:g} deg", from_deg, to_deg)
                                               : fmt::format("below {:g} deg", to_deg);
  return {fmt::format("whole, {:g} px, {}", limits.target_size_px, incidence),
          [=, size = limits.target_size_px](const EvaluatedMarker& marker) {
            const double angle = marker.label->incidence_deg;
            return marker.whole && marker.label->size_px >= size && angle >= from_deg &&
                   angle < to_deg;
          }};
}

const std::vector<MarkerCondition>& Kinds() {
  static const std::vector<MarkerCondition> kinds = {
      {kAll, [](const EvaluatedMarker&) { return true; }},
      {"bright, identifiable",
       [](const EvaluatedMarker& m) { return !m.label->dark && m.label->number != 0; }},
      {"bright, standard",
       [](const EvaluatedMarker& m) { return !m.label->dark && m.label->number == 0; }},
      {"dark, identifiable",
       [](const EvaluatedMarker& m) { return m.label->dark && m.label->number != 0; }},
      {"dark, standard",
       [](const EvaluatedMarker& m) { return m.label->dark && m.label->number == 0; }},
  };
  return kinds;
}

MarkerCondition Both(const MarkerCondition& a, const MarkerCondition& b) {
  return {a.name == kAll ? b.name : a.name + ": " + b.name,
          [=](const EvaluatedMarker& marker) { return a.holds(marker) && b.holds(marker); }};
}

Scores ScoresWhere(const Evaluation& evaluation, const MethodResult& method,
                   const MarkerCondition& condition) {
  EvaluationChoice choice;
  for (size_t i = 0; i < evaluation.markers.size(); ++i) {
    if (condition.holds(evaluation.markers[i])) choice.markers.push_back(i);
  }
  return ScoresOf(evaluation, method, choice);
}

EvaluationTarget Found(const std::string& markers, const Scores& scores, double aim) {
  const Proportion share = scores.Recall();
  const auto value = share.Value();
  return {"found", markers, "1", share, value, aim, value && *value >= aim};
}

EvaluationTarget Wrong(const std::string& measure, const Proportion& share) {
  return {measure,
          kAll,
          "1",
          share,
          share.Value(),
          kWrongAim,
          share.of > 0 && share.count == 0 && share.Wilson().high < kWrongAim};
}

EvaluationTarget Below(const std::string& measure, const std::string& markers, double value,
                       double aim) {
  return {measure, markers, "px", std::nullopt, value, aim, value < aim};
}

}  // namespace

std::vector<MarkerCondition> PairedConditions(const EvaluationLimits& limits) {
  return {Kinds().front(), Whole(limits, 0.0, limits.target_incidence_deg)};
}

std::vector<EvaluationTarget> TargetsOf(const Evaluation& evaluation, const MethodResult& method) {
  const EvaluationLimits& limits = evaluation.limits;
  const double flat = limits.target_incidence_deg, steep = limits.target_steep_incidence_deg;
  struct Wanted {
    MarkerCondition condition;
    double aim;
  };
  const Wanted wanted[] = {{Whole(limits, 0.0, flat), kFoundAim},
                           {Whole(limits, flat, steep), kSteepFoundAim},
                           {Whole(limits, 0.0, steep), kSteepFoundAim}};
  std::vector<EvaluationTarget> targets;
  for (const Wanted& range : wanted) {
    for (const MarkerCondition& kind : Kinds()) {
      const MarkerCondition both = Both(range.condition, kind);
      const Scores scores = ScoresWhere(evaluation, method, both);
      if (scores.markers > 0) targets.push_back(Found(both.name, scores, range.aim));
    }
  }
  const Scores all = ScoresOf(evaluation, method, Everything(evaluation));
  targets.push_back(Wrong("misnamed", all.Misnamed()));
  targets.push_back(Wrong("wrong names", all.WrongNames()));
  for (const MarkerCondition& range : {Kinds().front(), wanted[0].condition}) {
    for (const MarkerCondition& kind : Kinds()) {
      const MarkerCondition both = Both(range, kind);
      const PlaceErrors errors = ScoresWhere(evaluation, method, both).centroid;
      if (errors.Count() == 0) continue;
      targets.push_back(Below("centroid rms", both.name, errors.rms, kRmsAim_px));
      targets.push_back(Below("centroid bias", both.name, errors.Bias(), kBiasAim_px));
    }
  }
  return targets;
}

}  // namespace retrolux
