#include "sample/rasterize/grid_bounds.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// A vertex this much nearer than the grid is large would be divided by a depth of which little is known.
constexpr float kLeastRelativeDepth = 0x1p-14f;

/// The least depth that is divided by: keeps reciprocals finite.
constexpr float kLeastDepth = 1e-20f;

/// An interval of numbers, in double: what is bounded here was rounded in float, and slack covers that alone.
struct Range {
    double min, max;

    void add(double at) { min = std::min(min, at), max = std::max(max, at); }
};

/// The least and greatest product of two intervals, whatever their signs.
Range product(const Range& a, const Range& b) {
    const double p[4] = {a.min * b.min, a.min * b.max, a.max * b.min, a.max * b.max};
    return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
}

/// Raster coordinates of a range of the image plane, along an axis; either may run against the other.
Range to_raster(const Range& plane, double scale, double offset) {
    const double a = (plane.min - offset) / scale, b = (plane.max - offset) / scale;
    return {std::min(a, b), std::max(a, b)};
}

/// See RoundingSlack. The predicate's offsets from a vertex round relative to coordinates, lens and slopes
/// times depth; positions at a time, relative to coordinates; the raster's own, relative to its reach.
GridBound bound_of(const Camera& camera, double absolute_max, double z_min) {
    const double radius = camera.lens_radius, in_focus = 1.0 / camera.focal_distance,
                 reach = ray_reach(camera);
    GridBound bound;
    bound.z_min = static_cast<float>(z_min);
    bound.z_rounding = static_cast<float>(kRasterRounding * absolute_max);
    if (camera.perspective) {
        bound.slack.near = static_cast<float>(kRasterRounding * (absolute_max * (1 + reach) + radius));
        bound.slack.far = static_cast<float>(kRasterRounding * 2 * reach);
        bound.z_safe =
            std::max({camera.near_clip, static_cast<float>(absolute_max) * kLeastRelativeDepth, kLeastDepth});
    } else {
        bound.slack.far =
            static_cast<float>(kRasterRounding * (absolute_max * (1 + radius * in_focus) + 2 * reach));
        bound.z_safe = -std::numeric_limits<float>::infinity();
    }
    bound.boundable = absolute_max < kBoundable;
    return bound;
}

}  // namespace

/// A span that ends within a segment covers a part of it; of those between first and last, all.
void segment_parts(const TimeSpan& time, int key_count, std::vector<SegmentPart>& parts) {
    const MotionSegment first = segment_at(time.min, key_count), last = segment_at(time.max, key_count);
    for (int segment = first.index; segment <= last.index; ++segment)
        parts.push_back({segment, segment == first.index ? first.local : 0.0f,
                         segment == last.index ? last.local : 1.0f});
}

/// Grids write to places of their own, which are known beforehand: no lock, and the same result for any
/// number of threads.
GridBounds::GridBounds(const Camera& camera, const Grids& grids)
    : camera_(camera), bounds_(grids.grids.size()), first_segment_(grids.grids.size()) {
    size_t segments = 0;
    for (size_t i = 0; i < bounds_.size(); ++i) {
        first_segment_[i] = segments;
        segments += static_cast<size_t>(segment_count(grids.grids[i].key_count));
    }
    segments_.resize(segments);
    tbb::parallel_for(size_t{0}, bounds_.size(), [&](size_t i) { bound_grid(grids.grids[i], i); });
}

/// One box for each segment's start and end: within a segment vertices move along lines, so the box at a time
/// between is within the mix of the two. Threads bound different grids, and write to places of their own.
void GridBounds::bound_grid(const Grid& grid, size_t index) {
    double absolute_max = 0, z_min = 1e300;
    const auto size = static_cast<size_t>(grid.shape.plane_size());  // padding repeats vertices
    for (int segment = 0; segment < segment_count(grid.key_count); ++segment) {
        SegmentBox& box = segments_[first_segment_[index] + static_cast<size_t>(segment)];
        for (int axis = 0; axis < 3; ++axis) {
            const float* start = grid.plane(segment, axis);
            const auto [low, high] = std::minmax_element(start, start + size);
            box.min[0][axis] = box.min[1][axis] = *low, box.max[0][axis] = box.max[1][axis] = *high;
            if (grid.moves()) {
                const float* delta = grid.plane(segment, 3 + axis);
                float end_low = position_at(start[0], delta[0], 1), end_high = end_low;
                for (size_t i = 1; i < size; ++i) {
                    const float end = position_at(start[i], delta[i], 1);
                    end_low = std::min(end_low, end), end_high = std::max(end_high, end);
                }
                box.min[1][axis] = end_low, box.max[1][axis] = end_high;
            }
            for (int end = 0; end < 2; ++end)
                absolute_max = std::max({absolute_max, std::abs(double{box.min[end][axis]}),
                                         std::abs(double{box.max[end][axis]})});
        }
        z_min = std::min({z_min, double{box.min[0].z}, double{box.min[1].z}});
    }
    bounds_[index] = bound_of(camera_, absolute_max, z_min);
}

/// Interval arithmetic over the boxes at the ends of all parts: place over depth, then the lens' shift by
/// depth times the lens' part, then rounding. Loose, but it is asked for each grid, tile and slot.
SlotBound GridBounds::slot_bound(size_t grid, const std::vector<SegmentPart>& parts,
                                 const LensBox& lens) const {
    const GridBound& bound = bounds_[grid];
    Range axis[3] = {{1e300, -1e300}, {1e300, -1e300}, {1e300, -1e300}};
    for (const SegmentPart& part : parts) {
        const SegmentBox& box = segments_[first_segment_[grid] + static_cast<size_t>(part.segment)];
        for (const double at : {double{part.from}, double{part.to}})
            for (int k = 0; k < 3; ++k) {
                axis[k].add(box.min[0][k] + (double{box.min[1][k]} - box.min[0][k]) * at);
                axis[k].add(box.max[0][k] + (double{box.max[1][k]} - box.max[0][k]) * at);
            }
    }
    // From here on the boxes at both ends of all parts are one box, at all of their times.
    const Range& z = axis[2];
    const auto z_min = static_cast<float>(z.min - bound.z_rounding);
    if (!bound.boundable) return {RasterBox::everything(), -std::numeric_limits<float>::infinity()};
    if (!(z.min - bound.z_rounding > bound.z_safe)) return {RasterBox::everything(), z_min};
    const double in_focus = 1.0 / camera_.focal_distance, radius = camera_.lens_radius;
    Range shift{0, 0};  // of the image plane per length on the lens
    double grow = bound.slack.far;
    if (camera_.perspective) {
        const Range inverse{1 / z.max, 1 / z.min};
        for (int k = 0; k < 2; ++k) axis[k] = product(axis[k], inverse);
        shift = {in_focus - inverse.max, in_focus - inverse.min};
        grow += bound.slack.near * inverse.max;
    } else {
        shift = {z.min * in_focus - 1, z.max * in_focus - 1};
    }
    const Range across = product(shift, {lens.min_u * radius, lens.max_u * radius}),
                down = product(shift, {lens.min_v * radius, lens.max_v * radius});
    const Range x = to_raster({axis[0].min + across.min - grow, axis[0].max + across.max + grow},
                              camera_.plane_scale_x, camera_.plane_offset_x);
    const Range y = to_raster({axis[1].min + down.min - grow, axis[1].max + down.max + grow},
                              camera_.plane_scale_y, camera_.plane_offset_y);
    return {{x.min, y.min, x.max, y.max}, z_min};
}

size_t GridBounds::bytes() const {
    return bounds_.capacity() * sizeof(GridBound) + first_segment_.capacity() * sizeof(size_t) +
           segments_.capacity() * sizeof(SegmentBox);
}

}  // namespace trapeze
