#include "analysis/picture_difference.h"

#include <algorithm>
#include <cmath>

#include "analysis/raised_picture.h"
#include "core/error.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

bool SameValue(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// Running sums over the pixels where both are finite.
class Sums {
 public:
  explicit Sums(double mean_a) : floor_(1e-2 * mean_a) {}

  void Add(double a, double b) {
    const double d = b - a, reference = a * a + floor_ * floor_;
    ++count_;
    sum_ += d;
    squares_ += d * d;
    if (reference > 0.0) relative_ += d * d / reference;
    most_ = std::max(most_, std::abs(d));
  }

  void Into(ChannelDifference& difference) const {
    if (count_ == 0) return;
    const auto n = static_cast<double>(count_);
    difference.bias = sum_ / n;
    difference.rms = std::sqrt(squares_ / n);
    difference.relative_mse = relative_ / n;
    difference.most = most_;
  }

 private:
  double floor_, sum_ = 0.0, squares_ = 0.0, relative_ = 0.0, most_ = 0.0;
  int64_t count_ = 0;
};

ChannelDifference CompareChannels(const ReportChannel& a, const ReportChannel& b) {
  ChannelDifference difference;
  difference.name = a.name;
  difference.unit = a.unit;
  difference.ids = a.kind == ReportChannel::Kind::kIds;
  difference.pixels = static_cast<int64_t>(a.values.size());
  Sums sums(Summarise(a).mean);
  for (size_t i = 0; i < a.values.size(); ++i) {
    if (!SameValue(a.values[i], b.values[i])) ++difference.different;
    if (std::isfinite(a.values[i]) && std::isfinite(b.values[i]))
      sums.Add(static_cast<double>(a.values[i]), static_cast<double>(b.values[i]));
  }
  if (!difference.ids) sums.Into(difference);
  return difference;
}

std::optional<double> RmsInSigmas(const PictureChannels& a, const PictureChannels& b) {
  const ReportChannel *value_a = a.Find("electrons.Y"), *value_b = b.Find("electrons.Y");
  const ReportChannel *variance_a = a.Find("variance.Y"), *variance_b = b.Find("variance.Y");
  if (!value_a || !value_b || !variance_a || !variance_b) return std::nullopt;
  double sum = 0.0;
  int64_t count = 0;
  for (size_t i = 0; i < value_a->values.size(); ++i) {
    const double variance =
        static_cast<double>(variance_a->values[i]) + static_cast<double>(variance_b->values[i]);
    if (!(variance > 0.0)) continue;
    const double d =
        static_cast<double>(value_b->values[i]) - static_cast<double>(value_a->values[i]);
    sum += d * d / variance;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(count));
}

// 255 DN, or the least full scale of 16 bits that holds what is in the pictures.
double FullScale(const ReportChannel& a, const ReportChannel& b) {
  double full = 255.0;
  while (full < std::max(Summarise(a).most, Summarise(b).most)) full = 2.0 * full + 1.0;
  return full;
}

// b - a; of ids 1 where they are not the same.
std::vector<ReportChannel> Differences(const PictureChannels& a, const PictureChannels& b) {
  std::vector<ReportChannel> differences;
  for (const ReportChannel& channel : a.channels) {
    const ReportChannel* other = b.Find(channel.name);
    if (!other || other->kind != channel.kind) continue;
    const bool ids = channel.kind == ReportChannel::Kind::kIds;
    ReportChannel& d = differences.emplace_back(channel);
    d.kind = ids ? ReportChannel::Kind::kIds : ReportChannel::Kind::kDifference;
    if (ids) d.names = {"not the same"};
    for (size_t i = 0; i < d.values.size(); ++i) {
      const float was = d.values[i], is = other->values[i];
      d.values[i] = ids ? (was == is ? 0.0f : 1.0f) : is - was;
    }
  }
  return differences;
}

// The first channel of values as people look at it: from 0 to the highest of both but a thousandth.
LabelledPicture Shown(const std::string& label, const PictureChannels& picture, double full) {
  DigitalImage image{Plane<uint16_t>(picture.width, picture.height), 8};
  const std::vector<float>& values = picture.channels.front().values;
  for (size_t i = 0; i < values.size(); ++i) {
    const double share = static_cast<double>(values[i]) / full;
    image.dn.data[i] =
        static_cast<uint16_t>(std::isfinite(share) ? 255.0 * std::clamp(share, 0.0, 1.0) : 0.0);
  }
  return {label, EncodeGreyPng(DarkLevelsRaised(image))};
}

double HighLevel(const ReportChannel& a) {
  std::vector<float> values;
  std::copy_if(a.values.begin(), a.values.end(), std::back_inserter(values),
               [](float v) { return std::isfinite(v); });
  if (values.empty()) return 1.0;
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place > 0.0f ? static_cast<double>(*place) : 1.0;
}

std::string Optional(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "";
}

void AddTable(const PictureDifference& difference, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const ChannelDifference& c : difference.channels) {
    const auto measure = [&](double value) {
      return c.ids ? std::string() : fmt::format("{:.4g}", value);
    };
    rows.push_back({c.name, c.unit, std::to_string(c.different), std::to_string(c.pixels),
                    measure(c.bias), measure(c.rms), measure(c.most), measure(c.relative_mse),
                    Optional(c.psnr_db), Optional(c.rms_in_sigmas)});
  }
  report.Table("b - a. In sigmas: by the variances that both files have; 1 or less is noise",
               {"channel", "unit", "different", "pixels", "bias", "rms", "most", "relMSE",
                "PSNR / dB", "rms in sigmas"},
               rows);
}

}  // namespace

bool PictureDifference::Same() const {
  return only_in_a.empty() && only_in_b.empty() &&
         std::all_of(channels.begin(), channels.end(),
                     [](const ChannelDifference& c) { return c.different == 0; });
}

PicturePair ReadPair(const std::filesystem::path& file_a, const std::filesystem::path& file_b) {
  PicturePair pair{file_a, file_b, ReadChannels(file_a), ReadChannels(file_b)};
  if (pair.a.width != pair.b.width || pair.a.height != pair.b.height) {
    throw InputError::At(
        file_b, "", fmt::format("{} x {} px", pair.b.width, pair.b.height),
        fmt::format("{} x {} px, as {}", pair.a.width, pair.a.height, file_a.string()));
  }
  return pair;
}

PictureDifference ComparePictures(const PicturePair& pair) {
  const PictureChannels &a = pair.a, &b = pair.b;
  PictureDifference difference;
  for (const ReportChannel& channel : a.channels) {
    const ReportChannel* other = b.Find(channel.name);
    if (!other || other->kind != channel.kind) {
      difference.only_in_a.push_back(channel.name);
      continue;
    }
    ChannelDifference& compared =
        difference.channels.emplace_back(CompareChannels(channel, *other));
    if (channel.unit == "DN" && compared.rms > 0.0)
      compared.psnr_db = 20.0 * std::log10(FullScale(channel, *other) / compared.rms);
    if (channel.name == "electrons.Y") compared.rms_in_sigmas = RmsInSigmas(a, b);
  }
  for (const ReportChannel& channel : b.channels) {
    const ReportChannel* other = a.Find(channel.name);
    if (!other || other->kind != channel.kind) difference.only_in_b.push_back(channel.name);
  }
  return difference;
}

Report DifferenceReport(const PicturePair& pair, const std::string& command) {
  const PictureChannels &a = pair.a, &b = pair.b;
  Report report("How two pictures differ",
                fmt::format("a: {}; b: {}", pair.file_a.string(), pair.file_b.string()));
  AddTable(ComparePictures(pair), report);
  const double full = std::max(HighLevel(a.channels.front()), HighLevel(b.channels.front()));
  report.Comparison(fmt::format("Channel {}, 0 to {:.4g} {}, dark levels raised (gamma 2.2)",
                                a.channels.front().name, full, a.channels.front().unit),
                    Shown("a", a, full), Shown("b", b, full));
  report.Channels("b - a", a.width, a.height, Differences(a, b));
  report.HowMade(command);
  return report;
}

}  // namespace retrolux
