#include "accel/moving/swept_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "accel/builders/micropolygon_boxes.h"
#include "core/motion_keys.h"

namespace trapeze {
namespace {

Box3f infinite_box() {
    const V3f infinity(std::numeric_limits<float>::infinity());
    return {-infinity, infinity};
}

}  // namespace

/// Boxes lie micropolygon by micropolygon, all keys of one beside each other. Where grids have one number of
/// keys, a product finds them, and first_ stays empty.
template <class Counts>
void SweptBoxes::lay_out(const Grids& grids, const Counts& counts) {
    const size_t grid_count = grids.grids.size();
    first_of_grid_.resize(grid_count), first_box_of_grid_.resize(grid_count);
    size_t micropolygons = 0, boxes = 0;
    same_keys_ = grid_count > 0 ? grids.grids[0].key_count : 0;
    for (size_t g = 0; g < grid_count; ++g) {
        const Grid& grid = grids.grids[g];
        first_of_grid_[g] = static_cast<uint32_t>(micropolygons);
        first_box_of_grid_[g] = static_cast<uint32_t>(boxes);
        if (!counts(g)) continue;
        const auto of_grid = static_cast<size_t>(grid.shape.micropolygon_count());
        micropolygons += of_grid, boxes += of_grid * grid.key_count;
    }
    for (const Grid& grid : grids.grids)
        if (grid.key_count != same_keys_) same_keys_ = 0;
    ids_ = UnsetArray<MicropolygonId>(micropolygons);
    boxes_ = UnsetArray<Box3f>(boxes);
    if (same_keys_ == 0)
        first_ = UnsetArray<uint32_t>(micropolygons + 1),
        first_.set(micropolygons, static_cast<uint32_t>(boxes));
    tbb::parallel_for(size_t{0}, grid_count, [&](size_t g) {
        if (!counts(g)) return;
        const GridShape& shape = grids.grids[g].shape;
        const auto keys = static_cast<uint32_t>(grids.grids[g].key_count);
        size_t index = first_of_grid_[g];
        uint32_t first = first_box_of_grid_[g];
        for (int v = 0; v < shape.nv; ++v)
            for (int u = 0; u < shape.nu; ++u, ++index, first += keys) {
                ids_.set(index, {static_cast<uint32_t>(g), static_cast<uint8_t>(u), static_cast<uint8_t>(v)});
                if (same_keys_ == 0) first_.set(index, first);
            }
    });
}

SweptBoxes::SweptBoxes(const Grids& grids, const std::vector<GridSummary>& summaries) {
    const auto counts = [&](size_t g) { return std::isfinite(summaries[g].absolute_max); };
    lay_out(grids, counts);
    tbb::parallel_for(size_t{0}, grids.grids.size(), [&](size_t g) {
        if (!counts(g)) return;
        const Grid& grid = grids.grids[g];
        std::array<V3f, kMaxGridVertices> vertices;
        for (int key = 0; key < grid.key_count; ++key) {
            read_vertices(grid, key, vertices.data());
            for_each_box(grid.shape, vertices.data(), [&](int i, const Box3f& box) {
                boxes_.set(first_box_of_grid_[g] + static_cast<size_t>(i * grid.key_count + key),
                           grown_for_rounding(box));
            });
        }
    });
}

SweptBoxes::SweptBoxes(const Grids& grids) {
    lay_out(grids, [](size_t) { return true; });
    tbb::parallel_for(size_t{0}, grids.grids.size(), [&](size_t g) {
        const Grid& grid = grids.grids[g];
        const size_t first = first_box_of_grid_[g];
        std::array<V3f, kMaxGridVertices> vertices;
        float largest = 0;
        for (int key = 0; key < grid.key_count; ++key) {
            largest = std::max(largest, read_vertices(grid, key, vertices.data()));
            for_each_box(grid.shape, vertices.data(), [&](int i, const Box3f& box) {
                boxes_.set(first + static_cast<size_t>(i * grid.key_count + key), box);
            });
        }
        // One coordinate too large takes the bounds of the whole grid.
        if (std::isfinite(largest)) return;
        const auto count = static_cast<size_t>(grid.shape.micropolygon_count() * grid.key_count);
        for (size_t i = 0; i < count; ++i) boxes_.set(first + i, infinite_box());
    });
}

Box3f SweptBoxes::at(size_t index, float time01) const {
    const std::span<const Box3f> all = keys(index);
    if (all.size() == 1) return all[0];
    const MotionSegment s = segment_at(time01, static_cast<int>(all.size()));
    const Box3f &a = all[static_cast<size_t>(s.index)], &b = all[static_cast<size_t>(s.index) + 1];
    return {a.min + (b.min - a.min) * s.local, a.max + (b.max - a.max) * s.local};
}

Box3f SweptBoxes::swept(size_t index) const {
    Box3f box;
    for (const Box3f& key : keys(index)) box.extendBy(key);
    return box;
}

}  // namespace trapeze
