// Pictures on disk: multi-layer OpenEXR with its description, and PNG in digital numbers. The only
// part that knows OpenImageIO. Everything is written beside its final name and renamed.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/plane.h"

namespace retrolux {

// A named channel of an EXR file; FLOAT or UINT (32 bit, kept exact).
struct ExrChannel {
  std::string name;
  std::variant<FloatPlane, IdPlane> plane;
};

struct ExrImage {
  std::vector<ExrChannel> channels;
  std::map<std::string, std::string> attributes;  // strings of the header

  // InputError that lists the channels if `name` is not there or of the other type.
  const FloatPlane& Float(const std::string& name) const;
  const IdPlane& Ids(const std::string& name) const;
};

// All channels must have the same size. Losslessly compressed (ZIP).
void WriteExr(const std::filesystem::path& file, const ExrImage& image);
ExrImage ReadExr(const std::filesystem::path& file);

// Grey PNG: 8 bit for images of up to 8 bits, else 16 bit with the numbers right-aligned.
void WritePng(const std::filesystem::path& file, const DigitalImage& image);

// Any picture that OpenImageIO reads, as grey: colours by Rec. 709 luma weights. 8-bit files give 8
// bits, all others 16. InputError if the file is not a picture.
DigitalImage ReadGrey(const std::filesystem::path& file);

// A picture file in memory as grey of linear light: integer pixels are taken to be sRGB, floating-
// point ones to be linear; colours by the Rec. 709 luminance. InputError that begins with `file` if
// the bytes are no picture.
FloatPlane DecodeLinearGrey(const std::string& bytes, const std::filesystem::path& file);

// 8-bit RGB, three numbers a pixel, for pictures that people look at.
void WriteRgbPng(const std::filesystem::path& file, int width, int height,
                 const std::vector<uint8_t>& rgb);

// The PNG file of a grey picture in memory, as WritePng writes it.
std::string EncodeGreyPng(const DigitalImage& image);

// The PNG file of an RGB picture in memory, for pages that carry their pictures.
std::string EncodeRgbPng(int width, int height, const std::vector<uint8_t>& rgb);

}  // namespace retrolux
