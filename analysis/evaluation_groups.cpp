#include "analysis/evaluation_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace retrolux {

using Json = nlohmann::json;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const char* const kBlur = "blur_px";

std::optional<double> Bound(double edge) {
  return std::isfinite(edge) ? std::optional(edge) : std::nullopt;
}

// A group for each interval between neighbouring edges.
std::vector<EvaluationGroup> Ranges(const std::vector<double>& edges) {
  std::vector<EvaluationGroup> groups;
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    EvaluationGroup group;
    group.is_range = true;
    group.from = Bound(edges[i]);
    group.to = Bound(edges[i + 1]);
    groups.push_back(std::move(group));
  }
  return groups;
}

size_t PartOf(const std::vector<double>& edges, double value) {
  const auto above = std::upper_bound(edges.begin(), edges.end(), value);
  const auto i = std::max<ptrdiff_t>(above - edges.begin() - 1, 0);
  return std::min(static_cast<size_t>(i), edges.size() - 2);
}

// A property of the markers with fixed intervals, so that runs can be compared.
struct Ruler {
  const char *name, *title;
  std::vector<double> edges;
  std::optional<double> (*value)(const EvaluatedMarker&);
  bool all_markers = false;
};

const std::vector<Ruler>& Rulers() {
  static const std::vector<Ruler> rulers = {
      {"incidence_deg",
       "incidence angle (deg)",
       {0, 10, 20, 30, 40, 50, 60, 70, 80, 180},
       [](const EvaluatedMarker& m) { return std::optional(m.label->incidence_deg); }},
      {"distance_mm",
       "distance (mm)",
       {0, 1000, 1200, 1400, 1600, 1800, 2000, 2400, 2800, kInfinity},
       [](const EvaluatedMarker& m) { return std::optional(m.label->distance_mm); }},
      {"size_px",
       "size (px)",
       {0, 10, 15, 20, 25, 30, 40, 50, 70, kInfinity},
       [](const EvaluatedMarker& m) { return std::optional(m.label->size_px); }},
      {"snr",
       "signal to noise, SNR",
       {-kInfinity, 0, 2, 5, 10, 20, 50, 100, kInfinity},
       [](const EvaluatedMarker& m) { return m.label->snr; }},
      {"visible_fraction",
       "visible fraction",
       {0, 0.25, 0.5, 0.75, 0.9, 0.99, kInfinity},
       [](const EvaluatedMarker& m) { return std::optional(m.label->visible_fraction); },
       true},
      {"frame_position",
       "distance from the picture's middle (half diagonals)",
       {0, 0.2, 0.4, 0.6, 0.8, kInfinity},
       [](const EvaluatedMarker& m) { return std::optional(m.frame_position); }},
  };
  return rulers;
}

EvaluationVariable ByRuler(const Evaluation& evaluation, const Ruler& ruler) {
  EvaluationVariable variable{ruler.name, ruler.title, false, Ranges(ruler.edges)};
  for (EvaluationGroup& group : variable.groups) group.choice.all_markers = ruler.all_markers;
  for (size_t i = 0; i < evaluation.markers.size(); ++i) {
    const auto value = ruler.value(evaluation.markers[i]);
    if (value) variable.groups[PartOf(ruler.edges, *value)].choice.markers.push_back(i);
  }
  return variable;
}

EvaluationVariable ByName(const Evaluation& evaluation, const char* name,
                          std::string (*value)(const MarkerLabel&)) {
  std::map<std::string, EvaluationGroup> groups;
  for (size_t i = 0; i < evaluation.markers.size(); ++i)
    groups[value(*evaluation.markers[i].label)].choice.markers.push_back(i);
  EvaluationVariable variable{name, name, false, {}};
  for (auto& [text, group] : groups) {
    group.value = text;
    variable.groups.push_back(std::move(group));
  }
  return variable;
}

// Of one nuisance, what each picture was drawn as.
using PictureValues = std::vector<Json>;

std::map<std::string, PictureValues> Nuisances(const Evaluation& evaluation) {
  std::map<std::string, PictureValues> all;
  const size_t pictures = evaluation.pictures.size();
  const auto set = [&](const std::string& name, size_t picture, const Json& value) {
    all.try_emplace(name, PictureValues(pictures)).first->second[picture] = value;
  };
  for (size_t i = 0; i < pictures; ++i) {
    for (const auto& [name, value] : evaluation.pictures[i].scene->nuisances.items()) {
      if (!value.is_array()) set(name, i, value);
      const char* axes[] = {" x", " y", " z"};
      for (size_t k = 0; value.is_array() && k < std::min<size_t>(value.size(), 3); ++k)
        set(name + axes[k], i, value[k]);
    }
  }
  return all;
}

void AddPicture(const Evaluation& evaluation, size_t picture, EvaluationGroup& group) {
  group.choice.pictures.push_back(picture);
  const EvaluatedPicture& evaluated = evaluation.pictures[picture];
  for (size_t k = 0; k < evaluated.marker_count; ++k)
    group.choice.markers.push_back(evaluated.first_marker + k);
}

// Edges of parts with as many of the numbers each; equal ones are one.
std::vector<double> QuantileEdges(std::vector<double> numbers, int parts) {
  std::sort(numbers.begin(), numbers.end());
  std::set<double> edges;
  for (int i = 0; i <= parts; ++i) {
    const double place = static_cast<double>(numbers.size() - 1) * i / parts;
    edges.insert(numbers[static_cast<size_t>(place + 0.5)]);
  }
  return {edges.begin(), edges.end()};
}

// Names, yes and no, null and 0 are groups of their own; other numbers, too, if they are few, else
// they are cut into intervals.
EvaluationVariable ByNuisance(const Evaluation& evaluation, const std::string& name,
                              const PictureValues& values) {
  const auto is_own = [](const Json& value) { return !value.is_number() || value == 0; };
  std::set<double> different;
  std::vector<double> numbers;
  for (const Json& value : values) {
    if (is_own(value)) continue;
    numbers.push_back(value.get<double>());
    different.insert(numbers.back());
  }
  const bool few = static_cast<int>(different.size()) <= evaluation.limits.values;
  std::map<Json, EvaluationGroup> own;
  std::vector<double> edges;
  std::vector<EvaluationGroup> ranges;
  if (!few) {
    edges = name == kBlur ? std::vector<double>{0.0, 0.5, 1.0, 1.5, 2.0, 3.0, kInfinity}
                          : QuantileEdges(numbers, evaluation.limits.parts);
    ranges = Ranges(edges);
  }
  for (size_t i = 0; i < values.size(); ++i) {
    const bool alone = few || is_own(values[i]);
    EvaluationGroup& group =
        alone ? own[values[i]] : ranges[PartOf(edges, values[i].get<double>())];
    AddPicture(evaluation, i, group);
  }
  EvaluationVariable variable{"scene." + name, name, true, {}};
  for (auto& [value, group] : own) {
    group.value = value;
    variable.groups.push_back(std::move(group));
  }
  for (EvaluationGroup& range : ranges) variable.groups.push_back(std::move(range));
  return variable;
}

}  // namespace

std::string EvaluationGroup::Label() const {
  if (!is_range) {
    if (value.is_null()) return "none";
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    return value.is_string() ? value.get<std::string>()
                             : fmt::format("{:.4g}", value.get<double>());
  }
  if (!from) return fmt::format("below {:.4g}", *to);
  if (!to) return fmt::format("from {:.4g}", *from);
  return fmt::format("{:.4g} to {:.4g}", *from, *to);
}

std::vector<EvaluationVariable> EvaluationVariables(const Evaluation& evaluation) {
  std::vector<EvaluationVariable> variables;
  for (const Ruler& ruler : Rulers()) variables.push_back(ByRuler(evaluation, ruler));
  variables.push_back(ByName(evaluation, "marker",
                             [](const MarkerLabel& label) { return MarkerName(label.number); }));
  variables.push_back(ByName(evaluation, "polarity", [](const MarkerLabel& label) {
    return std::string(label.dark ? "dark" : "bright");
  }));
  for (const auto& [name, values] : Nuisances(evaluation))
    variables.push_back(ByNuisance(evaluation, name, values));
  for (EvaluationVariable& variable : variables) {
    std::erase_if(variable.groups, [](const EvaluationGroup& group) {
      return group.choice.markers.empty() && group.choice.pictures.empty();
    });
  }
  return variables;
}

}  // namespace retrolux
