// Random numbers from keys, not from state: any number can be made alone, in any order, by any
// thread.
#pragma once

#include <cstdint>

namespace retrolux {

// A bijective mixing of 64 bits (the finaliser of SplitMix64; Steele, Lea, Flood 2014).
constexpr uint64_t Mix64(uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

constexpr uint64_t CombineKeys(uint64_t a, uint64_t b) {
  return Mix64(a ^ Mix64(b));
}

// [0, 1) with 24 bits, so that it never rounds up to 1.
constexpr float UnitFloat(uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

// [0, 1) with 53 bits.
constexpr double UnitDouble(uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

// A stream of independent numbers that belongs to one key.
class KeyedRng {
 public:
  explicit constexpr KeyedRng(uint64_t key) : key_(key) {}

  constexpr uint64_t NextBits() { return Mix64(key_ + 0x9e3779b97f4a7c15ULL * counter_++); }
  constexpr double NextDouble() { return UnitDouble(NextBits()); }
  constexpr float NextFloat() { return UnitFloat(static_cast<uint32_t>(NextBits() >> 32)); }

 private:
  uint64_t key_;
  uint64_t counter_ = 1;
};

}  // namespace retrolux
