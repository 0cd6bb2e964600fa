#include "analysis/vault_plot_parts.h"

#include <cmath>

#include "analysis/vault_text.h"

namespace retrolux {

using nlohmann::json;

namespace {

json MarkerOf(const char* colour, const char* symbol, int size) {
  return {{"symbol", symbol},
          {"size", size},
          {"color", colour},
          {"line", {{"color", "#ffffff"}, {"width", 1.5}}}};
}

}  // namespace

double RoundedCost(double cost) {
  return std::round(1e4 * cost) / 1e4;
}

double RoundedAngle(double deg) {
  return std::round(1e6 * deg) / 1e6;
}

std::string HoverOf(const PlacementResult& result) {
  return fmt::format("{}: {:.3f}", TextOf(result.Where()), result.Cost());
}

std::vector<PlacementMark> MarksOf(const VaultStudy& study) {
  std::vector<PlacementMark> marks = {
      {"our optimum", &study.best.result, MarkerOf(plot_colour::kVermillion, "star", 15)}};
  for (const NamedResult& thesis : study.thesis) {
    marks.push_back({fmt::format("placement of the thesis's {}", thesis.name), &thesis.result,
                     MarkerOf(plot_colour::kSky, marks.size() == 1 ? "diamond" : "square", 10)});
  }
  return marks;
}

json TraceOf(const PlacementMark& mark, double x, double y) {
  return {{"type", "scatter"},
          {"mode", "markers"},
          {"name", mark.name},
          {"x", {x}},
          {"y", {y}},
          {"text", {HoverOf(*mark.result)}},
          {"hoverinfo", "text"},
          {"marker", mark.marker}};
}

}  // namespace retrolux
