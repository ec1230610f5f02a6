/// The options that figures and pictures follow from, as files keep them for a run that repeats another one,
/// or goes on with it.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "pipeline/checkpoint/run_record.h"
#include "pipeline/cli/support/arguments.h"

namespace trapeze {

/// The options that a comparison's figures follow from, by their long names.
inline constexpr std::array<std::string_view, 12> kReplayedOptions = {
    "samplers",   "pattern", "samples",      "variance", "reference", "repeat",
    "resolution", "crop",    "shading-rate", "seed",     "option",    "simd"};

/// The one option of several values: "0 .5 0 1".
inline constexpr std::string_view kCrop = "crop";

/// The options of a render that its pixels, or the names and kinds of its files, follow from; the scenes are
/// among them. How much of the machine is used is not, nor what is said meanwhile.
std::vector<RecordedOption> recorded_options(const Arguments& arguments);

}  // namespace trapeze
