/// The options that figures and pictures follow from, as files keep them for a run that repeats another one,
/// or goes on with it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/cli/support/arguments.h"
#include "pipeline/compare/comparison.h"
#include "pipeline/compare/record/run_record.h"

namespace trapeze {

/// Long names of these options.
inline constexpr std::array<std::string_view, 12> kReplayedOptions = {
    "samplers",   "pattern", "samples",      "variance", "reference", "repeat",
    "resolution", "crop",    "shading-rate", "seed",     "option",    "simd"};

/// The options of a comparison, with what was chosen where the command line left it open. What shall be done
/// with the figures, and what a run may use and reach, is not among them.
std::vector<RecordedOption> recorded_options(const Arguments& arguments, const CompareSettings& settings);

/// The options of a render that its pixels, or the names and kinds of its files, follow from; the scenes are
/// among them. How much of the machine is used is not, nor what is said meanwhile.
std::vector<RecordedOption> recorded_options(const Arguments& arguments);

/// The words of a command line that give the options. Empty with *error set where one is not of
/// kReplayedOptions.
std::optional<std::vector<std::string>> words_of(const std::vector<RecordedOption>& options,
                                                 std::string* error);

}  // namespace trapeze
