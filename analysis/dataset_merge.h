// Datasets that were made in parts, and the proof that all is there.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

struct DatasetFaults {
  size_t checked = 0;  // results that were there
  std::vector<std::string>
      damaged;  // "scene-00017 (number 17): images/x.png: not what was written"
  std::vector<std::string> missing;  // "scene-00018 (number 18)"; with the last failure if any
};

// Reads every result and every file that belongs to it and compares checksums; compares
// dataset.json, if there is one, with the results. Writes nothing.
DatasetFaults VerifyDataset(const std::filesystem::path& folder, Progress& progress);

// Takes from the other folders what they have done and `folder` has not. All must be of the same
// plan (InputError), and what is taken is checked. Writes beside and renames; may be run again.
void MergeDatasets(const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& others, Progress& progress);

}  // namespace retrolux
