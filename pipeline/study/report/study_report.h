/// A study for people: on the terminal, as JSON, and as one HTML file that needs no network.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pipeline/study/study_result.h"

namespace trapeze {

/// Tables and checks for a terminal.
std::string study_text(const StudyResult& result);
/// Every figure, and what it takes to measure it again.
nlohmann::ordered_json study_json(const StudyResult& result);
/// Every single measurement as a table (pipeline/compare/record/figures_csv.h).
std::string study_csv(const StudyResult& result);
/// The whole file's text, plots included.
std::string study_html(const StudyResult& result);

}  // namespace trapeze
