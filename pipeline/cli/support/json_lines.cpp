#include "pipeline/cli/support/json_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "pipeline/frame/json_text.h"

namespace trapeze {
namespace {

using json = nlohmann::ordered_json;

/// Takes ":12" from the end.
std::optional<int> take_number(std::string& place) {
    const size_t colon = place.rfind(':');
    if (colon == std::string::npos || colon + 1 == place.size()) return {};
    int number = 0;
    const char* const last = place.data() + place.size();
    const auto [end, error] = std::from_chars(place.data() + colon + 1, last, number);
    if (error != std::errc() || end != last) return {};
    place.resize(colon);
    return number;
}

double rounded(double seconds) {
    return std::round(seconds * 1000) / 1000;
}

}  // namespace

std::string json_line(const Diagnostic& diagnostic) {
    static constexpr const char* kSeverities[] = {"note", "warning", "error"};
    json object{{"severity", kSeverities[static_cast<int>(diagnostic.severity)]},
                {"file", nullptr},
                {"line", nullptr},
                {"column", nullptr},
                {"message", diagnostic.text}};
    std::string file = diagnostic.place;
    const std::optional<int> column = take_number(file);
    if (const std::optional<int> line = column ? take_number(file) : std::nullopt)
        object["line"] = *line, object["column"] = *column;
    else
        file = diagnostic.place;
    if (!file.empty()) object["file"] = file;
    if (!diagnostic.included_from.empty()) object["included_from"] = diagnostic.included_from;
    return json_text(object, -1) + "\n";
}

std::string json_line(const Work& work, double fraction, double seconds, const std::string& waiting) {
    json object{{"frame", nullptr},
                {"file", work.file},
                {"stage", work.stage},
                {"fraction", rounded(fraction)},
                {"seconds", rounded(seconds)},
                {"estimate", nullptr}};
    if (work.frame != 0) object["frame"] = work.frame;
    if (fraction > 0) object["estimate"] = rounded(std::max(0.0, seconds / fraction - seconds));
    if (!waiting.empty()) object["waiting"] = waiting;
    return json_text(object, -1) + "\n";
}

}  // namespace trapeze
