// Square tags of public families and the detectors of others that find them: witnesses for our
// pictures (docs/witness.md). Patterns come from the libraries, which are optional: a family is
// there if its library was when this was built. To add one: a file like aruco_tags.cpp, its
// declaration and its row in tags.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "classifier/detection.h"
#include "core/marker_set.h"
#include "core/plane.h"

namespace retrolux {

// A tag in the picture's pixels: (0, 0) is the centre of the top-left pixel, y down.
struct FoundTag {
  int id = 0;
  // Of the dark square, where it meets the quiet zone: from the lower left one of the upright tag
  // on, counter-clockwise for who looks at the picture.
  std::array<Vec2d, 4> corners_px;
};

// A way to look for the tags of a family. Pictures of more than 8 bits are cut to 8. The same
// result each time, from several threads at once.
struct TagFinder {
  std::string name;  // what is set otherwise than the library does
  std::function<std::vector<FoundTag>(const DigitalImage&)> find;
};

struct TagFamily {
  std::string name;
  int count = 0;  // ids are 0 .. count - 1
  int cells = 0;  // along the side of a tag, the quiet zone of one cell included
  // cells x cells, 1 where bright, as one sees the tag upright.
  std::function<Plane<uint8_t>(int id)> pattern;
  std::vector<TagFinder> finders;  // the first is the identification method's
};

const std::vector<TagFamily>& TagFamilies();
// Null if it is not there.
const TagFamily* FindTagFamily(const std::string& name);

// Where a tag lies in its marker, mm: the corners of its dark square in the order of FoundTag.
std::array<Vec2d, 4> DarkSquare(const TagFamily& family, double size_mm);

// A marker set of tags `size_mm` wide, quiet zone included. The number of a tag is its id, its name
// FAMILY-ID. InputError for ids out of range; 0 is the standard marker's number.
MarkerSet MakeTagSet(const TagFamily& family, const std::vector<int>& ids, double size_mm);

// The tags that the set has by their names; others have no name. corners_px are those of the whole
// square and centre_px its middle, by the homography of the dark square's corners: exact for a flat
// tag. centroid_px: of the square's area. confidence is 1: the libraries give no probability.
// `debug`, if not null: a folder for tags.png, the picture with the dark squares and ids.
// InputError if the set has no tag of the family.
std::vector<Detection> IdentifyTags(const TagFamily& family, const DigitalImage& image,
                                    const MarkerSet& markers,
                                    const std::filesystem::path* debug = nullptr);

// For the families' own files: the picture as the libraries want it.
Plane<uint8_t> EightBits(const DigitalImage& image);

}  // namespace retrolux
