#include "analysis/vault_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/polygon.h"

namespace retrolux {

namespace {

using nlohmann::json;

constexpr int kHeight_px = 640;
constexpr int kCircleSegments = 120;
constexpr double kMargin_mm = 150.0;

// One of the two drawings: which world axes lie along the paper, and the axes of the plot.
struct View {
  int right, up;
  const char* x_axis;
  const char* y_axis;

  Vec2d operator()(const Vec3d& point) const { return {point[right], point[up]}; }
  bool FromAbove() const { return up == 1; }
};

// The cameras that hang at one height.
struct Rig {
  std::string name;
  const char* colour;
  double radius_mm, height_mm;
  std::vector<int> cameras;  // from 0
};

std::vector<Rig> RigsOf(const std::vector<Vec3d>& centres) {
  const auto rig = [&](const char* name, const char* colour, size_t first) {
    Rig made{name, colour, centres[first].head<2>().norm(), centres[first].z(), {}};
    for (size_t i = first; i < centres.size(); i += 2) made.cameras.push_back(static_cast<int>(i));
    return made;
  };
  Rig one = rig("rig 1", plot_colour::kBlue, 1), two = rig("rig 2", plot_colour::kVermillion, 0);
  constexpr double kSame_mm = 1e-3;
  if (std::abs(one.height_mm - two.height_mm) > kSame_mm ||
      std::abs(one.radius_mm - two.radius_mm) > kSame_mm)
    return {one, two};
  one.name = "both rigs";
  one.cameras.insert(one.cameras.end(), two.cameras.begin(), two.cameras.end());
  std::sort(one.cameras.begin(), one.cameras.end());
  return {one};
}

std::vector<Vec2d> Circle(double radius) {
  std::vector<Vec2d> points;
  for (int i = 0; i <= kCircleSegments; ++i) {
    const double angle = 2.0 * kPi * i / kCircleSegments;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

// The outline of a truncated cone: the hull of its two caps.
std::vector<Vec2d> OutlineOf(const TruncatedCone& cone, const View& view) {
  std::vector<Vec2d> points;
  for (const Vec3f& point : TruncatedConeMesh(cone, kCircleSegments).positions)
    points.push_back(view(point.cast<double>()));
  return ConvexHull(std::move(points));
}

// Collects the traces of one drawing.
class Drawing {
 public:
  Drawing(const View& view, json& traces) : view_(view), traces_(traces) {}

  void Line(const std::string& name, const std::vector<Vec2d>& points, json line) {
    Add(name, points, {{"mode", "lines"}, {"line", std::move(line)}});
  }
  void Area(const std::string& name, std::vector<Vec2d> outline, const char* colour,
            const char* fill) {
    if (outline.empty()) return;
    outline.push_back(outline.front());
    Add(name, outline,
        {{"mode", "lines"},
         {"line", {{"color", colour}, {"width", 1.2}}},
         {"fill", "toself"},
         {"fillcolor", fill}});
  }
  void Add(const std::string& name, const std::vector<Vec2d>& points, json trace) {
    json x = json::array(), y = json::array();
    for (const Vec2d& point : points) {
      x.push_back(std::round(10.0 * point.x()) / 10.0);
      y.push_back(std::round(10.0 * point.y()) / 10.0);
    }
    // One entry in the legend for all traces of a name, in both drawings.
    const bool first = std::none_of(traces_.begin(), traces_.end(),
                                    [&](const json& t) { return t["name"] == name; });
    trace.update({{"type", "scatter"},
                  {"name", name},
                  {"legendgroup", name},
                  {"showlegend", first},
                  {"x", x},
                  {"y", y},
                  {"xaxis", view_.x_axis},
                  {"yaxis", view_.y_axis}});
    if (!trace.contains("hoverinfo")) trace["hoverinfo"] = "name";
    traces_.push_back(std::move(trace));
  }

 private:
  const View& view_;
  json& traces_;
};

json Dashed(const char* dash) {
  return {{"color", plot_colour::kGrey}, {"width", 1.3}, {"dash", dash}};
}

void DrawBounds(const Scenario& scenario, const View& view, double extent_mm, Drawing& drawing) {
  const RigSpec& rigs = scenario.rigs;
  const std::string radius = fmt::format("least rig radius {:g} mm", rigs.min_radius_mm);
  const std::string height = fmt::format("least rig height {:g} mm", rigs.min_height_mm);
  const std::string reach = fmt::format("greatest distance {:g} mm", rigs.max_distance_mm);
  if (view.FromAbove()) {
    drawing.Line(radius, Circle(rigs.min_radius_mm), Dashed("dash"));
  } else {
    for (const double x : {-rigs.min_radius_mm, rigs.min_radius_mm}) {
      drawing.Line(radius, {{x, rigs.min_height_mm}, {x, rigs.max_distance_mm}}, Dashed("dash"));
    }
    drawing.Line(height, {{-extent_mm, rigs.min_height_mm}, {extent_mm, rigs.min_height_mm}},
                 Dashed("dashdot"));
    drawing.Line(
        "floor",
        {{-extent_mm, -scenario.isocentre_height_mm}, {extent_mm, -scenario.isocentre_height_mm}},
        {{"color", plot_colour::kBlack}, {"width", 3}});
  }
  drawing.Line(reach, Circle(rigs.max_distance_mm), Dashed("dot"));
}

void DrawSights(const VaultSetup& setup, const std::vector<Vec3d>& centres, const View& view,
                Drawing& drawing) {
  std::vector<Vec2d> sights;
  for (const int camera : CamerasOf(setup.combination)) {
    sights.push_back(view(centres[static_cast<size_t>(camera)]));
    sights.emplace_back(0.0, 0.0);
    sights.emplace_back(std::nan(""), std::nan(""));
  }
  if (sights.empty()) return;
  drawing.Line(fmt::format("lines of sight of {}", NameOf(setup.combination)), sights,
               {{"color", plot_colour::kBlack}, {"width", 1}});
}

// The numbers of cameras that fall on one point of the paper: by it, from the lowest.
std::vector<std::string> LabelsOf(const Rig& rig, const std::vector<Vec3d>& centres,
                                  const View& view) {
  constexpr double kSame_mm = 60.0;
  std::vector<std::string> labels;
  for (size_t i = 0; i < rig.cameras.size(); ++i) {
    std::string label;
    bool named_before = false;
    for (size_t k = 0; k < rig.cameras.size(); ++k) {
      const Vec2d apart = view(centres[static_cast<size_t>(rig.cameras[i])]) -
                          view(centres[static_cast<size_t>(rig.cameras[k])]);
      if (apart.norm() > kSame_mm) continue;
      named_before = named_before || k < i;
      label += fmt::format("{}{}", label.empty() ? "" : ", ", rig.cameras[k] + 1);
    }
    labels.push_back(named_before ? "" : label);
  }
  return labels;
}

// Away from the middle, so that neither circles nor lines of sight run through a label.
std::string LabelPosition(const Vec2d& point, const View& view) {
  if (!view.FromAbove()) return "top center";
  if (std::abs(point.x()) > 2.0 * std::abs(point.y()))
    return point.x() > 0.0 ? "middle right" : "middle left";
  return point.y() > 0.0 ? "top center" : "bottom center";
}

void DrawRig(const VaultSetup& setup, const Rig& rig, const std::vector<Vec3d>& centres,
             const View& view, Drawing& drawing) {
  const std::string name =
      fmt::format("{}: {:.0f} mm over the floor, radius {:.0f} mm", rig.name,
                  setup.scenario.isocentre_height_mm + rig.height_mm, rig.radius_mm);
  const std::vector<Vec2d> outline =
      view.FromAbove()
          ? Circle(rig.radius_mm)
          : std::vector<Vec2d>{{-rig.radius_mm, rig.height_mm}, {rig.radius_mm, rig.height_mm}};
  std::vector<Vec2d> points;
  json sizes = json::array(), edges = json::array(), hover = json::array(), places = hover;
  for (const int camera : rig.cameras) {
    const bool chosen = ((setup.combination >> camera) & 1u) != 0;
    points.push_back(view(centres[static_cast<size_t>(camera)]));
    places.push_back(LabelPosition(points.back(), view));
    sizes.push_back(chosen ? 15 : 11);
    edges.push_back(chosen ? 2.5 : 0.0);
    const Vec3d& at = centres[static_cast<size_t>(camera)];
    hover.push_back(fmt::format("camera {}: x {:.0f}, y {:.0f}, z {:.0f} mm", camera + 1, at.x(),
                                at.y(), at.z()));
  }
  drawing.Line(name, outline, {{"color", rig.colour}, {"width", 2}});
  drawing.Add(name, points,
              {{"mode", "markers+text"},
               {"text", LabelsOf(rig, centres, view)},
               {"textposition", places},
               {"textfont", {{"size", 13}}},
               {"hovertext", hover},
               {"hoverinfo", "text"},
               {"cliponaxis", false},
               {"marker",
                {{"color", rig.colour},
                 {"opacity", 1},
                 {"size", sizes},
                 {"line", {{"color", plot_colour::kBlack}, {"width", edges}}}}}});
}

void DrawView(const VaultSetup& setup, const View& view, double extent_mm, json& traces) {
  Drawing drawing(view, traces);
  for (const PlacedNozzle& nozzle : setup.nozzles) {
    drawing.Area("nozzle", OutlineOf(nozzle.cylinder, view), "#6d7680", "rgba(160,168,178,0.45)");
    drawing.Area("snout", OutlineOf(nozzle.snout, view), "#6d7680", "rgba(110,118,128,0.55)");
  }
  std::vector<Vec2d> mask;
  for (const Vec3d& point : setup.mask_points) mask.push_back(view(point));
  drawing.Area("mask", ConvexHull(std::move(mask)), plot_colour::kGreen, "rgba(0,158,115,0.45)");
  DrawBounds(setup.scenario, view, extent_mm, drawing);
  const std::vector<Vec3d> centres = CameraCentres(setup.scenario, setup.placement);
  DrawSights(setup, centres, view, drawing);
  for (const Rig& rig : RigsOf(centres)) DrawRig(setup, rig, centres, view, drawing);
  drawing.Add("isocentre", {{0.0, 0.0}},
              {{"mode", "markers"},
               {"marker", {{"symbol", "cross-thin"}, {"size", 14}, {"line", {{"width", 2}}}}}});
}

double ExtentOf(const VaultSetup& setup) {
  double extent = setup.scenario.rigs.max_distance_mm;
  for (const PlacedNozzle& nozzle : setup.nozzles) {
    const Vec3d end = nozzle.cylinder.base + nozzle.cylinder.length_mm * nozzle.cylinder.axis;
    extent = std::max(extent, end.cwiseAbs().maxCoeff());
  }
  return extent + kMargin_mm;
}

json Axis(const std::string& title, double from_mm, double to_mm) {
  return {{"title", {{"text", title}}},
          {"range", {from_mm, to_mm}},
          {"constrain", "domain"},
          {"zeroline", false}};
}

}  // namespace

PlotlyFigure DrawVault(const VaultSetup& setup) {
  const double extent = ExtentOf(setup);
  const double floor = -setup.scenario.isocentre_height_mm - kMargin_mm;
  PlotlyFigure figure;
  figure.height_px = kHeight_px;
  DrawView(setup, {0, 1, "x", "y"}, extent, figure.traces);
  DrawView(setup, {0, 2, "x2", "y2"}, extent, figure.traces);
  json x = Axis("x (mm)", -extent, extent), x2 = x;
  json y = Axis("y (mm)", -extent, extent);
  json y2 = Axis("z (mm over the isocentre)", std::min(floor, -extent), extent);
  x["domain"] = {0.0, 0.46};
  x2["domain"] = {0.54, 1.0};
  x2["anchor"] = "y2";
  y["scaleanchor"] = "x";
  y2["scaleanchor"] = "x2";
  y2["anchor"] = "x2";
  figure.layout = {{"xaxis", x},
                   {"yaxis", y},
                   {"xaxis2", x2},
                   {"yaxis2", y2},
                   {"hovermode", "closest"},
                   {"legend", {{"y", 1.08}, {"font", {{"size", 12}}}}}};
  figure.layout["annotations"] = json::array();
  const std::pair<const char*, double> titles[] = {{"from above", 0.0}, {"from the side", 0.54}};
  for (const auto& [title, at] : titles) {
    figure.layout["annotations"].push_back({{"text", fmt::format("<b>{}</b>", title)},
                                            {"x", at},
                                            {"y", 1.0},
                                            {"xref", "paper"},
                                            {"yref", "paper"},
                                            {"xanchor", "left"},
                                            {"yanchor", "bottom"},
                                            {"showarrow", false}});
  }
  return figure;
}

}  // namespace retrolux
