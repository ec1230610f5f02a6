#include "tessellate/measure/growth_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/portable_math.h"
#include "tessellate/measure/some_faces.h"

namespace trapeze {
namespace {

/// Growth that is let pass: micropolygons become twice as long.
constexpr float kLetPass = 2;
/// Diagonals of the picture that what has grown is diced for, at most.
constexpr float kMostDiagonals = 2;

/// Lengths of one face: of its sides and across it.
constexpr std::array<V2f, 4> kPlaces{V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1)};
constexpr std::pair<int, int> kLines[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}};

/// How large a space is, the root of the sum of its axes' squares.
float size_of(const M44f& space) {
    float sum = 0;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) sum += space[row][column] * space[row][column];
    return std::sqrt(sum);
}

/// Sums of lengths at each key, of some faces that stand for all; and the longest at shutter open, in pixels.
struct Lengths {
    std::vector<float> sums;
    float longest = 0;
};

Lengths lengths_of(const PlacedSurface& surface, int keys, const ScreenMetric& metric) {
    Lengths lengths{std::vector<float>(static_cast<size_t>(keys))};
    EvaluationScratch scratch;
    std::vector<V3f> P(kPlaces.size() * static_cast<size_t>(keys));
    for_some_faces(surface.surface().face_count(), [&](int face) {
        surface.positions(face, kPlaces, keys, scratch, P);
        for (const auto& [from, to] : kLines) {
            lengths.longest = std::max(lengths.longest, metric.of(P[from], P[to]).square_on);
            for (size_t key = 0; key < lengths.sums.size(); ++key)
                lengths.sums[key] += (P[key * kPlaces.size() + to] - P[key * kPlaces.size() + from]).length();
        }
    });
    return lengths;
}

float growth_of(std::span<const float> sizes) {
    return *std::ranges::max_element(sizes) / sizes.front();
}

}  // namespace

float growth_factor(const PlacedSurface& surface, const Camera& camera, const ScreenMetric& metric) {
    const int keys = surface.key_count();
    if (keys == 1 || surface.surface().face_count() == 0) return 1;
    float growth = 0;
    if (surface.is_rigid()) {
        std::vector<float> sizes;
        for (int key = 0; key < keys; ++key) sizes.push_back(size_of(surface.camera_from_object(key)));
        growth = growth_of(sizes);
        if (!(growth > kLetPass)) return 1;
    }
    const Lengths lengths = lengths_of(surface, surface.is_rigid() ? 1 : keys, metric);
    if (!surface.is_rigid()) growth = growth_of(lengths.sums);
    const float diagonal =
        portable::hypot(static_cast<float>(camera.width), static_cast<float>(camera.height));
    const float most = lengths.longest > 0 ? kMostDiagonals * diagonal / lengths.longest : 1;
    return std::max(1.0f, std::min(growth, most) / kLetPass);  // 1 for NaN
}

}  // namespace trapeze
