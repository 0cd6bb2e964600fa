#include "analysis/room_figure.h"

#include <algorithm>
#include <cmath>

#include "analysis/plotly_figure.h"
#include "analysis/report.h"
#include "core/error.h"
#include "core/parallel.h"
#include "renderer/marker_truth.h"

namespace retrolux {

using nlohmann::json;

namespace {

// Tenths of a millimetre: finer than any screen, and short to write.
double Rounded(double mm) {
  return std::round(10.0 * mm) / 10.0;
}

// Lines in space as plotly's: a gap (null) after each.
struct Lines {
  json x = json::array(), y = json::array(), z = json::array();

  void Add(const std::vector<Vec3d>& points) {
    for (const Vec3d& p : points) {
      x.push_back(Rounded(p.x()));
      y.push_back(Rounded(p.y()));
      z.push_back(Rounded(p.z()));
    }
    for (json* axis : {&x, &y, &z}) axis->push_back(nullptr);
  }

  json Trace(const std::string& name, const char* colour, double width) const {
    return {{"type", "scatter3d"},
            {"mode", "lines"},
            {"name", name},
            {"showlegend", true},
            {"hoverinfo", "skip"},
            {"x", x},
            {"y", y},
            {"z", z},
            {"line", {{"color", colour}, {"width", width}}}};
  }
};

json MeshTrace(const SceneObject& object) {
  json x = json::array(), y = json::array(), z = json::array();
  for (const Vec3f& position : object.mesh.positions) {
    const Vec3d p = object.world_from_object * position.cast<double>();
    x.push_back(Rounded(p.x()));
    y.push_back(Rounded(p.y()));
    z.push_back(Rounded(p.z()));
  }
  json i = json::array(), j = json::array(), k = json::array();
  for (const auto& triangle : object.mesh.triangles) {
    i.push_back(triangle[0]);
    j.push_back(triangle[1]);
    k.push_back(triangle[2]);
  }
  return {{"type", "mesh3d"},  {"name", object.name}, {"x", std::move(x)},
          {"y", std::move(y)}, {"z", std::move(z)},   {"i", std::move(i)},
          {"j", std::move(j)}, {"k", std::move(k)},   {"flatshading", true}};
}

// Walls, floor and ceiling hide more than they show.
bool IsTheRoomItself(const SceneObject& object) {
  constexpr float kRoom_mm = 3500.0f;
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : object.mesh.positions) box.extend(p);
  return box.diagonal().norm() > kRoom_mm;
}

// Things around the patient: grey, seen through, one entry of the legend to take them all away.
json BystanderTrace(const SceneObject& object, bool in_legend) {
  json trace = MeshTrace(object);
  trace["name"] = "things around";
  trace["legendgroup"] = "things around";
  trace["showlegend"] = in_legend;
  trace["color"] = plot_colour::kGrey;
  trace["opacity"] = 0.35;
  trace["hovertemplate"] = object.name + "<extra></extra>";
  return trace;
}

// Stepped, so that each number has one colour, with its name in the middle of the step.
json ColouredTrace(const SceneObject& object, const TriangleNumbers& numbers) {
  RETROLUX_CHECK(numbers.numbers.size() == object.mesh.triangles.size(), "{} numbers",
                 numbers.numbers.size());
  std::vector<OvalCategory> colours = CountCategories(numbers.most);
  colours[0].colour = "#d8dce1";  // white would be lost on the page
  json scale = json::array(), ticks = json::array();
  const auto steps = static_cast<double>(colours.size());
  for (size_t c = 0; c < colours.size(); ++c) {
    const auto from = static_cast<double>(c);
    scale.push_back({from / steps, colours[c].colour});
    scale.push_back({(from + 1.0) / steps, colours[c].colour});
    ticks.push_back(c);
  }
  json trace = MeshTrace(object);
  trace.update(
      {{"intensity", numbers.numbers},
       {"intensitymode", "cell"},
       {"cmin", -0.5},
       {"cmax", numbers.most + 0.5},
       {"colorscale", std::move(scale)},
       {"lighting", {{"ambient", 0.75}, {"diffuse", 0.4}, {"specular", 0.0}}},
       {"colorbar",
        {{"title", {{"text", numbers.title}, {"side", "right"}}},
         {"tickvals", std::move(ticks)},
         {"thickness", 14},
         {"len", 0.6}}},
       {"hovertemplate", object.name + "<br>x %{x} mm, y %{y} mm, z %{z} mm<extra></extra>"}});
  return trace;
}

// The corners of the picture as directions, and the middle of what the cameras look at as depth.
std::vector<Vec3d> FrustumCorners(const CameraModel& camera, double reach_mm) {
  std::vector<Vec3d> corners;
  for (const Vec2d& px :
       {Vec2d(0, 0), Vec2d(camera.width - 1, 0), Vec2d(camera.width - 1, camera.height - 1),
        Vec2d(0, camera.height - 1)}) {
    const Ray ray = camera.RayThrough(px);
    corners.push_back(ray.origin +
                      ray.direction * (reach_mm / ray.direction.dot(camera.Forward())));
  }
  return corners;
}

void AddFrustum(const CameraModel& camera, double reach_mm, Lines& lines) {
  std::vector<Vec3d> corners = FrustumCorners(camera, reach_mm);
  for (const Vec3d& corner : corners) lines.Add({camera.Centre(), corner});
  corners.push_back(corners.front());
  lines.Add(corners);
}

void AddRing(const CameraSpec& camera, Lines& lines) {
  if (!camera.ring) return;
  std::vector<Vec3d> circle;
  for (int led = 0; led <= camera.ring->count; ++led)
    circle.push_back(LedCentre(camera, led % camera.ring->count));
  lines.Add(circle);
}

json NamesTrace(const std::vector<CameraSpec>& cameras) {
  json x = json::array(), y = json::array(), z = json::array(), names = json::array();
  for (const CameraSpec& camera : cameras) {
    const Vec3d c = camera.model.Centre();
    x.push_back(Rounded(c.x()));
    y.push_back(Rounded(c.y()));
    z.push_back(Rounded(c.z()));
    names.push_back(camera.model.name);
  }
  return {{"type", "scatter3d"},
          {"mode", "markers+text"},
          {"name", "cameras"},
          {"showlegend", true},
          {"x", x},
          {"y", y},
          {"z", z},
          {"text", names},
          {"textposition", "top center"},
          {"textfont", {{"size", 11}}},
          {"marker", {{"size", 4}, {"color", plot_colour::kBlack}}},
          {"hovertemplate", "%{text}<br>x %{x} mm, y %{y} mm, z %{z} mm<extra></extra>"}};
}

// Where the scene's markers were put, by name.
json MarkersTrace(const Scene& scene) {
  json x = json::array(), y = json::array(), z = json::array(), names = json::array();
  for (const MarkerSpec& marker : scene.markers) {
    const Vec3d p = scene.Object(marker.object).world_from_object * marker.at;
    x.push_back(Rounded(p.x()));
    y.push_back(Rounded(p.y()));
    z.push_back(Rounded(p.z()));
    names.push_back(marker.name);
  }
  return {{"type", "scatter3d"},
          {"mode", "markers"},
          {"name", "markers"},
          {"showlegend", true},
          {"x", x},
          {"y", y},
          {"z", z},
          {"text", names},
          {"marker", {{"size", 5}, {"symbol", "diamond"}, {"color", plot_colour::kVermillion}}},
          {"hovertemplate", "%{text}<br>x %{x} mm, y %{y} mm, z %{z} mm<extra></extra>"}};
}

// Fields of view end at the plane through `target`.
void AddCameras(const Scene& scene, const Vec3d& target, json& traces) {
  constexpr double kBody_mm = 150.0;
  Lines bodies, fields, rings;
  for (const CameraSpec& camera : scene.cameras) {
    const double depth = camera.model.Forward().dot(target - camera.model.Centre());
    AddFrustum(camera.model, kBody_mm, bodies);
    if (depth > kBody_mm) AddFrustum(camera.model, depth, fields);
    AddRing(camera, rings);
  }
  traces.push_back(NamesTrace(scene.cameras));
  traces.push_back(bodies.Trace("camera bodies", plot_colour::kBlack, 3.0));
  traces.push_back(rings.Trace("diode rings", plot_colour::kVermillion, 4.0));
  traces.push_back(fields.Trace("fields of view", plot_colour::kSky, 1.5));
}

bool StandsAlike(const SceneObject& a, const SceneObject& b) {
  return a.name == b.name && a.mesh.positions == b.mesh.positions &&
         a.mesh.triangles == b.mesh.triangles &&
         a.world_from_object.rotation == b.world_from_object.rotation &&
         a.world_from_object.translation == b.world_from_object.translation;
}

bool StandsInAll(const SceneObject& object, const std::vector<RoomScene>& scenes) {
  return std::all_of(scenes.begin(), scenes.end(), [&](const RoomScene& other) {
    return std::any_of(other.scene.objects.begin(), other.scene.objects.end(),
                       [&](const SceneObject& o) { return StandsAlike(object, o); });
  });
}

bool SameCameras(const std::vector<RoomScene>& scenes) {
  const auto places = [](const Scene& scene) {
    std::vector<std::array<double, 3>> centres;
    for (const CameraSpec& camera : scene.cameras) {
      const Vec3d c = camera.model.Centre();
      centres.push_back({c.x(), c.y(), c.z()});
    }
    return centres;
  };
  return std::all_of(scenes.begin(), scenes.end(), [&](const RoomScene& other) {
    return places(other.scene) == places(scenes.front().scene);
  });
}

Vec3d UpOf(UpAxis axis) {
  return axis == UpAxis::kX ? Vec3d::UnitX() : Vec3d::UnitZ();
}

Vec3d MiddleOf(const SceneObject& object) {
  Eigen::AlignedBox3d box;
  for (const Vec3f& p : object.mesh.positions)
    box.extend(object.world_from_object * p.cast<double>());
  return box.center();
}

}  // namespace

TriangleNumbers CamerasThatSee(const Scene& scene, const std::string& object_name) {
  const SceneObject& object = scene.Object(object_name);
  const RayScene rays(scene);
  TriangleNumbers seen{"cameras that see it", static_cast<int>(scene.cameras.size()), {}};
  seen.numbers.resize(object.mesh.triangles.size());
  ParallelFor(static_cast<int64_t>(seen.numbers.size()), [&](int64_t i) {
    const auto& triangle = object.mesh.triangles[static_cast<size_t>(i)];
    std::array<Vec3d, 3> corner;
    for (size_t k = 0; k < 3; ++k)
      corner[k] = object.world_from_object * object.mesh.positions[triangle[k]].cast<double>();
    const Vec3d middle = (corner[0] + corner[1] + corner[2]) / 3.0;
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    for (const CameraSpec& camera : scene.cameras)
      seen.numbers[static_cast<size_t>(i)] += IsSeen(rays, camera.model, middle, normal) ? 1 : 0;
  });
  return seen;
}

RoomFigure DrawRoom(const std::string& choice, const std::vector<RoomScene>& scenes,
                    const std::string& coloured) {
  RETROLUX_CHECK(!scenes.empty(), "a room without a state");
  const Scene& first = scenes.front().scene;
  RoomFigure figure;
  figure.choice = choice;
  figure.up = UpOf(first.up_axis);
  figure.eye = 1.0 * figure.up + 1.5 * figure.up.unitOrthogonal() +
               0.8 * figure.up.cross(figure.up.unitOrthogonal());
  const bool same_cameras = SameCameras(scenes);
  for (const SceneObject& object : first.objects) {
    if (object.name != coloured && !IsTheRoomItself(object) && StandsInAll(object, scenes))
      figure.traces.push_back(BystanderTrace(object, figure.traces.empty()));
  }
  if (same_cameras) AddCameras(first, MiddleOf(first.Object(coloured)), figure.traces);
  for (const RoomScene& state : scenes) {
    RoomState& drawn = figure.states.emplace_back(RoomState{state.label});
    const SceneObject& centre = state.scene.Object(coloured);
    drawn.traces.push_back(ColouredTrace(centre, state.numbers));
    for (const SceneObject& object : state.scene.objects) {
      if (object.name != coloured && !IsTheRoomItself(object) && !StandsInAll(object, scenes))
        drawn.traces.push_back(BystanderTrace(object, false));
    }
    if (!state.scene.markers.empty()) drawn.traces.push_back(MarkersTrace(state.scene));
    if (!same_cameras) AddCameras(state.scene, MiddleOf(centre), drawn.traces);
  }
  return figure;
}

}  // namespace retrolux
