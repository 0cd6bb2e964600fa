#include "analysis/base64.h"

#include <zlib.h>

#include <bit>
#include <cstdint>

#include "core/error.h"

namespace retrolux {

static_assert(std::endian::native == std::endian::little);

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    }
    for (size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

std::string Deflated(std::span<const float> values) {
  const auto size = static_cast<uLong>(values.size_bytes());
  std::string packed(compressBound(size), '\0');
  uLongf packed_size = packed.size();
  const int result =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size,
                reinterpret_cast<const Bytef*>(values.data()), size, Z_DEFAULT_COMPRESSION);
  RETROLUX_CHECK(result == Z_OK, "zlib: {}", result);
  packed.resize(packed_size);
  return packed;
}

}  // namespace retrolux
