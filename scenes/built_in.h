// The scenes that come with the program, by name. To add one: a function that returns a Scene and a
// row in the table of built_in.cpp.
#pragma once

#include "scenes/scene.h"

namespace retrolux {

struct BuiltInEntry {
  const char* name;
  const char* description;
  Scene (*make)();
};

const std::vector<BuiltInEntry>& BuiltInScenes();

// InputError that lists the names.
Scene BuiltInScene(const std::string& name);

// The rooms and masks behind the names.
Scene CtRoom();
Scene OvalScene();
Scene SphereScene();
Scene FaceScene();
Scene BodyScene();
Scene VaultRoom();
// For measuring.
Scene ChessboardScene();
Scene FlatFieldScene();
Scene GoniometerScene();

}  // namespace retrolux
