#include "materials/texture.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/hash.h"
#include "core/image_file.h"

namespace retrolux {

Texture::Texture(std::filesystem::path file, std::string bytes)
    : file_(std::move(file)), bytes_(std::move(bytes)), share_(DecodeLinearGrey(bytes_, file_)) {
  for (float& share : share_.data) share = std::clamp(share, 0.0f, 1.0f);
}

std::string Texture::FileName() const {
  return fmt::format("texture-{}{}", HexHash(HashBytes(bytes_)), file_.extension().string());
}

float Texture::At(const Vec2f& uv) const {
  const auto wrapped = [](float x) { return x - std::floor(x); };
  const float x = wrapped(uv.x()) * static_cast<float>(share_.width) - 0.5f;
  const float y = wrapped(uv.y()) * static_cast<float>(share_.height) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto at = [&](int px, int py) {
    return share_((px + share_.width) % share_.width, (py + share_.height) % share_.height);
  };
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const float top = (1.0f - fx) * at(x0, y0) + fx * at(x0 + 1, y0);
  const float bottom = (1.0f - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1);
  return (1.0f - fy) * top + fy * bottom;
}

}  // namespace retrolux
