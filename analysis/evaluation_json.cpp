#include "analysis/evaluation_files.h"
#include "analysis/evaluation_targets.h"

namespace retrolux {

using Json = nlohmann::ordered_json;

namespace {

Json OrNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json ToJson(const Interval& interval) {
  return {interval.low, interval.high};
}

Json ToJson(const ScalarErrors& errors) {
  if (errors.count == 0) return nullptr;
  return {{"count", errors.count},
          {"bias_px", errors.bias},
          {"bias_error_px", errors.StandardError()},
          {"sigma_px", errors.sigma},
          {"p95_px", errors.p95}};
}

Json ToJson(const PlaceErrors& errors) {
  if (errors.Count() == 0) return nullptr;
  return {{"count", errors.Count()},
          {"rms_px", errors.rms},
          {"bias_px", errors.Bias()},
          {"bias_error_px", errors.BiasError()},
          {"p95_px", errors.p95},
          {"u", ToJson(errors.u)},
          {"v", ToJson(errors.v)},
          {"tilt", ToJson(errors.tilt)},
          {"outward", ToJson(errors.outward)}};
}

// What every choice of markers has.
Json MarkerScores(const Scores& scores) {
  const auto share = [](const Proportion& p) { return OrNull(p.Value()); };
  const bool any = scores.centroid.Count() > 0;
  return {{"markers", scores.markers},
          {"found", scores.found},
          {"misnamed", scores.misnamed},
          {"ignored", scores.ignored},
          {"recall", share(scores.Recall())},
          {"recall_interval", ToJson(scores.Recall().Wilson())},
          {"misnamed_share", share(scores.Misnamed())},
          {"misnamed_share_interval", ToJson(scores.Misnamed().Wilson())},
          {"centroid_rms_px", any ? Json(scores.centroid.rms) : Json()},
          {"centroid_bias_px", any ? Json(scores.centroid.Bias()) : Json()},
          {"centroid", ToJson(scores.centroid)},
          {"centroid_outline", ToJson(scores.outline)},
          {"corners", ToJson(scores.corners)}};
}

// What pictures with all of their markers have beyond that.
Json PictureScores(const Scores& scores) {
  return {{"pictures", scores.pictures},
          {"named", scores.Named()},
          {"false_positives", scores.false_positives},
          {"duplicates", scores.duplicates},
          {"unnamed", scores.unnamed},
          {"false_positives_per_picture",
           static_cast<double>(scores.false_positives) / static_cast<double>(scores.pictures)},
          {"precision", OrNull(scores.Precision().Value())},
          {"precision_interval", ToJson(scores.Precision().Wilson())},
          {"wrong_share", OrNull(scores.WrongNames().Value())},
          {"wrong_share_interval", ToJson(scores.WrongNames().Wilson())},
          {"f1", OrNull(scores.F1())}};
}

Json GroupJson(const Evaluation& evaluation, const MethodResult& method,
               const EvaluationGroup& group) {
  Json json;
  if (group.is_range) {
    json["from"] = OrNull(group.from);
    json["to"] = OrNull(group.to);
  } else {
    json["value"] = group.value;
  }
  const Scores scores = ScoresOf(evaluation, method, group.choice);
  if (scores.pictures > 0) json.update(PictureScores(scores));
  json.update(MarkerScores(scores));
  return json;
}

Json TargetJson(const EvaluationTarget& target) {
  Json json = {{"measure", target.measure}, {"markers", target.markers}, {"unit", target.unit}};
  if (target.share) {
    json["count"] = target.share->count;
    json["of"] = target.share->of;
    json["interval"] = ToJson(target.share->Wilson());
  }
  json["value"] = OrNull(target.value);
  json["aim"] = target.aim;
  json["met"] = target.met;
  return json;
}

Json MethodJson(const Evaluation& evaluation, const MethodResult& method,
                const std::vector<EvaluationVariable>& variables) {
  const Scores scores = ScoresOf(evaluation, method, Everything(evaluation));
  const Confusion confusion = ConfusionOf(evaluation, method);
  Json json = {{"method", method.method}};
  json.update(PictureScores(scores));
  json.update(MarkerScores(scores));
  json["confusion"] = {
      {"truth", confusion.truth}, {"named", confusion.named}, {"counts", confusion.counts}};
  json["targets"] = Json::array();
  for (const EvaluationTarget& target : TargetsOf(evaluation, method))
    json["targets"].push_back(TargetJson(target));
  json["by"] = Json::object();
  for (const EvaluationVariable& variable : variables) {
    Json& groups = json["by"][variable.name] = Json::array();
    for (const EvaluationGroup& group : variable.groups)
      groups.push_back(GroupJson(evaluation, method, group));
  }
  return json;
}

Json LimitsJson(const EvaluationLimits& limits) {
  return {{"margin_px", limits.margin_px},
          {"min_visible_fraction", limits.min_visible_fraction},
          {"whole_fraction", limits.whole_fraction},
          {"min_tilt_deg", limits.min_tilt_deg},
          {"target_size_px", limits.target_size_px},
          {"target_incidence_deg", limits.target_incidence_deg},
          {"target_steep_incidence_deg", limits.target_steep_incidence_deg}};
}

Json PairedJson(const PairedResult& result) {
  return {{"first", result.first},           {"second", result.second},
          {"markers", result.markers},       {"both", result.both},
          {"first_only", result.first_only}, {"second_only", result.second_only},
          {"neither", result.neither},       {"mcnemar_p", result.P()}};
}

}  // namespace

Json EvaluationJson(const Evaluation& evaluation, const DatasetIndex& index,
                    const std::vector<EvaluationVariable>& variables) {
  Json json = {{"schema", "retrolux/evaluation-1"},
               {"version", RETROLUX_VERSION},
               {"units", "px, mm, deg"},
               {"pixel_origin", "center"},
               {"dataset", index.header.at("name")},
               {"split", evaluation.split},
               {"limits", LimitsJson(evaluation.limits)}};
  json.update(MethodJson(evaluation, evaluation.methods.front(), variables));
  json["compared"] = Json::array();
  for (size_t i = 1; i < evaluation.methods.size(); ++i)
    json["compared"].push_back(MethodJson(evaluation, evaluation.methods[i], variables));
  json["paired"] = Json::array();
  for (const PairedResult& result : PairedResults(evaluation))
    json["paired"].push_back(PairedJson(result));
  return json;
}

}  // namespace retrolux
