// What the first bytes of a picture file say, read by ourselves: the libraries behind OpenImageIO
// take memory for the size that a header claims before they look for the pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace retrolux {

// PNG, JPEG, EXR, TIFF, BMP or PNM, as OpenImageIO names it. InputError for other bytes, and for
// the size in a header of PNG, JPEG or EXR if there is none or the file can't hold it.
const char* PictureFormat(const std::filesystem::path& file, const std::string& bytes);

// InputError if a file of `size` bytes can't hold so much, packed as well as any of its formats
// does.
void CheckPictureSize(const std::filesystem::path& file, uint64_t claimed_bytes, uint64_t size);

}  // namespace retrolux
