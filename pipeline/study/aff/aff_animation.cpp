#include "pipeline/study/aff/aff_animation.h"

#include <algorithm>
#include <cmath>

namespace trapeze {

AffSpans common_spans(const AffSpans& a, const AffSpans& b) {
    AffSpans common;
    for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const AffSpan both{std::max(a[i].begin, b[j].begin), std::min(a[i].end, b[j].end)};
        if (both.begin < both.end) common.push_back(both);
        if (a[i].end < b[j].end)
            ++i;
        else
            ++j;
    }
    return common;
}

double nearest_in_spans(const AffSpans& spans, double time) {
    const auto after = std::ranges::upper_bound(spans, time, {}, &AffSpan::begin);
    const auto nearer = [&](double one, double other) {
        return std::abs(one - time) <= std::abs(other - time) ? one : other;
    };
    if (after == spans.begin()) return spans.empty() ? time : after->begin;
    const double before = std::min(time, std::prev(after)->end);
    return after == spans.end() ? before : nearer(before, after->begin);
}

M44d AffAnimation::matrix_at(double time) const {
    M44d matrix;
    if (scale) matrix.setScale(scale->at(time));
    if (rotation) matrix = matrix * rotation->at(time).toMatrix44();
    if (translation) matrix = matrix * M44d().setTranslation(translation->at(time));
    return matrix;
}

AffSpans visible_spans(const std::vector<AffVisibilityKey>& keys) {
    AffSpans spans{AffSpan()};
    bool visible = true;
    for (const AffVisibilityKey& key : keys) {
        if (key.visible == visible) continue;
        if (key.visible) {
            // Hidden for no time: as if it had never been.
            if (!spans.empty() && spans.back().end == key.time)
                spans.back().end = AffSpan().end;
            else
                spans.push_back({key.time, AffSpan().end});
        } else if (spans.back().begin == key.time) {
            spans.pop_back();
        } else {
            spans.back().end = key.time;
        }
        visible = key.visible;
    }
    return spans;
}

}  // namespace trapeze
