// The channels of a picture file, whatever it is, for people to look at and to compare.
#pragma once

#include <filesystem>
#include <map>

#include "analysis/report.h"

namespace retrolux {

struct PictureChannels {
  int width = 0, height = 0;
  std::vector<ReportChannel> channels;  // of an EXR file: electrons.Y first if it is there
  std::map<std::string, std::string> attributes;  // of an EXR file's header

  // Null if there is none of that name.
  const ReportChannel* Find(const std::string& name) const;
};

// All channels of an EXR file; of any other picture "grey" in DN. InputError if the file is no
// picture.
PictureChannels ReadChannels(const std::filesystem::path& file);

// What can be said of a channel in a line. Values that are not finite are left out; ids: of those
// that are not 0.
struct ChannelSummary {
  double least = 0.0, mean = 0.0, most = 0.0;
  int64_t values = 0;  // finite; for ids: not 0
};
ChannelSummary Summarise(const ReportChannel& channel);

}  // namespace retrolux
