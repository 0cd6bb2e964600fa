#include "analysis/picture_channels.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

// By the first part of a channel's name, as renderer/render_files.cpp names them; the header of a
// file says it in a sentence.
std::string UnitOf(const std::string& channel) {
  static const std::map<std::string, std::string> kUnits = {{"electrons", "e-"},
                                                            {"variance", "e-^2"},
                                                            {"radiance", "W/(m2 sr)"},
                                                            {"depth", "mm"},
                                                            {"position", "mm"}};
  const auto unit = kUnits.find(channel.substr(0, channel.find('.')));
  return unit == kUnits.end() ? "" : unit->second;
}

// "1=mask, 2=couch" of a header, by number. A name may hold commas: it ends where the next number
// begins.
std::vector<std::string> NumberedNames(const std::string& text) {
  std::vector<std::string> names;
  const auto mark = [&] { return fmt::format("{}=", names.size() + 1); };
  if (!text.starts_with(mark())) return names;
  for (size_t begin = mark().size(); begin <= text.size();) {
    names.emplace_back();
    const std::string next = ", " + mark();
    const size_t end = std::min(text.find(next, begin), text.size());
    names.back() = text.substr(begin, end - begin);
    begin = end + next.size();
  }
  return names;
}

std::vector<std::string> NamesOfIds(const std::string& channel,
                                    const std::map<std::string, std::string>& attributes) {
  const auto names = [&](const char* key) {
    const auto text = attributes.find(key);
    return text == attributes.end() ? std::vector<std::string>() : NumberedNames(text->second);
  };
  if (channel == "id.object") return names("retrolux/objects");
  if (channel.find("marker") != std::string::npos) return names("retrolux/markers");
  return {};
}

ReportChannel ChannelOf(const ExrChannel& from,
                        const std::map<std::string, std::string>& attributes) {
  ReportChannel channel;
  channel.name = from.name;
  channel.unit = UnitOf(from.name);
  if (const auto* ids = std::get_if<IdPlane>(&from.plane)) {
    channel.kind = ReportChannel::Kind::kIds;
    channel.names = NamesOfIds(from.name, attributes);
    channel.values.assign(ids->data.begin(), ids->data.end());
  } else {
    channel.values = std::get<FloatPlane>(from.plane).data;
  }
  return channel;
}

PictureChannels ExrChannels(const std::filesystem::path& file) {
  const ExrImage image = ReadExr(file);
  PictureChannels picture;
  picture.attributes = image.attributes;
  for (const ExrChannel& channel : image.channels) {
    std::visit(
        [&](const auto& plane) {
          picture.width = plane.width;
          picture.height = plane.height;
        },
        channel.plane);
    picture.channels.push_back(ChannelOf(channel, image.attributes));
  }
  std::stable_partition(picture.channels.begin(), picture.channels.end(),
                        [](const ReportChannel& channel) { return channel.name == "electrons.Y"; });
  return picture;
}

}  // namespace

const ReportChannel* PictureChannels::Find(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const ReportChannel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

PictureChannels ReadChannels(const std::filesystem::path& file) {
  if (file.extension() == ".exr") return ExrChannels(file);
  const DigitalImage image = ReadGrey(file);
  PictureChannels picture{image.dn.width, image.dn.height, {}, {}};
  ReportChannel& grey = picture.channels.emplace_back();
  grey.name = "grey";
  grey.unit = "DN";
  grey.values.assign(image.dn.data.begin(), image.dn.data.end());
  return picture;
}

ChannelSummary Summarise(const ReportChannel& channel) {
  const bool ids = channel.kind == ReportChannel::Kind::kIds;
  ChannelSummary summary;
  double sum = 0.0;
  for (const float value : channel.values) {
    if (!std::isfinite(value) || (ids && value == 0.0f)) continue;
    const auto v = static_cast<double>(value);
    summary.least = summary.values == 0 ? v : std::min(summary.least, v);
    summary.most = summary.values == 0 ? v : std::max(summary.most, v);
    sum += v;
    ++summary.values;
  }
  if (summary.values > 0) summary.mean = sum / static_cast<double>(summary.values);
  return summary;
}

}  // namespace retrolux
