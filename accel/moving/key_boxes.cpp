#include "accel/moving/key_boxes.h"

#include <algorithm>
#include <array>

#include "core/hyper_trapezoid.h"
#include "core/motion_keys.h"

namespace trapeze {
namespace {

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
        const Box3f line = box_between(from[key * step], from[(key + 1) * step],
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

Box3f box_between(const Box3f& a, const Box3f& b, float way) {
    return {a.min + (b.min - a.min) * way, a.max + (b.max - a.max) * way};
}

void add_at_keys(std::span<const Box3f> from, std::span<BoxSum> to) {
    const size_t keys = to.size();
    if (from.size() == keys) {
        for (size_t key = 0; key < keys; ++key) to[key].add(from[key]);
    } else if (keys == 1) {
        for (const Box3f& box : from) to[0].add(box);
    } else if (from.size() == 1) {
        const BoxLanes box(from[0]);
        for (BoxSum& sum : to) sum.add(box);
    } else if (keys < from.size()) {
        std::array<Box3f, kMaxKeyCount> fewer;
        fewer_keys(from, std::span(fewer).first(keys));
        for (size_t key = 0; key < keys; ++key) to[key].add(grown_for_rounding(fewer[key]));
    } else {
        // Each key of `from` is one of `to`, as both are 2^m + 1: boxes linear between more keys are no
        // larger. The last key is the end of the last segment.
        const size_t segments = from.size() - 1, step = (keys - 1) / segments;
        for (size_t s = 0, key = 0; s < segments; ++s) {
            const BoxLanes a(from[s]), b(from[s + 1]);
            const BoxLanes way(b.low - a.low, b.high - a.high);
            for (size_t i = 0; i < step + (s + 1 == segments); ++i, ++key) {
                const float local = static_cast<float>(i) / static_cast<float>(step);
                to[key].add(BoxLanes(a.low + way.low * local, a.high + way.high * local));
            }
        }
    }
}

}  // namespace trapeze
