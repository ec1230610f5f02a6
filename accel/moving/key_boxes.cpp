#include "accel/moving/key_boxes.h"

#include <algorithm>
#include <array>

#include "core/hyper_trapezoid.h"
#include "core/motion_keys.h"

namespace trapeze {
namespace {

Box3f between(const Box3f& a, const Box3f& b, float way) {
    return {a.min + (b.min - a.min) * way, a.max + (b.max - a.max) * way};
}

/// Fewer keys: a box at each, and what must be added to both ends of a segment for all boxes within.
void fewer_keys(std::span<const Box3f> from, std::span<Box3f> to) {
    const size_t step = (from.size() - 1) / (to.size() - 1);
    for (size_t key = 0; key < to.size(); ++key) to[key] = from[key * step];
    std::array<V3f, kMaxKeyCount> below, above;  // what boxes lack
    std::fill_n(below.begin(), to.size(), V3f(0));
    std::fill_n(above.begin(), to.size(), V3f(0));
    for (size_t i = 0; i < from.size(); ++i) {
        const size_t key = i / step;
        if (i % step == 0) continue;
        const Box3f line = between(from[key * step], from[(key + 1) * step],
                                   static_cast<float>(i % step) / static_cast<float>(step));
        for (int k = 0; k < 3; ++k)
            for (const size_t end : {key, key + 1}) {
                below[end][k] = std::max(below[end][k], line.min[k] - from[i].min[k]);
                above[end][k] = std::max(above[end][k], from[i].max[k] - line.max[k]);
            }
    }
    // The line between two ends moves out by at least the smaller of what they move by.
    for (size_t key = 0; key < to.size(); ++key) to[key].min -= below[key], to[key].max += above[key];
}

}  // namespace

void keyed_boxes(std::span<const Box3f> from, std::span<Box3f> to) {
    if (to.size() == 1) {
        to[0] = Box3f();
        for (const Box3f& box : from) to[0].extendBy(box);
    } else if (to.size() == from.size()) {
        std::ranges::copy(from, to.begin());
    } else if (to.size() < from.size()) {
        fewer_keys(from, to);
    } else {
        // Each key of `from` is one of `to`, as both are 2^m + 1: boxes linear between more keys are no
        // larger.
        for (size_t key = 0; key < to.size(); ++key) {
            const MotionSegment s = segment_at(static_cast<float>(key) / static_cast<float>(to.size() - 1),
                                               static_cast<int>(from.size()));
            const auto at = static_cast<size_t>(s.index);
            to[key] = from.size() == 1 ? from[0] : between(from[at], from[at + 1], s.local);
        }
    }
    for (Box3f& box : to) box = grown_for_rounding(box);
}

}  // namespace trapeze
