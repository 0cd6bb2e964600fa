// What went wrong, as pictures: parts of the dataset's pictures with the truth and what a method
// says drawn on them.
#pragma once

#include "analysis/evaluation.h"
#include "analysis/report.h"

namespace retrolux {

// Green: border of the marker's visible pixels, with its true name; red: the detection's corners
// and centroid, with the name that it was given. 4 canvas pixels for one; the brightest pixel of
// the part is white.
struct EvaluationGallery {
  std::vector<LabelledPicture> misnamed;         // the most confident first
  std::vector<LabelledPicture> false_positives;  // likewise
  std::vector<LabelledPicture> missed;           // the easiest first: whole ones by SNR
};

// At most `most` of each.
EvaluationGallery MakeEvaluationGallery(const Evaluation& evaluation, const MethodResult& method,
                                        const std::filesystem::path& dataset, size_t most);

}  // namespace retrolux
