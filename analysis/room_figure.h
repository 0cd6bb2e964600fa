// A room in three dimensions for Report::Room: cameras with their rings and fields of view, the
// things that stand around, the mask coloured by a number for each of its triangles.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace retrolux {

struct RoomState {
  std::string label;                                // e.g. of a pose
  nlohmann::json traces = nlohmann::json::array();  // of plotly, world frame, mm
};

struct RoomFigure {
  nlohmann::json traces = nlohmann::json::array();  // what all states have in common
  std::string choice = "State";                     // what the states are
  std::vector<RoomState> states;                    // at least one
  Vec3d up = Vec3d::UnitZ();
  Vec3d eye = Vec3d(1.2, 1.2, 0.8);  // of the first view, in units of the room's size (plotly's)
};

// What a triangle's number means: 0 to `most`, shown with `title` beside the scale.
struct TriangleNumbers {
  std::string title;
  int most = 1;
  std::vector<int> numbers;  // a triangle each
};

// For each triangle of the object how many cameras see its middle: it lies in the picture, faces
// the camera, and nothing is between.
TriangleNumbers CamerasThatSee(const Scene& scene, const std::string& object_name);

// A scene in one of the states, and what colours its object `coloured`.
struct RoomScene {
  std::string label;
  Scene scene;
  TriangleNumbers numbers;
};

// Things that stand alike in all of `scenes` are drawn once, cameras too if none of them moves;
// what is larger than 3.5 m (walls, floor, ceiling) is left out. The object `coloured` must be in
// all scenes.
RoomFigure DrawRoom(const std::string& choice, const std::vector<RoomScene>& scenes,
                    const std::string& coloured = "mask");

}  // namespace retrolux
