// Bytes as text that a page can carry.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace retrolux {

std::string Base64(std::string_view bytes);

// The values' bytes (32-bit floats, little-endian) compressed in zlib's format (RFC 1950).
std::string Deflated(std::span<const float> values);

}  // namespace retrolux
