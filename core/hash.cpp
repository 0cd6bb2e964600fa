#include "core/hash.h"

#include <fmt/format.h>

namespace retrolux {

std::string HexHash(uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

}  // namespace retrolux
