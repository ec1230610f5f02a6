#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/cli/support/recorded_options.h"
#include "pipeline/compare/comparison.h"

namespace trapeze {

/// The options of a comparison, with what was chosen where the command line left it open. What shall be done
/// with the figures, and what a run may use and reach, is not among them.
std::vector<RecordedOption> recorded_options(const Arguments& arguments, const CompareSettings& settings);

/// The words of a command line that give the options. Empty with *error set where one is not of
/// kReplayedOptions.
std::optional<std::vector<std::string>> words_of(const std::vector<RecordedOption>& options,
                                                 std::string* error);

}  // namespace trapeze
