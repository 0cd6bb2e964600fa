// Names for content: a 64-bit FNV-1a hash, for provenance and for seeds; not for secrets.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace retrolux {

constexpr uint64_t HashBytes(std::string_view bytes, uint64_t hash = 0xcbf29ce484222325ULL) {
  for (const char c : bytes) {
    hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

// 16 hexadecimal digits.
std::string HexHash(uint64_t hash);

}  // namespace retrolux
