#include "pipeline/compare/record/figures_csv.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "pipeline/frame/json_text.h"

namespace trapeze {
namespace {

using json = nlohmann::ordered_json;

constexpr std::string_view kByRound = "_by_round", kRound = "round";

bool is_by_round(const std::string& field, const json& value) {
    return field.ends_with(kByRound) && value.is_array();
}

/// A value as a cell: texts in quotes where they need them, numbers as the JSON has them.
std::string cell(const json& value) {
    if (value.is_null()) return {};
    std::string text = json_text(value, -1);
    if (text == "null") return {};  // what is no number, as NaN
    if (!value.is_string()) return text;
    text = json::parse(text).get<std::string>();  // of valid UTF-8
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

/// Names in the order in which they come first; "round" before the first that is by round.
std::vector<std::string> columns_of(const json& common, const json& figures) {
    std::vector<std::string> names;
    const auto add = [&names](std::string_view name) {
        if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
    };
    for (const auto& [name, value] : common.items()) add(name);
    for (const json& figure : figures)
        for (const auto& [name, value] : figure.items()) {
            if (is_by_round(name, value)) add(kRound);
            add(name);
        }
    return names;
}

/// How many rows a figure takes.
size_t rounds_of(const json& figure) {
    size_t rounds = 1;
    for (const auto& [name, value] : figure.items())
        if (is_by_round(name, value)) rounds = std::max(rounds, value.size());
    return rounds;
}

std::string cell_of(const json& common, const json& figure, const std::string& column, size_t round) {
    if (const auto found = common.find(column); found != common.end()) return cell(*found);
    const auto found = figure.find(column);
    if (found == figure.end()) {
        const auto has_rounds = [](const auto& item) { return is_by_round(item.key(), item.value()); };
        const auto items = figure.items();
        const bool is_round = column == kRound && std::any_of(items.begin(), items.end(), has_rounds);
        return is_round ? std::to_string(round + 1) : std::string();
    }
    if (!is_by_round(column, *found)) return cell(*found);
    return round < found->size() ? cell((*found)[round]) : std::string();
}

}  // namespace

std::string figures_csv(const json& common, const json& figures) {
    constexpr const char* kLineEnd = "\r\n";
    const std::vector<std::string> columns = columns_of(common, figures);
    std::string text;
    const auto add_cell = [&](const std::string& column, const std::string& value) {
        text += (column == columns.front() ? "" : ",") + value;
    };
    for (const std::string& column : columns) add_cell(column, cell(column));
    text += kLineEnd;
    for (const json& figure : figures)
        for (size_t round = 0; round < rounds_of(figure); ++round) {
            for (const std::string& column : columns)
                add_cell(column, cell_of(common, figure, column, round));
            text += kLineEnd;
        }
    return text;
}

}  // namespace trapeze
