#include "analysis/picture_view.h"

#include "core/error.h"

namespace retrolux {

namespace {

std::vector<ReportChannel> Chosen(const PictureChannels& picture,
                                  const std::vector<std::string>& names,
                                  const std::filesystem::path& file) {
  if (names.empty()) return picture.channels;
  std::vector<ReportChannel> chosen;
  for (const std::string& name : names) {
    const ReportChannel* channel = picture.Find(name);
    if (!channel) {
      std::vector<std::string> known;
      for (const ReportChannel& other : picture.channels) known.push_back(other.name);
      throw InputError::At(file, "", fmt::format("no channel '{}'", name),
                           "one of " + JoinNames(known));
    }
    chosen.push_back(*channel);
  }
  return chosen;
}

void AddSummaries(const std::vector<ReportChannel>& channels, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const ReportChannel& channel : channels) {
    const ChannelSummary s = Summarise(channel);
    rows.push_back({channel.name, channel.unit, fmt::format("{:.6g}", s.least),
                    fmt::format("{:.6g}", s.mean), fmt::format("{:.6g}", s.most),
                    std::to_string(s.values)});
  }
  report.Table("The channels; of ids, pixels that have one",
               {"channel", "unit", "least", "mean", "most", "pixels"}, rows);
}

void AddHeader(const std::map<std::string, std::string>& attributes, Report& report) {
  if (attributes.empty()) return;
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, value] : attributes) rows.push_back({key, value});
  report.Heading("What the file says of itself");
  report.Table("Header", {"key", "value"}, rows);
}

}  // namespace

Report PictureView(const std::filesystem::path& file, const std::vector<std::string>& chosen,
                   const std::string& command) {
  const PictureChannels picture = ReadChannels(file);
  const std::vector<ReportChannel> channels = Chosen(picture, chosen, file);
  Report report(file.filename().string(),
                fmt::format("{} x {} px, {} channels; pixel (0, 0) is the centre of the top-left "
                            "pixel",
                            picture.width, picture.height, channels.size()));
  report.Channels("Any channel in false colour; ids in colours of their own", picture.width,
                  picture.height, channels);
  AddSummaries(channels, report);
  AddHeader(picture.attributes, report);
  report.HowMade(command);
  return report;
}

}  // namespace retrolux
