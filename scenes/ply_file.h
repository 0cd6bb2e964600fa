// PLY files, read by ourselves: the reader of Debian 12's Assimp (5.2.5) hangs on damaged headers
// and crashes on damaged bodies.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/mesh.h"

namespace retrolux {

// `bytes` is what the file holds, ASCII or binary of either byte order; `file` is for messages.
// Of the element `vertex` the properties x y z and, if there, nx ny nz; of the element `face` the
// list vertex_indices (or vertex_index), polygons cut into a fan of triangles. All else is skipped.
// A file without faces is a point cloud. Coordinates are as in the file: no unit, not checked to be
// finite. InputError for anything that the format does not allow, or that is not there.
TriangleMesh ReadPly(const std::filesystem::path& file, const std::string& bytes);

}  // namespace retrolux
