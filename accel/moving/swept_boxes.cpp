#include "accel/moving/swept_boxes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "accel/builders/box_sum.h"
#include "accel/builders/grid_pose.h"
#include "accel/moving/key_boxes.h"
#include "core/motion_keys.h"

namespace trapeze {
namespace {

Box3f infinite_box() {
    const V3f infinity(std::numeric_limits<float>::infinity());
    return {-infinity, infinity};
}

}  // namespace

/// Where grids have one number of keys a product finds micropolygons, and first_ stays empty.
template <class Counts>
void SweptBoxes::lay_out(const Grids& grids, const Counts& counts) {
    const size_t grid_count = grids.grids.size();
    first_of_grid_.resize(grid_count), first_place_of_grid_.resize(grid_count);
    size_t place = 0;
    same_keys_ = grid_count > 0 ? grids.grids[0].key_count : 0;
    for (size_t g = 0; g < grid_count; ++g) {
        const Grid& grid = grids.grids[g];
        first_of_grid_[g] = static_cast<uint32_t>(size_);
        first_place_of_grid_[g] = static_cast<uint32_t>(place);
        if (!counts(g)) continue;
        const auto of_grid = static_cast<size_t>(grid.shape.micropolygon_count());
        size_ += of_grid, place += of_grid * record_size(grid.key_count);
    }
    for (const Grid& grid : grids.grids)
        if (grid.key_count != same_keys_) same_keys_ = 0;
    records_.resize(place * sizeof(Head));
    if (same_keys_ == 0) first_.resize(size_);
}

void SweptBoxes::set_heads(size_t grid, const Grid& of) {
    size_t index = first_of_grid_[grid], place = first_place_of_grid_[grid];
    const size_t step = record_size(of.key_count);
    for (uint8_t v = 0; v < of.shape.nv; ++v)
        for (uint8_t u = 0; u < of.shape.nu; ++u, ++index, place += step) {
            std::construct_at(reinterpret_cast<Head*>(records_.data() + place * sizeof(Head)),
                              Head{static_cast<uint32_t>(grid), u, v, of.key_count});
            if (same_keys_ == 0) first_[index] = static_cast<uint32_t>(place);
        }
}

SweptBoxes::SweptBoxes(const Grids& grids, const std::vector<GridSummary>& summaries) {
    const auto counts = [&](size_t g) { return std::isfinite(summaries[g].absolute_max); };
    lay_out(grids, counts);
    tbb::parallel_for(size_t{0}, grids.grids.size(), [&](size_t g) {
        if (!counts(g)) return;
        const Grid& grid = grids.grids[g];
        set_heads(g, grid);
        Box3f* const boxes = boxes_of_grid(g);
        GridPose pose;
        for (int key = 0; key < grid.key_count; ++key) {
            pose.read(grid, key);
            pose.for_each_box([&](int i, const Box3f& box) {
                std::construct_at(after(boxes + key, i, grid.key_count), grown_for_rounding(box));
            });
        }
    });
}

SweptBoxes::SweptBoxes(const Grids& grids, MiddlePoints* middles) {
    lay_out(grids, [](size_t) { return true; });
    if (middles) middles->at.resize(size());
    const Box3f box = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, grids.grids.size()), Box3f(),
        [&](const auto& range, Box3f of_range) {
            for (size_t g = range.begin(); g < range.end(); ++g) {
                set_heads(g, grids.grids[g]);
                of_range.extendBy(set_boxes(g, grids.grids[g], middles ? middles->at.data() : nullptr));
            }
            return of_range;
        },
        [](Box3f a, const Box3f& b) {
            a.extendBy(b);
            return a;
        });
    if (middles) middles->box = box;
}

Box3f SweptBoxes::set_boxes(size_t grid, const Grid& of, V3f* middles) {
    const int count = of.shape.micropolygon_count();
    Box3f* const boxes = boxes_of_grid(grid);
    GridPose pose;
    float largest = 0;
    for (int key = 0; key < of.key_count; ++key) {
        largest = std::max(largest, pose.read(of, key));
        pose.for_each_box(
            [&](int i, const Box3f& box) { std::construct_at(after(boxes + key, i, of.key_count), box); });
    }
    // One coordinate too large takes the bounds of the whole grid.
    const bool bounded = std::isfinite(largest);
    for (int i = 0; i < (bounded ? 0 : count); ++i)
        std::fill_n(after(boxes, i, of.key_count), of.key_count, infinite_box());
    BoxSum box;
    if (!middles) return box.box();
    const MotionSegment middle = segment_at(0.5f, of.key_count);
    const size_t next = of.key_count > 1 ? 1 : 0;
    V3f* to = middles + first_of_grid_[grid];
    for (int i = 0; i < count; ++i, ++to) {
        const Box3f* const from = after(boxes + middle.index, i, of.key_count);
        const Box3f there = box_between(from[0], from[next], middle.local);
        std::construct_at(to, bounded ? there.min * 0.5f + there.max * 0.5f : V3f(0));
        box.add(*to);
    }
    return box.box();
}

Box3f SweptBoxes::at(size_t index, float time01) const {
    const std::span<const Box3f> all = keys(index);
    if (all.size() == 1) return all[0];
    const MotionSegment s = segment_at(time01, static_cast<int>(all.size()));
    return box_between(all[static_cast<size_t>(s.index)], all[static_cast<size_t>(s.index) + 1], s.local);
}

Box3f SweptBoxes::swept(size_t index) const {
    Box3f box;
    for (const Box3f& key : keys(index)) box.extendBy(key);
    return box;
}

}  // namespace trapeze
