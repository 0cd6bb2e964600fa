#include "core/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/picture_header.h"

namespace retrolux {

namespace {

namespace fs = std::filesystem;

struct Size {
  int width, height;
};

Size SizeOf(const ExrChannel& channel) {
  return std::visit(
      [](const auto& plane) {
        return Size{plane.width, plane.height};
      },
      channel.plane);
}

[[noreturn]] void ThrowWrite(const fs::path& file, const std::string& reason) {
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const fs::space_info space = fs::space(folder, error);
  const std::string message = fmt::format("{}: cannot be written: {}", file.string(), reason);
  if (!error && space.available < (1u << 20)) throw TryAgainError(message + " (the disk is full)");
  throw InputError(message + "; expected a place that can be written to");
}

// libpng says what it thinks of a cut-off file on stderr; so we look first.
void CheckPngIsWhole(const fs::path& file, const std::string& bytes) {
  if (!bytes.starts_with("\x89PNG") ||
      bytes.find("IEND", bytes.size() < 12 ? 0 : bytes.size() - 12) != std::string::npos)
    return;
  throw InputError::At(file, "", "a PNG file that is cut off", "a whole picture");
}

std::string FirstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// By the reader of the format that the bytes are in, and no other; `memory`: null to read the file.
std::unique_ptr<OIIO::ImageInput> OpenBytes(const fs::path& file, const std::string& bytes,
                                            OIIO::Filesystem::IOProxy* memory) {
  const char* const format = PictureFormat(file, bytes);
  CheckPngIsWhole(file, bytes);
  auto input = OIIO::ImageInput::create(format);
  if (!input) throw InputError::At(file, "", FirstLine(OIIO::geterror()), "a picture");
  OIIO::ImageSpec spec;
  if (memory != nullptr && !input->set_ioproxy(memory)) {
    throw InputError::At(file, "", fmt::format("{} inside another file", format),
                         "a PNG or JPEG picture");
  }
  if (!input->open(file.string(), spec))
    throw InputError::At(file, "", FirstLine(input->geterror()), "a picture");
  if (spec.deep || spec.depth != 1 || spec.width < 1 || spec.height < 1)
    throw InputError::At(file, "header", "deep or without a size", "a flat picture");
  CheckPictureSize(file, spec.image_bytes(true), bytes.size());
  return input;
}

std::unique_ptr<OIIO::ImageInput> Open(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError::At(file, "", fs::is_directory(file, error) ? "is a folder" : "no such file",
                         "a picture");
  }
  return OpenBytes(file, ReadTextFile(file), nullptr);
}

}  // namespace

const FloatPlane& ExrImage::Float(const std::string& name) const {
  std::vector<std::string> names;
  for (const ExrChannel& channel : channels) {
    if (const auto* plane = std::get_if<FloatPlane>(&channel.plane)) {
      if (channel.name == name) return *plane;
      names.push_back(channel.name);
    }
  }
  throw InputError(
      fmt::format("no FLOAT channel '{}'; expected one of {}", name, JoinNames(names)));
}

const IdPlane& ExrImage::Ids(const std::string& name) const {
  std::vector<std::string> names;
  for (const ExrChannel& channel : channels) {
    if (const auto* plane = std::get_if<IdPlane>(&channel.plane)) {
      if (channel.name == name) return *plane;
      names.push_back(channel.name);
    }
  }
  throw InputError(fmt::format("no UINT channel '{}'; expected one of {}", name, JoinNames(names)));
}

void WriteExr(const fs::path& file, const ExrImage& image) {
  RETROLUX_CHECK(!image.channels.empty(), "no channels for {}", file.string());
  const Size size = SizeOf(image.channels.front());
  const size_t count = image.channels.size();
  OIIO::ImageSpec spec(size.width, size.height, static_cast<int>(count), OIIO::TypeFloat);
  spec.channelnames.clear();
  for (const ExrChannel& channel : image.channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(std::holds_alternative<IdPlane>(channel.plane) ? OIIO::TypeUInt32
                                                                                 : OIIO::TypeFloat);
  }
  // Of a picture of ours with 24 channels (bench/compression_bench): 484 ms and 13.4 MiB; level 4
  // takes 544 ms and is 0.9 % smaller, piz 484 ms and 14 % smaller, but slower to read.
  spec.attribute("compression", "zip:1");
  // OpenImageIO would write the time of day: the same picture must have the same bytes.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  for (const auto& [name, value] : image.attributes) spec.attribute(name, value);

  // FLOAT and UINT are both four bytes, so that native pixels are an array of words.
  const size_t pixels = static_cast<size_t>(size.width) * static_cast<size_t>(size.height);
  std::vector<uint32_t> native(pixels * count);
  for (size_t c = 0; c < count; ++c) {
    std::visit(
        [&](const auto& plane) {
          RETROLUX_CHECK(plane.data.size() == pixels, "{} has another size",
                         image.channels[c].name);
          for (size_t i = 0; i < pixels; ++i) {
            std::memcpy(&native[i * count + c], &plane.data[i], sizeof(uint32_t));
          }
        },
        image.channels[c].plane);
  }
  AtomicFile atomic(file);
  auto output = OIIO::ImageOutput::create(atomic.Temporary().string());
  if (!output) ThrowWrite(file, OIIO::geterror());
  if (!output->open(atomic.Temporary().string(), spec)) ThrowWrite(file, output->geterror());
  if (!output->write_image(OIIO::TypeUnknown, native.data())) ThrowWrite(file, output->geterror());
  if (!output->close()) ThrowWrite(file, output->geterror());
  atomic.Commit();
}

namespace {

// The channel that begins at `first` in each pixel of `native`, pixels of `stride` bytes.
template <typename Value>
void TakeChannel(const std::vector<char>& native, size_t first, size_t stride, OIIO::TypeDesc from,
                 OIIO::TypeDesc to, Plane<Value>& plane) {
  std::vector<char> values(plane.data.size() * from.size());
  for (size_t i = 0; i < plane.data.size(); ++i)
    std::memcpy(&values[i * from.size()], &native[i * stride + first], from.size());
  RETROLUX_CHECK(OIIO::convert_types(from, values.data(), to, plane.data.data(),
                                     static_cast<int>(plane.data.size())),
                 "{} to {}", from.c_str(), to.c_str());
}

}  // namespace

ExrImage ReadExr(const fs::path& file) {
  auto input = Open(file);
  const OIIO::ImageSpec& spec = input->spec();
  // All channels at once, in the file's own types: each reading unpacks the whole file.
  const size_t stride = spec.pixel_bytes(true);
  std::vector<char> native(spec.image_pixels() * stride);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeUnknown, native.data()))
    throw InputError::At(file, "", FirstLine(input->geterror()), "a whole picture");
  ExrImage image;
  for (int c = 0; c < spec.nchannels; ++c) {
    const OIIO::TypeDesc from = spec.channelformat(c);
    const size_t first = spec.pixel_bytes(0, c, true);
    ExrChannel channel{spec.channel_name(c), FloatPlane(spec.width, spec.height)};
    if (from == OIIO::TypeUInt32) {
      IdPlane ids(spec.width, spec.height);
      TakeChannel(native, first, stride, from, OIIO::TypeUInt32, ids);
      channel.plane = std::move(ids);
    } else {
      TakeChannel(native, first, stride, from, OIIO::TypeFloat,
                  std::get<FloatPlane>(channel.plane));
    }
    image.channels.push_back(std::move(channel));
  }
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    if (attribute.type() == OIIO::TypeString) {
      image.attributes[attribute.name().string()] = attribute.get_string();
    }
  }
  return image;
}

namespace {

// Encoded in memory and written by ourselves: OpenImageIO's PNG writer does not notice a full disk.
std::string EncodePng(const OIIO::ImageSpec& spec, OIIO::TypeDesc format, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  auto output = OIIO::ImageOutput::create("memory.png", &memory);
  RETROLUX_CHECK(output && output->open("memory.png", spec) &&
                     output->write_image(format, pixels) && output->close(),
                 "PNG in memory");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string EncodeGreyPng(const DigitalImage& image) {
  const bool wide = image.bits > 8;
  OIIO::ImageSpec spec(image.dn.width, image.dn.height, 1,
                       wide ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
  // Of a noisy picture of 640 x 480 (bench/compression_bench): 3.7 ms and 75 KiB; all filters 6.1
  // ms and 82, level 6 23 ms and 58, none 0.5 ms and 301.
  constexpr int kFilterSub = 16;
  spec.attribute("png:compressionLevel", 1);
  spec.attribute("png:filter", kFilterSub);
  if (wide) return EncodePng(spec, OIIO::TypeUInt16, image.dn.data.data());
  const std::vector<uint8_t> bytes(image.dn.data.begin(), image.dn.data.end());
  return EncodePng(spec, OIIO::TypeUInt8, bytes.data());
}

void WritePng(const fs::path& file, const DigitalImage& image) {
  WriteTextFile(file, EncodeGreyPng(image));
}

namespace {

// Rec. 709 of the first three channels, or the first.
float Grey(const float* pixel, size_t channels) {
  return channels >= 3 ? 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2] : pixel[0];
}

// IEC 61966-2-1.
float LinearFromSrgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

FloatPlane DecodeLinearGrey(const std::string& bytes, const fs::path& file) {
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OpenBytes(file, bytes, &memory);
  const OIIO::ImageSpec& spec = input->spec();
  const auto channels = static_cast<size_t>(spec.nchannels);
  const bool linear = spec.format.is_floating_point();
  FloatPlane grey(spec.width, spec.height);
  std::vector<float> pixels(grey.data.size() * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()))
    throw InputError::At(file, "", FirstLine(input->geterror()), "a whole picture");
  for (float& value : pixels) {
    if (!std::isfinite(value))
      throw InputError::At(file, "", "a pixel that is not a number", "finite pixels");
    if (!linear) value = LinearFromSrgb(value);
  }
  for (size_t i = 0; i < grey.data.size(); ++i)
    grey.data[i] = Grey(&pixels[i * channels], channels);
  return grey;
}

namespace {

template <typename Value>
std::vector<Value> ReadPixels(OIIO::ImageInput& input, OIIO::TypeDesc type, const fs::path& file) {
  const OIIO::ImageSpec& spec = input.spec();
  std::vector<Value> pixels(spec.image_pixels() * static_cast<size_t>(spec.nchannels));
  if (!input.read_image(0, 0, 0, spec.nchannels, type, pixels.data()))
    throw InputError::At(file, "", FirstLine(input.geterror()), "a whole picture");
  return pixels;
}

}  // namespace

DigitalImage ReadGrey(const fs::path& file) {
  auto input = Open(file);
  const OIIO::ImageSpec& spec = input->spec();
  const auto channels = static_cast<size_t>(spec.nchannels);
  DigitalImage image;
  image.bits = spec.format.size() == 1 ? 8 : 16;
  image.dn = Plane<uint16_t>(spec.width, spec.height);
  if (channels == 1 && spec.format == OIIO::TypeUInt8) {  // what we write: no detour by floats
    const auto pixels = ReadPixels<uint8_t>(*input, OIIO::TypeUInt8, file);
    image.dn.data.assign(pixels.begin(), pixels.end());
  } else if (channels == 1 && spec.format == OIIO::TypeUInt16) {
    image.dn.data = ReadPixels<uint16_t>(*input, OIIO::TypeUInt16, file);
  } else {
    const auto pixels = ReadPixels<float>(*input, OIIO::TypeFloat, file);
    const float full_scale = image.bits == 8 ? 255.0f : 65535.0f;
    for (size_t i = 0; i < image.dn.data.size(); ++i) {
      const float grey = Grey(&pixels[i * channels], channels);
      image.dn.data[i] =
          static_cast<uint16_t>(std::lround(std::clamp(grey, 0.0f, 1.0f) * full_scale));
    }
  }
  return image;
}

void WriteRgbPng(const fs::path& file, int width, int height, const std::vector<uint8_t>& rgb) {
  WriteTextFile(file, EncodeRgbPng(width, height, rgb));
}

std::string EncodeRgbPng(int width, int height, const std::vector<uint8_t>& rgb) {
  return EncodePng(OIIO::ImageSpec(width, height, 3, OIIO::TypeUInt8), OIIO::TypeUInt8, rgb.data());
}

}  // namespace retrolux
