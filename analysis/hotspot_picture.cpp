#include "analysis/hotspot_picture.h"

#include <algorithm>
#include <cmath>

#include "analysis/mask_picture.h"
#include "analysis/picture_canvas.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"

namespace retrolux {

namespace {

// From 10 e-, half a step of the default 8-bit ADC being 60, to beyond the full well.
constexpr double kLeast_e = 10.0;
constexpr int kStepsPerDecade = 6;
constexpr int kSteps = 21;

struct Window {
  int x0, y0, x1, y1;  // inclusive
};

Window WindowOf(const HotspotStage& stage) {
  constexpr int kMargin_px = 12;
  const IdPlane& object = stage.light.ids.object;
  Window window{object.width, object.height, -1, -1};
  for (int y = 0; y < object.height; ++y) {
    for (int x = 0; x < object.width; ++x) {
      if (object(x, y) != stage.mask + 1) continue;
      window = {std::min(window.x0, x), std::min(window.y0, y), std::max(window.x1, x),
                std::max(window.y1, y)};
    }
  }
  if (window.x1 < 0) return {0, 0, object.width - 1, object.height - 1};
  return {std::max(0, window.x0 - kMargin_px), std::max(0, window.y0 - kMargin_px),
          std::min(object.width - 1, window.x1 + kMargin_px),
          std::min(object.height - 1, window.y1 + kMargin_px)};
}

// 0: less than kLeast_e.
int StepOf(double electrons) {
  if (electrons < kLeast_e) return 0;
  return std::min(kSteps, 1 + static_cast<int>(kStepsPerDecade * std::log10(electrons / kLeast_e)));
}

double StepBegin_e(int step) {
  return kLeast_e * std::pow(10.0, (step - 1.0) / kStepsPerDecade);
}

std::array<uint8_t, 3> ColourNamed(const std::string& css) {
  const unsigned long rgb = std::stoul(css.substr(1), nullptr, 16);
  return {static_cast<uint8_t>(rgb >> 16), static_cast<uint8_t>(rgb >> 8 & 255),
          static_cast<uint8_t>(rgb & 255)};
}

}  // namespace

std::string RecordedPng(const HotspotStage& stage, const HotspotMix& mix, uint64_t noise_key) {
  const DigitalImage image =
      Sensor(stage.camera).Expose(Mixed(stage.light, mix), stage.light.exposure_s, noise_key);
  const Window w = WindowOf(stage);
  const double white = (1 << image.bits) - 1;
  return PictureCanvas(image, {w.x0, w.y0, w.x1 - w.x0 + 1, w.y1 - w.y0 + 1, 1.0, white}).Png();
}

std::string NeighboursPng(const HotspotStage& stage, const HotspotMix& mix) {
  const FloatPlane both = Mixed(stage.light, mix), own = Mixed(stage.light, {"", 1.0, 0.0});
  const std::vector<OvalCategory> scale = NeighboursScale();
  const Window w = WindowOf(stage);
  RgbPicture picture(w.x1 - w.x0 + 1, w.y1 - w.y0 + 1, {255, 255, 255});
  for (int y = w.y0; y <= w.y1; ++y) {
    for (int x = w.x0; x <= w.x1; ++x) {
      const auto more = static_cast<double>(both(x, y) - own(x, y));
      picture.Set(x - w.x0, y - w.y0, ColourNamed(scale[static_cast<size_t>(StepOf(more))].colour));
    }
  }
  return picture.Png();
}

std::vector<OvalCategory> NeighboursScale() {
  std::vector<OvalCategory> scale = CountCategories(kSteps);
  scale[0].label = fmt::format("below {:g} e-", kLeast_e);
  for (int step = 1; step <= kSteps; ++step) {
    scale[static_cast<size_t>(step)].label =
        step == kSteps ? fmt::format("{:.3g} e- and more", StepBegin_e(step))
                       : fmt::format("{:.3g}", StepBegin_e(step));
  }
  return scale;
}

nlohmann::json KeepHotspotPictures(const HotspotStage& stage, const HotspotMix& mix,
                                   const std::string& name, uint64_t noise_seed,
                                   const std::filesystem::path& folder) {
  const uint64_t key = NoiseKey(noise_seed, name + "_1");
  const std::pair<const char*, std::string> pictures[] = {
      {"own", RecordedPng(stage, {"own", 1.0, 0.0}, key)},
      {"both", RecordedPng(stage, mix, key)},
      {"neighbours", NeighboursPng(stage, mix)}};
  nlohmann::json kept = nlohmann::json::array();
  for (const auto& [kind, png] : pictures) {
    const std::string file = fmt::format("pictures/{}_{}.png", name, kind);
    WriteTextFile(folder / file, png);
    kept.push_back({{"kind", kind}, {"file", file}, {"hash", HexHash(HashBytes(png))}});
  }
  return kept;
}

std::vector<HotspotPicture> KeptHotspotPictures(const nlohmann::json& result) {
  std::vector<HotspotPicture> pictures;
  for (const nlohmann::json& kept : result.at("kept"))
    pictures.push_back({kept.at("kind").get<std::string>(), kept.at("file").get<std::string>()});
  return pictures;
}

}  // namespace retrolux
