// What the method saw, stage by stage, as pictures for people.
#pragma once

#include <filesystem>
#include <vector>

#include "classifier/detection.h"
#include "classifier/edge_bands.h"
#include "classifier/gradient.h"
#include "classifier/pattern.h"
#include "classifier/robust.h"
#include "classifier/tags.h"

namespace retrolux {

struct Stages {
  const GradientField& field;
  const EdgeBands& bands;
  const std::vector<Pattern>& patterns;
  const std::vector<Detection>& detections;
};

// 01_picture.png   the smoothed picture, brightened (square root of DN)
// 02_slope.png     its slope in standard deviations of the noise, white at 20
// 03_steep.png     the steep pixels, each band in its own colour
// 04_outlines.png  the half-height outlines of the patterns
// 05_edges.png     the straight edges, in turns yellow and blue, and the corners
// 06_names.png     the names with their confidence; ? for a pattern without
void WriteDebugPictures(const std::filesystem::path& folder, const Stages& stages);

// Of the method `robust`: 01 to 03 and 06 as above, and
// 04_outlines.png  the half-height outlines, of dark patterns blue
// 05_fits.png      the best marker's fitted outline: yellow with, red without a name, and the
//                  probability
void WriteDebugPictures(const std::filesystem::path& folder, const GradientField& field,
                        const EdgeBands& bands, const std::vector<JudgedPattern>& judged);

// tags.png: the picture, brightened, with the dark squares that a library found, their first
// corners and ids.
void WriteDebugPictures(const std::filesystem::path& folder, const DigitalImage& image,
                        const std::vector<FoundTag>& tags);

}  // namespace retrolux
