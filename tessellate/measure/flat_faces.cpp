#include "tessellate/measure/flat_faces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/grid.h"

namespace trapeze {
namespace {

constexpr int kFlatFacesPerTask = 1024;
/// Of a fine side: how far larger micropolygons may lie beside a face that is not quite flat, and how far
/// values may be from where they belong.
constexpr float kFlatOfSide = 1.0f / 256, kPlaceOfSide = 1.0f / 8;
/// Segments: too many for a grid.
constexpr int kMany = 1 << 16;
/// Of a face's size: opposite sides that differ by rounding alone.
constexpr float kRounding = 1e-6f;

/// By which opposite sides differ; 0 where the face is linear. A bilinear rectangle leaves the two triangles
/// between its corners by a quarter of it, and by a quarter of 1 / (nu nv) of it where it is cut.
V3f twist(std::span<const V3f, 4> corners) {
    return (corners[0] - corners[1]) - (corners[2] - corners[3]);
}

/// Pixels along u and v, of the longer sides, and of the twist; from all sides.
struct RectanglePixels {
    float u, v, twist;
};
RectanglePixels pixels_of(const ScreenMetric& metric, std::span<const V3f, 4> corners) {
    const std::array<V3f, 5> from{corners[0], corners[2], corners[0], corners[1], corners[0]};
    const std::array<V3f, 5> to{corners[1], corners[3], corners[2], corners[3], corners[0] + twist(corners)};
    std::array<PixelLength, 5> lengths;
    metric.of(from, to, lengths);
    const auto counted = [&](size_t i) { return std::max(lengths[i].seen, lengths[i].square_on); };
    return {std::max(counted(0), counted(1)), std::max(counted(2), counted(3)), counted(4)};
}

/// Cross products of the sides at each corner; the longest one tells the plane, also of a rectangle whose
/// sides cross, of which halves turn either way.
struct CornerTurns {
    std::array<V3f, 4> all;
    V3f longest;

    explicit CornerTurns(std::span<const V3f, 4> corners) {
        const V3f bottom = corners[1] - corners[0], top = corners[3] - corners[2];
        const V3f left = corners[2] - corners[0], right = corners[3] - corners[1];
        all = {bottom.cross(left), bottom.cross(right), top.cross(left), top.cross(right)};
        longest = *std::ranges::max_element(all, {}, [](const V3f& turn) { return turn.length(); });
    }
    /// Whether the rectangle turns over within itself, so that its outline is a curve.
    bool are_of_a_fold() const {
        const float least = -kRounding * longest.dot(longest);
        return std::ranges::any_of(all, [&](const V3f& turn) { return turn.dot(longest) < least; });
    }
};

/// Whether a face is flat enough for sides of so many pixels; `corners` key by key.
bool is_flat(const ScreenMetric& metric, std::span<const V3f> corners, bool is_rigid, float fine) {
    for (size_t key = 0; key < corners.size() / 4; ++key) {
        const std::span<const V3f, 4> at(corners.data() + key * 4, 4);
        const V3f across = at[3] - at[0], other = at[2] - at[1], twisted = twist(at);
        const float size = std::max(across.length(), other.length());
        if (twisted.length() <= kRounding * size) continue;
        // Flat at each key need not be flat between them.
        if (!is_rigid) return false;
        const CornerTurns turns(at);
        const auto [u, v, pixels] = pixels_of(metric, at);
        const float pixels_of_one = pixels / twisted.length(), most = kFlatOfSide * fine;
        // A face that is nearly a line lies near it, whatever its normal.
        if (pixels_of_one * turns.longest.length() / size <= most) continue;
        if (turns.are_of_a_fold()) return false;
        const float largest = fine * kLargestFlatTimes;
        const float off = pixels_of_one * std::abs(twisted.dot(turns.longest.normalized())) /
                          (4 * std::max(u / largest, 1.0f) * std::max(v / largest, 1.0f));
        if (!(off <= most)) return false;
    }
    return true;
}

/// From 1 on, also of what is not a number, rounded up.
int whole_number(float number, int most) {
    return number > 1 ? static_cast<int>(std::ceil(std::min(number, static_cast<float>(most)))) : 1;
}

}  // namespace

float flat_times(const PlacedSurface& surface, const ScreenMetric& metric, float fine) {
    if (!surface.surface().has_straight_lines()) return 1;
    std::atomic<bool> all_flat{true};
    const int keys = surface.key_count();
    const bool is_rigid = surface.is_rigid();
    tbb::parallel_for(tbb::blocked_range<int>(0, surface.surface().face_count(), kFlatFacesPerTask),
                      [&](const tbb::blocked_range<int>& range) {
                          EvaluationScratch scratch;
                          for (int face = range.begin(); face < range.end(); ++face) {
                              if (!all_flat.load(std::memory_order_relaxed)) return;
                              if (surface.surface().is_hole(face) || surface.surface().is_linear(face))
                                  continue;
                              const std::span<V3f> corners = scratch.points(3, static_cast<size_t>(4 * keys));
                              surface.positions(face, kFaceCorners, keys, scratch, corners);
                              if (!is_flat(metric, corners, is_rigid, fine))
                                  all_flat.store(false, std::memory_order_relaxed);
                          }
                      });
    return all_flat ? kLargestFlatTimes : 1;
}

bool has_corner_values(const Shape& shape) {
    return std::ranges::any_of(shape.variables.values, [](const Parameter& value) {
        const StorageClass storage = value.declaration.storage;
        return (value.name == "Cs" || value.name == "Os") && storage != StorageClass::Constant &&
               storage != StorageClass::Uniform;
    });
}

std::array<int, 2> FlatCuts::segments(const std::array<V3f, 4>& corners, std::array<int, 2> segments) const {
    const auto [u, v, twisted] = pixels_of(*metric_, corners);
    const float wanted = twisted / (4 * kPlaceOfSide * fine_);
    const float more = std::sqrt(wanted / static_cast<float>(segments[0] * segments[1]));
    if (!(more > 1)) return segments;
    const std::array<float, 2> pixels{u, v};
    for (size_t axis = 0; axis < 2; ++axis) {
        const float all = static_cast<float>(segments[axis]) * more;
        segments[axis] = std::max(segments[axis], whole_number(std::min(all, pixels[axis] / fine_), kMany));
    }
    return segments;
}

std::array<int, 2> FlatCuts::fine_segments(const std::array<V3f, 4>& corners) const {
    const auto [u, v, twisted] = pixels_of(*metric_, corners);
    const int most = kMaxGridSide * static_cast<int>(times_);
    return {whole_number(u / fine_, most), whole_number(v / fine_, most)};
}

}  // namespace trapeze
