// What a dataset holds, counted: for its card and its report.
#pragma once

#include <map>

#include "analysis/dataset.h"

namespace retrolux {

// A nuisance over the pictures. Names and yes/no: how many pictures have each; numbers: least,
// middle and largest of the pictures that have it.
struct NuisanceStatistics {
  std::string name;
  std::map<std::string, int> counts;  // of names; empty for numbers
  std::vector<double> values;         // of numbers, ascending, one for each picture that has it
  int pictures = 0;                   // that have it: not null, not 0, not false
};
std::vector<NuisanceStatistics> CountNuisances(const DatasetIndex& index);

// A figure of the markers that show at least a pixel.
struct LabelStatistics {
  std::string name;  // with its unit
  std::vector<double> values;
};
std::vector<LabelStatistics> CollectLabels(const DatasetIndex& index);

// How many such markers there are of each number, polarity.
std::map<std::string, int> CountMarkers(const DatasetIndex& index);

}  // namespace retrolux
