// The small files. First byte: c CSV, r table of R_A, m marker set, k constellation, s scenario.
#include "classifier/constellation.h"
#include "core/csv.h"
#include "core/marker_set.h"
#include "fuzz/target.h"
#include "materials/ra_table.h"
#include "scenes/scenario.h"

namespace retrolux::fuzz {

void FuzzOne(std::string_view input) {
  const Tagged tagged = TaggedInput(input);
  const std::filesystem::path file = FileOf("a.json", tagged.bytes);
  Try([&] {
    switch (tagged.tag) {
      case 'c':
        ReadNumberTable(file);
        break;
      case 'r':
        RaTable::FromFile(file);
        break;
      case 'm':
        ReadMarkerSet(file);
        break;
      case 'k':
        ReadConstellation(file, DefaultMarkerSet());
        break;
      default:
        LoadScenario(file.string());
    }
  });
}

}  // namespace retrolux::fuzz
