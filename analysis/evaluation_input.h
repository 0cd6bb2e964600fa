// The detections that are evaluated: by our methods, or from a file.
#pragma once

#include <atomic>

#include "analysis/evaluation.h"
#include "classifier/detections_json.h"
#include "classifier/method.h"

namespace retrolux {

// InputError unless the pictures are there, each the one that was labelled.
void CheckPictures(const Evaluation& evaluation, const std::filesystem::path& dataset);

struct IdentificationTimes {
  double wall_s = 0.0;                   // of all, reading the pictures included
  std::atomic<double> identify_s = 0.0;  // of the method alone, summed over threads
};

// A method on each picture.
std::vector<std::vector<Detection>> IdentifyPictures(const Evaluation& evaluation,
                                                     const std::filesystem::path& dataset,
                                                     const Method& method, const MarkerSet& markers,
                                                     Progress& progress,
                                                     IdentificationTimes& times);

// What a file says of each picture; pictures are told by the names of their files, folders do not
// matter. InputError for a picture that the file has twice, that the dataset has not, and for
// one of the evaluation that the file leaves out.
std::vector<std::vector<Detection>> DetectionsOfPictures(const Evaluation& evaluation,
                                                         const DatasetIndex& index,
                                                         const std::filesystem::path& file,
                                                         const DetectionsFile& detections);

}  // namespace retrolux
