// Meshes and point clouds that the user brings: glTF (.glb, .gltf), PLY, OBJ, STL, and points as
// text. All functions throw InputError, with the file's name, for what can't be used: unreadable or
// damaged files, unknown extensions, coordinates that are no finite numbers, no triangles, no area.
//
// Axes: glTF is y up by definition and becomes z up (gltf.h); the other formats do not say, and
// their axes are taken as ours.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

enum class LengthUnit { kMillimetre, kCentimetre, kMetre };

// "mm", "cm" or "m".
LengthUnit ParseLengthUnit(const std::string& name);

// By its extension.
bool IsGltf(const std::filesystem::path& file);

// All triangles of the file as one mesh, in mm; polygons are cut into triangles, lines and points
// left out. Vertices that agree in every bit are one. Normals are kept if all vertices have them;
// those of STL are its facets' and are not, so that its loose triangles hang together. A glTF file
// is in metres by definition: another unit is an InputError.
TriangleMesh ImportMesh(const std::filesystem::path& file, LengthUnit unit);

// The vertices of a mesh or point cloud file (the formats of ImportMesh), or of a text file (.xyz,
// .txt): x y z on each line, or six columns with a normal, which is ignored, separated by blanks,
// tabs, commas or semicolons; # begins a comment. In mm.
std::vector<Vec3f> ReadPointCloud(const std::filesystem::path& file, LengthUnit unit);

}  // namespace retrolux
