/// Results as JSON values: seconds, counts and bytes, with the unit in the name.
#pragma once

#include <nlohmann/json.hpp>

#include "pipeline/compare/comparison.h"

namespace trapeze {

nlohmann::ordered_json to_json(const MethodResult& result);
nlohmann::ordered_json to_json(const Machine& machine);
/// Every figure of a comparison, without the pictures.
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace trapeze
