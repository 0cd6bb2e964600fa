// The masks that come with the program: a face, a torso, the oval of the CT study, a sphere. All
// are surfaces as a camera sees them, the outer side only, counter-clockwise seen from outside,
// with vertex normals. Formulas and assumptions: docs/masks.md.
//
// Frame of a mask: z up, y = z x x, origin at the isocentre inside the patient.
// To add one: a function that returns its mesh and a row in the table of masks.cpp.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

// A thermoplastic face mask: half an ellipsoid with brow, eye sockets, nose, lips and chin.
struct FaceShape {
  double area_mm2 = 76459.0;  // of all triangles; the shape is scaled to it
  // Scales all features, 0 to 1.5; 0: the plain half-ellipsoid, 1: a bare face. A mask drawn over
  // it bridges its hollows.
  double relief = 0.75;
  int rows = 62;     // vertices from below the chin to the top of the head
  int columns = 41;  // vertices across, odd
};

// The face looks along +x, the top of the head is at +z, y is to the patient's left. An open shell,
// its own mirror image in y. By default 62 x 41 = 2,542 vertices.
TriangleMesh FaceMask(const FaceShape& shape = {});

// The front of a lying patient's trunk, from below the collar bones to the pelvis: 450 mm along x
// (feet towards +x), 360 mm wide, 110 mm deep, face up (+z). An open shell of 61 x 41 vertices, its
// own mirror image in y.
TriangleMesh BodyMask();

struct MaskEntry {
  const char* name;
  const char* description;
  TriangleMesh (*make)();
};

const std::vector<MaskEntry>& Masks();
std::vector<std::string> MaskNames();

// InputError with the nearest name, or all of them.
TriangleMesh MakeMask(const std::string& name);

}  // namespace retrolux
