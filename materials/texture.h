// A picture on a surface: which share of its material's reflectance each place has.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/conventions.h"
#include "core/plane.h"

namespace retrolux {

// Grey, the same at all wavelengths, 0 to 1. It repeats; between the pixels it is interpolated.
// Texture coordinates are glTF's: (0, 0) is the upper left corner of the picture, (1, 1) the lower
// right one.
class Texture {
 public:
  // Any picture file in memory. Integer pixels are sRGB and made linear, floating-point ones are
  // linear; colours become luminance (Rec. 709). InputError that begins with `file` if the bytes
  // are no picture or hold values that are not finite.
  Texture(std::filesystem::path file, std::string bytes);

  float At(const Vec2f& uv) const;
  size_t Pixels() const { return share_.data.size(); }

  // As it was read, so that a scene can be written out again, and the name of a file for it that no
  // other picture has.
  const std::filesystem::path& File() const { return file_; }
  const std::string& Bytes() const { return bytes_; }
  std::string FileName() const;

 private:
  std::filesystem::path file_;
  std::string bytes_;
  FloatPlane share_;
};

}  // namespace retrolux
