/// A study for people: on the terminal, as JSON, and as one HTML file that needs no network.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/study/study_result.h"

namespace trapeze {

std::string study_text(const StudyResult& result);
nlohmann::ordered_json study_json(const StudyResult& result);
std::string study_html(const StudyResult& result);

}  // namespace trapeze
