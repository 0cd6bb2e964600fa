#include "analysis/hotspot_limit.h"

#include <algorithm>

#include "core/json_reader.h"

namespace retrolux {

namespace {

// Criteria are named by what is measured and the method (hotspot_verdict.cpp).
bool IsMeasured(const std::string& criterion) {
  constexpr std::string_view kMethod = ", robust";
  return criterion.ends_with(kMethod);
}

}  // namespace

double HotspotLimit_deg(const std::filesystem::path& summary) {
  JsonReader json = JsonReader::FromFile(summary);
  json.Schema("retrolux/hotspot-study-1");
  const JsonReader limits = json.Child("limits");
  double largest = 0.0;
  int found = 0;
  for (size_t i = 0; i < limits.Size(); ++i) {
    JsonReader limit = limits.Child(i);
    const std::string criterion = limit.String("criterion");
    if (limit.String("series") != "default" || limit.String("rings") != "both" ||
        !IsMeasured(criterion))
      continue;
    ++found;
    if (limit.Bool("never_changed", false)) continue;
    const JsonReader angle = limit.Child("limit_deg");
    if (!angle.IsNumber()) {
      angle.Fail(fmt::format("no limit of '{}'", criterion),
                 "a study that reaches the angle from which on nothing changes");
    }
    largest = std::max(largest, angle.AsNumber(0.0, 180.0));
  }
  if (found == 0) limits.Fail("no criterion of robust", "the summary.json of study hotspot");
  return largest;
}

}  // namespace retrolux
