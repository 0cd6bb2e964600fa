// Scenes as files: scene.json (schema scenes/schema/scene-1.schema.json, comments allowed) with its
// geometry in glTF.
#pragma once

#include <filesystem>

#include "scenes/scene.h"

namespace retrolux {

// A built-in scene by name, or the scene.json at a path (or in the folder of that path).
Scene LoadScene(const std::string& name_or_path);

Scene ReadSceneFile(const std::filesystem::path& file);

// Writes scene.json and NAME.glb into `folder`; reading them back gives the same scene.
void ExportScene(const Scene& scene, const std::filesystem::path& folder);

// 16 hex digits over all that the renderer reads, geometry included.
std::string SceneHash(const Scene& scene);

}  // namespace retrolux
