/// Which method suits a scene, and why, in words; from the figures alone.
#pragma once

#include <string>
#include <vector>

#include "pipeline/compare/comparison.h"

namespace trapeze {

/// Sentences; the last one says which method to take: the fastest, or the baseline where it is as fast.
/// References take no part.
std::vector<std::string> judge(const Comparison& comparison);

/// Those sentences that follow from counts, sizes and errors alone: the same wherever they are measured.
std::vector<std::string> judge_without_times(const Comparison& comparison);

}  // namespace trapeze
