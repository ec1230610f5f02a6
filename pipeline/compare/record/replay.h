/// Whether a comparison that is repeated gives the figures that were recorded.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/checkpoint/run_record.h"

namespace trapeze {

/// What "program" is in the JSON of `trapeze compare`.
inline constexpr std::string_view kCompareProgram = "trapeze compare";

/// A comparison's JSON that was read again.
struct RecordedComparison {
    std::vector<std::string> scenes;      ///< the command line's files, in order
    std::vector<RecordedOption> options;  ///< names and values are not checked
    std::vector<InputFile> inputs;
    std::string version;   ///< of the program that wrote it
    nlohmann::json whole;  ///< all of it
};

/// Reads what `trapeze compare --json` wrote. Empty with *error set when it is anything else.
std::optional<RecordedComparison> read_recorded(std::string_view text, std::string* error);

/// How two comparisons' figures are alike.
struct ReplayOutcome {
    size_t compared = 0;                   ///< figures
    std::vector<std::string> differences;  ///< `raytrace at 4x4: "rmse" was 0.1, is 0.2`
};

/// Compares all figures of two JSONs of comparisons, exactly, but for times, what follows from them, and the
/// machine.
ReplayOutcome compare_figures(const nlohmann::json& recorded, const nlohmann::json& now);

/// What is not as it was: a sentence for each file that has changed, is gone, or is read only now.
std::vector<std::string> changed_inputs(const std::vector<InputFile>& recorded,
                                        const std::vector<InputFile>& now);

}  // namespace trapeze
