// The family 36h11 with AprilTag's own library (Olson 2011; Wang and Olson 2016), version 3.
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <memory>

#include "classifier/tag_libraries.h"

namespace retrolux {

namespace {

// Of one thread: a detector holds the tables of its family, and works on one picture at a time.
class Detector {
 public:
  Detector(float decimate, bool refine_edges)
      : family_(tag36h11_create(), tag36h11_destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    apriltag_detector_add_family(detector_.get(), family_.get());
    detector_->nthreads = 1;
    detector_->quad_decimate = decimate;
    detector_->refine_edges = refine_edges;
  }

  std::vector<FoundTag> Find(const DigitalImage& image) {
    Plane<uint8_t> grey = EightBits(image);
    image_u8_t view{grey.width, grey.height, grey.width, grey.data.data()};
    const std::unique_ptr<zarray_t, void (*)(zarray_t*)> found(
        apriltag_detector_detect(detector_.get(), &view), apriltag_detections_destroy);
    std::vector<FoundTag> tags;
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(found.get(), i, &detection);
      FoundTag tag{detection->id, {}};
      for (size_t k = 0; k < 4; ++k) {
        const double* p = detection->p[k];
        tag.corners_px[k] = Vec2d(p[0], p[1]) + kCentreFromCorner;
      }
      tags.push_back(tag);
    }
    return tags;
  }

 private:
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_;
};

template <int kDecimate, bool kRefine>
std::vector<FoundTag> Find(const DigitalImage& image) {
  static thread_local Detector detector(static_cast<float>(kDecimate), kRefine);
  return detector.Find(image);
}

Plane<uint8_t> Pattern(int id) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  const std::unique_ptr<image_u8_t, void (*)(image_u8_t*)> image(
      apriltag_to_image(family.get(), id), image_u8_destroy);
  Plane<uint8_t> cells(image->width, image->height);
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) cells(x, y) = image->buf[y * image->stride + x] != 0;
  }
  return cells;
}

}  // namespace

TagFamily AprilTag36h11() {
  return {"apriltag36h11",
          587,
          10,
          Pattern,
          {{"full size, edges refined", Find<1, true>},
           {"as the library: half size, edges refined", Find<2, true>},
           {"full size, not refined", Find<1, false>}}};
}

}  // namespace retrolux
