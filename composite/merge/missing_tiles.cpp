#include "composite/merge/missing_tiles.h"

#include <algorithm>
#include <set>
#include <utility>

namespace trapeze {
namespace {

using Span = std::pair<int64_t, int64_t>;  ///< from, to; `to` is not in it

/// What of `whole` no span has. Sorts the spans.
std::vector<Span> gaps_in(const Span& whole, std::vector<Span>& spans) {
    std::ranges::sort(spans);
    std::vector<Span> gaps;
    int64_t seen = whole.first;
    for (const auto& [from, to] : spans) {
        if (from > seen) gaps.emplace_back(seen, from);
        seen = std::max(seen, to);
    }
    if (seen < whole.second) gaps.emplace_back(seen, whole.second);
    return gaps;
}

}  // namespace

std::vector<int> missing_numbers(const std::vector<PictureTile>& tiles) {
    std::vector<int> missing;
    if (tiles.empty()) return missing;
    std::set<int> there;
    for (const PictureTile& tile : tiles) there.insert(tile.number);
    for (int number = 1; number <= tiles.front().count(); ++number)
        if (!there.contains(number)) missing.push_back(number);
    return missing;
}

std::vector<Box2i> gaps_between(const std::vector<Box2i>& windows, size_t most) {
    std::vector<Box2i> gaps;
    Box2i all;
    std::set<int64_t> borders;
    for (const Box2i& window : windows) {
        all.extendBy(window);
        borders.insert({window.min.y, int64_t{window.max.y} + 1});
    }
    // Between two borders all rows have the same gaps.
    for (auto top = borders.begin(); top != borders.end() && gaps.size() < most; ++top) {
        const auto bottom = std::next(top);
        if (bottom == borders.end()) break;
        std::vector<Span> spans;
        for (const Box2i& window : windows)
            if (window.min.y <= *top && window.max.y >= *top)
                spans.emplace_back(window.min.x, int64_t{window.max.x} + 1);
        for (const auto& [from, to] : gaps_in({all.min.x, int64_t{all.max.x} + 1}, spans))
            if (gaps.size() < most)
                gaps.emplace_back(V2i(static_cast<int>(from), static_cast<int>(*top)),
                                  V2i(static_cast<int>(to - 1), static_cast<int>(*bottom - 1)));
    }
    return gaps;
}

std::string listed(const std::vector<int>& numbers) {
    std::string text;
    for (size_t i = 0; i < numbers.size();) {
        size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (last == i + 1) last = i;  // two are listed one by one
        const bool is_end = last + 1 == numbers.size();
        text += (i == 0 ? "" : is_end ? " and " : ", ") + std::to_string(numbers[i]);
        if (last > i) text += " to " + std::to_string(numbers[last]);
        i = last + 1;
    }
    return text;
}

}  // namespace trapeze
