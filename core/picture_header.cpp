#include "core/picture_header.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace retrolux {

namespace {

using Bytes = std::string_view;

uint8_t Byte(Bytes bytes, size_t at) {
  return static_cast<uint8_t>(bytes[at]);
}

uint32_t BigEndian(Bytes bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | Byte(bytes, at + i);
  return value;
}

uint32_t LittleEndian32(Bytes bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 4; i-- > 0;) value = value << 8 | Byte(bytes, at + i);
  return value;
}

// IHDR comes first.
std::optional<uint64_t> PngPixels(Bytes bytes) {
  if (bytes.size() < 24) return std::nullopt;
  return uint64_t{BigEndian(bytes, 16, 4)} * BigEndian(bytes, 20, 4);
}

// In the start of the frame, wherever that is.
std::optional<uint64_t> JpegPixels(Bytes bytes) {
  for (size_t at = 2; at + 9 <= bytes.size();) {
    const uint8_t marker = Byte(bytes, at + 1);
    if (Byte(bytes, at) != 0xFF) return std::nullopt;
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) return uint64_t{BigEndian(bytes, at + 5, 2)} * BigEndian(bytes, at + 7, 2);
    at += marker == 0xFF ? 1 : 2 + BigEndian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

// The largest data window of its attributes: name, type, length, value; names of 255 bytes at most.
std::optional<uint64_t> ExrPixels(Bytes bytes) {
  uint64_t pixels = 0;
  const auto text_at = [&](size_t at) {
    const size_t end = bytes.find('\0', at);
    return end == Bytes::npos ? Bytes() : bytes.substr(at, end - at);
  };
  for (size_t at = 8; at < bytes.size();) {
    const Bytes name = text_at(at);
    if (name.empty()) {  // the end of a part's header, or of all
      if (++at >= bytes.size() || Byte(bytes, at) == 0) break;
      if (pixels > 0 && (Byte(bytes, 5) & 0x10) == 0) break;
      continue;
    }
    const Bytes type = text_at(at + name.size() + 1);
    const size_t value = at + name.size() + type.size() + 6;
    if (type.empty() || value > bytes.size()) return std::nullopt;
    const size_t length = LittleEndian32(bytes, value - 4);
    if (length > bytes.size() - value) return std::nullopt;
    if (name == "dataWindow" && type == "box2i" && length == 16) {
      const auto side = [&](size_t axis) {
        return int64_t{static_cast<int32_t>(LittleEndian32(bytes, value + 8 + 4 * axis))} -
               static_cast<int32_t>(LittleEndian32(bytes, value + 4 * axis)) + 1;
      };
      if (side(0) < 1 || side(1) < 1) return std::nullopt;
      pixels = std::max(pixels, static_cast<uint64_t>(side(0)) * static_cast<uint64_t>(side(1)));
    }
    at = value + length;
  }
  return pixels > 0 ? std::optional(pixels) : std::nullopt;
}

// The library says it when it has opened the file, and takes no memory until then.
std::optional<uint64_t> UnknownPixels(Bytes) {
  return 0;
}

struct Format {
  Bytes begin;
  const char* name;
  std::optional<uint64_t> (*pixels)(Bytes bytes);
};

constexpr Format kFormats[] = {
    {"\x89PNG\r\n\x1a\n", "png", PngPixels},
    {"\xFF\xD8\xFF", "jpeg", JpegPixels},
    {"\x76\x2F\x31\x01", "openexr", ExrPixels},
    {Bytes("II*\0", 4), "tiff", UnknownPixels},
    {Bytes("MM\0*", 4), "tiff", UnknownPixels},
    {"BM", "bmp", UnknownPixels},
    {"P2", "pnm", UnknownPixels},
    {"P3", "pnm", UnknownPixels},
    {"P5", "pnm", UnknownPixels},
    {"P6", "pnm", UnknownPixels},
};

}  // namespace

const char* PictureFormat(const std::filesystem::path& file, const std::string& bytes) {
  for (const Format& format : kFormats) {
    if (!bytes.starts_with(format.begin)) continue;
    const std::optional<uint64_t> pixels = format.pixels(bytes);
    if (!pixels) throw InputError::At(file, "header", "no size", "a picture");
    CheckPictureSize(file, *pixels, bytes.size());
    return format.name;
  }
  throw InputError::At(file, "", "none of PNG, JPEG, EXR, TIFF, BMP, PNM", "a picture");
}

void CheckPictureSize(const std::filesystem::path& file, uint64_t claimed_bytes, uint64_t size) {
  constexpr uint64_t kNoMatter = 64u << 20;
  constexpr uint64_t kPacked = 2000;  // Deflate, the best of them, reaches 1032
  if (claimed_bytes <= kNoMatter || claimed_bytes / kPacked <= size) return;
  throw InputError::At(file, "header",
                       fmt::format("a picture of {} MiB in {} bytes", claimed_bytes >> 20, size),
                       "a size that the file can hold");
}

}  // namespace retrolux
