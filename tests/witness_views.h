// Pictures of square tags, rendered and drawn, with the true corners of their dark squares: what
// the detectors of others are shown (docs/witness.md).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "classifier/error_statistics.h"
#include "classifier/tags.h"

namespace retrolux {

enum class TagGround {
  kPanel,  // flat, matt, reflectance 0.04
  kOval,   // the mask
};

// One tag before one camera with the thesis's optics (3000 px), in the light of its own ring.
struct TagView {
  const TagFamily* family = nullptr;
  int id = 1;
  double size_mm = 30.0;  // quiet zone included
  TagGround ground = TagGround::kPanel;
  std::string sheeting = "retro_bead_wide";
  double distance_mm = 1600.0;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;      // of the camera around the tag's normal
  double tag_roll_deg = 0.0;     // about its normal
  double camera_roll_deg = 0.0;  // about its axis
  Vec2d at_px{319.5, 239.5};     // where the tag's middle is in a picture of 640 x 480 px
  double distortion_k1 = 0.0;
  double full_scales = 0.7;  // that frontal sheeting at this distance reaches
  bool blooming = false;     // whether charge beyond the full well flows along the column
  double blur_px = 0.0;      // diameter of the disc that an unsharp lens makes of a point
  uint64_t seed = 1;         // of paths, noise and the pixels' pattern

  double FrontalCell_px() const;
};

// `count` views that differ in id, rolls, azimuth and place in the frame, at random (keyed by
// `seed`), and are as `like` otherwise.
std::vector<TagView> RandomViews(const TagView& like, int count, uint64_t seed);

struct TagPicture {
  DigitalImage image;               // the part of the picture around the tag
  std::array<Vec2d, 4> corners_px;  // in `image`, of the dark square, as in FoundTag
  Vec2d middle_px = Vec2d::Zero();  // of the tag
  Vec2d tilt = Vec2d::Zero();       // unit; the way that the normal points in the picture
  double contrast_dn = 0.0;         // bright cells less ground, noiseless
  double snr = 0.0;                 // the same over the noise of one bright pixel (EMVA 1288)
};

// By path tracer and sensor, sparsely as the pictures of datasets.
TagPicture RenderTag(const TagView& view);

// The flat tag without anything of the renderer (tests/drawn_markers.h): even light, exact areas,
// noise as the default sensor's. No distortion; of `at_px` only what lies behind the point counts.
TagPicture DrawTag(const TagView& view, double contrast_dn, double ground_dn);

// What a finder made of pictures of one tag each.
struct WitnessResult {
  int pictures = 0;
  int found = 0;  // with the right id
  int wrong = 0;  // tags that are not there
  PlaceErrors corners;
  // Of the means over a tag's four corners, which are independent of one another: px along the
  // picture's axes, away from the tag's middle, and along the tilt (of tags tilted by 10 degrees
  // and more).
  ScalarErrors u, v, outward, tilt;
  double contrast_dn = 0.0, snr = 0.0;  // means
};
WitnessResult Witness(const TagFinder& finder, const std::vector<TagView>& views,
                      const std::vector<TagPicture>& pictures);

}  // namespace retrolux
