// Points for Monte Carlo integration: padded, Owen-scrambled Sobol' points, keyed by pixel and
// sample.
//
// Dimensions are handed out in pairs; each pair is the (0, 2)-sequence of Sobol's first two
// dimensions with its own scramble and its own shuffled order of samples (Burley, "Practical
// hash-based Owen scrambling", JCGT 9(4), 2020). The first 2^k samples of a pixel are stratified in
// every pair and in every single dimension.
#pragma once

#include "core/conventions.h"
#include "core/rng.h"

namespace retrolux {

namespace sobol {

constexpr uint32_t ReverseBits(uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Owen scrambling of a bit-reversed number by a hash (Laine and Karras 2011, constants of Vegdahl
// 2021).
constexpr uint32_t LaineKarras(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

constexpr uint32_t OwenScramble(uint32_t x, uint32_t seed) {
  return ReverseBits(LaineKarras(ReverseBits(x), seed));
}

// Second dimension of the Sobol' sequence of an index given bit-reversed: the product with the
// Pascal matrix modulo 2, which is a Kronecker power of [[1, 1], [0, 1]] and so takes five steps.
constexpr uint32_t SecondDimension(uint32_t reversed_index) {
  uint32_t x = reversed_index;
  x ^= (x << 16) & 0xffff0000u;
  x ^= (x << 8) & 0xff00ff00u;
  x ^= (x << 4) & 0xf0f0f0f0u;
  x ^= (x << 2) & 0xccccccccu;
  x ^= (x << 1) & 0xaaaaaaaau;
  return x;
}

}  // namespace sobol

class PixelSampler {
 public:
  // `pixel_key` names seed, image and pixel; `sample` counts the samples of the pixel.
  PixelSampler(uint64_t pixel_key, uint32_t sample) : pixel_key_(pixel_key), sample_(sample) {}

  Vec2f Next2D() {
    const uint64_t key = Mix64(pixel_key_ + ++pair_);
    const uint64_t seeds = Mix64(key);
    const uint32_t index = sobol::OwenScramble(sample_, static_cast<uint32_t>(key));
    const uint32_t reversed = sobol::ReverseBits(index);
    const uint32_t first = sobol::OwenScramble(reversed, static_cast<uint32_t>(seeds));
    const uint32_t second =
        sobol::OwenScramble(sobol::SecondDimension(reversed), static_cast<uint32_t>(seeds >> 32));
    return {UnitFloat(first), UnitFloat(second)};
  }

  float Next1D() {
    const uint64_t key = Mix64(pixel_key_ + ++pair_);
    const uint32_t index = sobol::OwenScramble(sample_, static_cast<uint32_t>(key));
    return UnitFloat(
        sobol::OwenScramble(sobol::ReverseBits(index), static_cast<uint32_t>(key >> 32)));
  }

 private:
  uint64_t pixel_key_;
  uint32_t sample_;
  uint32_t pair_ = 0;
};

}  // namespace retrolux
