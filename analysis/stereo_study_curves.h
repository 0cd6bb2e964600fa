// The part of the stereo study's report that looks at errors over the separation of the cameras.
#pragma once

#include "analysis/report.h"
#include "analysis/stereo_study.h"

namespace retrolux {

// For each target its errors; all beside the thesis's curve; how many markers are found at all.
void AddErrorCurves(const StereoStudy& study, Report& report);

}  // namespace retrolux
