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

// Whether dataset.json is looked at, too.
enum class IndexToo { kNo, kYes };

// Reads every result and every file that belongs to it and compares checksums; where all is done,
// compares dataset.json with what the results say, byte by byte. Writes nothing.
DatasetFaults VerifyDataset(const std::filesystem::path& folder, IndexToo index,
                            Progress& progress);

// Takes from the other folders what they have done and `folder` has not. All must be of the same
// plan (InputError). What is taken is checked; returns what was damaged and not taken, a line each.
// Writes beside and renames; may be run again.
std::vector<std::string> MergeDatasets(const std::filesystem::path& folder,
                                       const std::vector<std::filesystem::path>& others,
                                       Progress& progress);

}  // namespace retrolux
