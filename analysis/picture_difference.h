// How two pictures differ, channel by channel.
#pragma once

#include <optional>

#include "analysis/picture_channels.h"

namespace retrolux {

struct ChannelDifference {
  std::string name, unit;
  bool ids = false;
  int64_t pixels = 0;     // compared
  int64_t different = 0;  // pixels whose values are not the same; NaN is the same as NaN
  // Over the pixels where both are finite; none for ids, whose difference means nothing.
  double bias = 0.0;  // mean of b - a
  double rms = 0.0;   // of b - a
  double most = 0.0;  // of |b - a|
  // Mean of (b - a)^2 / (a^2 + (1e-2 mean of a)^2): the relMSE by which renderers are compared,
  // with a floor so that dark pixels do not decide.
  double relative_mse = 0.0;
  std::optional<double> psnr_db;  // of DN: 20 log10(full scale / rms)
  // Of electrons.Y where both files have its variance: rms of (b - a) / sqrt(var a + var b) over
  // the pixels that have one. 1 or less (the variances are upper bounds): only noise apart.
  std::optional<double> rms_in_sigmas;
};

struct PictureDifference {
  std::vector<ChannelDifference> channels;  // that both have, in the order of a
  std::vector<std::string> only_in_a, only_in_b;

  bool Same() const;
};

// Two pictures of the same size.
struct PicturePair {
  std::filesystem::path file_a, file_b;
  PictureChannels a, b;
};

// InputError if one is no picture, or if they are not of the same size.
PicturePair ReadPair(const std::filesystem::path& file_a, const std::filesystem::path& file_b);

PictureDifference ComparePictures(const PicturePair& pair);

// The two pictures with a slider between them, and b - a of each channel in false colour.
Report DifferenceReport(const PicturePair& pair, const std::string& command);

}  // namespace retrolux
