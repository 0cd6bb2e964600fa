// The sets that a mask shows to cameras, each made once. What hides a part of the mask from a
// camera is the mask itself (kept here, in the mask's frame) or a nozzle (taken out by the caller),
// so one set serves every placement and orientation that puts a camera to the same place of the
// mask, in rooms with one beam and with two.
#pragma once

#include <atomic>
#include <memory>

#include "analysis/visibility.h"
#include "scenes/rig_layout.h"

namespace retrolux {

class VisibilityStore {
 public:
  // Keeps sets of at most `max_bytes` in all; further ones are made anew each time. `mask` must
  // outlive it.
  explicit VisibilityStore(const Mask& mask, size_t max_bytes = size_t{1} << 30);
  ~VisibilityStore();
  VisibilityStore(const VisibilityStore&) = delete;
  VisibilityStore& operator=(const VisibilityStore&) = delete;

  const Mask& TheMask() const { return mask_; }

  // What the camera at `centre` (world) sees of the turned mask, nozzles aside. From any thread;
  // the same bits whoever asks first: the camera is rounded (to 1e-6 mm) before it looks.
  std::shared_ptr<const SampleSet> SeenBy(const Scenario& scenario, const Vec3d& centre,
                                          const Mat3d& world_from_mask);

  int64_t Made() const { return made_; }  // id buffers rendered
  int64_t Asked() const { return asked_; }

 private:
  struct Sets;
  const Mask& mask_;
  size_t max_bytes_;
  std::unique_ptr<Sets> sets_;
  std::atomic<int64_t> made_ = 0, asked_ = 0;
};

}  // namespace retrolux
