// What the other markers of a picture say of a name, by their size and polarity. The markers of one
// mask are nearly equally far from a camera, so that their squares have nearly the same size in its
// picture; parts of markers, strips and glints that look like a marker look like one of any size.
#pragma once

#include "classifier/robust.h"

namespace retrolux {

// Weighs all patterns by the others and gives those names that are then likely enough
// (`min_probability`), takes those away that are not, and sets Detection::confidence. Sizes are
// compared with the median of the other named patterns, shapes of three and four edges apart, which
// are what has to be weighed. Without such others nothing changes. Of patterns over one another the
// likeliest is named, and those without a name in it are dropped.
void NameByConsensus(const std::vector<ShapeModel>& models, double min_probability,
                     std::vector<JudgedPattern>& judged);

// The logarithm of the odds that a size adds to a name's: `deviation` is the logarithm of the size
// over that of `witnesses` others, `sizes` the number of sizes that the pattern may have and of
// which the nearest is taken (a triangle looks the same from each of its corners). The density of
// right names over that of wrong ones, each figure from the training pictures
// (docs/identification.md).
double SizeLogOdds(double deviation, size_t sizes, size_t witnesses);

}  // namespace retrolux
