// What each library's file gives to the table of tags.cpp.
#pragma once

#include "classifier/tags.h"

namespace retrolux {

// AprilTag's code counts pixels from the corner of the top-left one (measured: docs/witness.md; its
// authors say so in issue 121 of the library).
inline const Vec2d kCentreFromCorner(-0.5, -0.5);

TagFamily AprilTag36h11();  // april_tags.cpp, libapriltag
TagFamily Aruco4x4();       // aruco_tags.cpp, OpenCV's aruco (DICT_4X4_50)

}  // namespace retrolux
