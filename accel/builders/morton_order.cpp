#include "accel/builders/morton_order.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/portable_math.h"

namespace trapeze {
namespace {

/// Bits a dimension: five of them fit 64 bits.
constexpr int kBits = 12;

/// Takes [0, 1] to 0 .. 2^kBits - 1. NaN and what lies outside go to the ends, so that every item has a code.
uint32_t quantised(float value) {
    constexpr float kSteps = 1 << kBits;
    const float scaled = value * kSteps;
    return scaled > 0 ? static_cast<uint32_t>(std::min(scaled, kSteps - 1)) : 0u;
}

/// Inverse of the concentric map of the square [-1,1]^2 to the disk [Shirley97]; it keeps relative area.
V2f square_from_disk(const V2f& p) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    if (r == 0) return {0, 0};
    constexpr auto kQuarterPi = static_cast<float>(M_PI / 4);
    if (std::abs(p.x) >= std::abs(p.y)) {
        const float a = std::copysign(r, p.x);
        return {a, std::abs(a) * portable::atan2(p.y, std::abs(p.x)) / kQuarterPi};
    }
    const float b = std::copysign(r, p.y);
    return {std::abs(b) * portable::atan2(p.x, std::abs(p.y)) / kQuarterPi, b};
}

}  // namespace

V2f square_from_direction(const V3f& unit) {
    // An orientation has no sign: the hemisphere of z >= 0 stands for all.
    const V3f up = unit.z < 0 ? -unit : unit;
    // Equal area: a hemisphere's cap of height 1 - z goes to the disk of radius sqrt(1 - z).
    const float planar = std::sqrt(up.x * up.x + up.y * up.y);
    if (!(planar > 0)) return {0.5f, 0.5f};
    const float radius = std::sqrt(std::max(0.0f, 1 - up.z));
    const V2f square = square_from_disk({up.x / planar * radius, up.y / planar * radius});
    return {square.x * 0.5f + 0.5f, square.y * 0.5f + 0.5f};
}

uint64_t orientation_morton_code(const V3f& direction, const V3f& centroid, const Box3f& centroids) {
    const V2f orientation = square_from_direction(direction);
    uint32_t dimension[5] = {quantised(orientation.x), quantised(orientation.y)};
    // Where all centroids share a coordinate this is 0 / 0, which quantised() takes to 0.
    for (int k = 0; k < 3; ++k)
        dimension[2 + k] =
            quantised((centroid[k] - centroids.min[k]) / (centroids.max[k] - centroids.min[k]));
    uint64_t code = 0;
    // From the most significant bit on, one bit of each dimension in turn.
    for (int bit = kBits - 1; bit >= 0; --bit)
        for (const uint32_t d : dimension) code = code << 1 | (d >> bit & 1);
    return code;
}

void sort_by_orientation(std::span<SahItem> items, const std::function<V3f(uint32_t id)>& direction) {
    Box3f centroids;
    for (const SahItem& item : items) centroids.extendBy(item.centroid());
    struct Coded {
        uint64_t code;
        SahItem item;
    };
    std::vector<Coded> coded;
    coded.reserve(items.size());
    for (const SahItem& item : items)
        coded.push_back({orientation_morton_code(direction(item.id), item.centroid(), centroids), item});
    std::sort(coded.begin(), coded.end(), [](const Coded& a, const Coded& b) {
        // Ids differ, so the order is total and does not depend on where the sort begins.
        return std::pair(a.code, a.item.id) < std::pair(b.code, b.item.id);
    });
    for (size_t i = 0; i < items.size(); ++i) items[i] = coded[i].item;
}

}  // namespace trapeze
