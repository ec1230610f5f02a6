/// Figures as one table for statistics programs and spreadsheets.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace trapeze {

/// A table of RFC 4180 whose columns are named as the figures' fields in the JSON, units included, and whose
/// numbers are those of the JSON, digit by digit. `figures` is an array of objects; each is a row, or, where
/// it has fields "..._by_round", a row for each round, which the column "round" counts from 1. `common` is an
/// object whose fields are the first columns of all rows. Where a figure has no such field, or no number, the
/// cell is empty.
std::string figures_csv(const nlohmann::ordered_json& common, const nlohmann::ordered_json& figures);

}  // namespace trapeze
