/// Results as JSON values: seconds, counts and bytes, with the unit in the name.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/compare/comparison.h"

namespace trapeze {

nlohmann::ordered_json to_json(const MethodResult& result);
nlohmann::ordered_json to_json(const Machine& machine);
/// Every figure of a comparison, without the pictures.
nlohmann::ordered_json to_json(const Comparison& comparison);

/// What tells the runs of a table apart that is made of several: program, processor, threads.
nlohmann::ordered_json run_columns(const Machine& machine);
/// The figures as a table (pipeline/compare/record/figures_csv.h): a row for each method, sample rate and
/// round.
std::string comparison_csv(const Comparison& comparison);

}  // namespace trapeze
