/// A part of the study of spatial splits: trees that are refitted from frame to frame [Gruenschloss11 figure
/// 5].
#pragma once

#include "pipeline/study/study_bench.h"

namespace trapeze {

/// What the study's scenes are offered as.
inline constexpr const char* kHairOverFrames = "Hairball over frames";

/// Follows turning and flying hair with trees that are refitted, beside those that are built anew: what they
/// cost by the surface area heuristic, as a plot and a check.
void add_refitting(StudyBench& bench, StudyResult& result);

}  // namespace trapeze
