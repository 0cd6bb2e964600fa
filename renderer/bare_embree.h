// Embree alone, with its default flags and nothing done with what is hit: the limit that the rates
// of our own passes are held against.
#pragma once

#include <memory>
#include <span>

#include "scenes/scene.h"

namespace retrolux {

class BareEmbree {
 public:
  // The objects of the scene, without its lights.
  explicit BareEmbree(const Scene& scene);
  ~BareEmbree();
  BareEmbree(BareEmbree&&) noexcept;
  BareEmbree& operator=(BareEmbree&&) noexcept;

  // How many rays from `origin` along `directions` hit something: one by one, or in packets of 16
  // (the number of directions must be a multiple of 16).
  int Hits(const Vec3f& origin, std::span<const Vec3f> directions) const;
  int HitsInPackets(const Vec3f& origin, std::span<const Vec3f> directions) const;
  // How many of the ways from `origin` along `directions`, to their ends, are blocked.
  int Blocked(const Vec3f& origin, std::span<const Vec3f> directions) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace retrolux
