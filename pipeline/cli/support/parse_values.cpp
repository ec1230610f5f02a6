#include "pipeline/cli/support/parse_values.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "core/picture_tile.h"

namespace trapeze {
namespace {

template <class Number>
std::optional<Number> number(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

/// "AxB" with both in [low, high].
std::optional<std::pair<int, int>> pair_of(std::string_view text, int low, int high) {
    const size_t cross = text.find_first_of("xX");
    if (cross == std::string_view::npos) return {};
    const auto a = number<int>(text.substr(0, cross)), b = number<int>(text.substr(cross + 1));
    if (!a || !b || *a < low || *a > high || *b < low || *b > high) return {};
    return {{*a, *b}};
}

/// The number that a text begins with, and what follows.
std::optional<std::pair<double, std::string_view>> number_and_unit(std::string_view text) {
    size_t digits = 0;
    while (digits < text.size() &&
           (std::isdigit(static_cast<unsigned char>(text[digits])) || text[digits] == '.'))
        ++digits;
    const auto value = number<double>(text.substr(0, digits));
    if (!value || !(*value > 0)) return {};
    return {{*value, text.substr(digits)}};
}

}  // namespace

std::optional<size_t> parse_size(std::string_view text) {
    const auto parts = number_and_unit(text);
    if (!parts) return {};
    auto [value, unit] = *parts;
    double scale = 1;
    if (!unit.empty()) {
        const size_t power = std::string_view("KMGT").find(static_cast<char>(std::toupper(unit[0])));
        if (power == std::string_view::npos) return {};
        for (size_t i = 0; i <= power; ++i) scale *= 1024;
        unit.remove_prefix(1);
        if (unit != "" && unit != "B" && unit != "iB") return {};
    }
    const double bytes = value * scale;
    if (bytes > 1e18) return {};
    return static_cast<size_t>(bytes);
}

std::optional<double> parse_duration(std::string_view text) {
    constexpr double kMost = 1e9;  // thirty years
    const auto parts = number_and_unit(text);
    if (!parts) return {};
    const auto& [value, unit] = *parts;
    const double scale = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
    if (scale == 0 || value * scale > kMost) return {};
    return value * scale;
}

std::optional<std::pair<int, int>> parse_resolution(std::string_view text) {
    return pair_of(text, 1, kMostPixelsOfSide);
}

std::optional<std::pair<int, int>> parse_tiles(std::string_view text) {
    return pair_of(text, 1, kMostTilesOfSide);
}

std::optional<std::pair<int, int>> parse_samples(std::string_view text) {
    if (const auto n = number<int>(text))
        return *n >= 1 && *n <= 64 ? std::optional(std::pair{*n, *n}) : std::nullopt;
    return pair_of(text, 1, 64);
}

std::optional<SampleRates> parse_sample_rates(std::string_view text) {
    const size_t dots = text.find("..");
    if (dots == std::string_view::npos) {
        const auto most = parse_samples(text);
        return most ? std::optional(SampleRates{{}, *most}) : std::nullopt;
    }
    const auto least = parse_samples(text.substr(0, dots)), most = parse_samples(text.substr(dots + 2));
    if (!least || !most) return {};
    for (const int times : {2, 4})
        if (most->first == times * least->first && most->second == times * least->second &&
            least->first > 1 && least->second > 1)
            return SampleRates{least, *most};
    return {};
}

std::optional<std::vector<std::pair<int, int>>> parse_samples_list(std::string_view text) {
    constexpr std::string_view kSeparators = ",; ";
    std::vector<std::pair<int, int>> list;
    for (size_t begin = text.find_first_not_of(kSeparators); begin != std::string_view::npos;
         begin = text.find_first_not_of(kSeparators, begin)) {
        const size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
        const auto samples = parse_samples(text.substr(begin, end - begin));
        if (!samples) return {};
        if (std::find(list.begin(), list.end(), *samples) == list.end()) list.push_back(*samples);
        begin = end;
    }
    if (list.empty()) return {};
    return list;
}

std::optional<std::vector<FrameRange>> parse_frames(std::string_view text) {
    std::vector<FrameRange> ranges;
    while (true) {
        const size_t comma = text.find(',');
        std::string_view item = text.substr(0, comma);
        FrameRange range;
        if (const size_t step = item.find('x'); step != std::string_view::npos) {
            const auto value = number<int>(item.substr(step + 1));
            if (!value || *value < 1) return {};
            range.step = *value;
            item = item.substr(0, step);
        }
        const size_t dash = item.find('-', 1);
        const auto first = number<int>(item.substr(0, dash));
        const auto last = dash == std::string_view::npos ? first : number<int>(item.substr(dash + 1));
        if (!first || !last || *last < *first) return {};
        range.first = *first, range.last = *last;
        ranges.push_back(range);
        if (comma == std::string_view::npos) return ranges;
        text.remove_prefix(comma + 1);
    }
}

}  // namespace trapeze
