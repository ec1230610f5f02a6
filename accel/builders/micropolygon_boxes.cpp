#include "accel/builders/micropolygon_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "accel/builders/grid_pose.h"

namespace trapeze {

namespace {

/// Boxes at a time of what `place` makes of vertices. Each vertex is moved and placed once, and not once for
/// each of the up to four micropolygons around it.
template <class Place>
void boxes_of_placed(const Grid& grid, float time01, uint32_t first_id, SahItem* items, const Place& place) {
    const MotionSegment s = segment_at(time01, grid.moves() ? grid.key_count : 1);
    const auto coordinate = [&](int k, int at) {
        const float start = grid.plane(s.index, k)[at];
        return grid.moves() ? position_at(start, grid.plane(s.index, 3 + k)[at], s.local) : start;
    };
    GridPose pose;
    pose.set(grid.shape, [&](int i, int j) {
        const int at = grid.shape.tiled_index(i, j);
        return place(V3f(coordinate(0, at), coordinate(1, at), coordinate(2, at)));
    });
    pose.for_each_box([&](int i, const Box3f& box) {
        items[i] = {box, 1, first_id + static_cast<uint32_t>(i)};
    });
}

}  // namespace

void boxes_of_grid(const Grid& grid, const Axes& axes, float time01, uint32_t first_id, SahItem* items) {
    boxes_of_placed(grid, time01, first_id, items, [&](const V3f& p) { return axes.from_space(p); });
}

void micropolygon_items(const Grids& grids, const std::vector<GridSummary>& summaries,
                        UnsetVector<MicropolygonId>& ids, UnsetVector<SahItem>& items) {
    std::vector<uint32_t> first(grids.grids.size());
    uint32_t count = 0;
    for (size_t g = 0; g < first.size(); ++g) {
        first[g] = count;
        count += static_cast<uint32_t>(grids.grids[g].shape.micropolygon_count());
    }
    // Every grid has its range of numbers from here on, and grids are filled in in parallel.
    ids.resize(count);
    items.resize(count);
    tbb::parallel_for(size_t{0}, first.size(), [&](size_t g) {
        const Grid& grid = grids.grids[g];
        boxes_of_placed(grid, 0.5f, first[g], items.data() + first[g], [](const V3f& p) { return p; });
        uint32_t id = first[g];
        for (int v = 0; v < grid.shape.nv; ++v)
            for (int u = 0; u < grid.shape.nu; ++u, ++id)
                ids[id] = {static_cast<uint32_t>(g), static_cast<uint8_t>(u), static_cast<uint8_t>(v)};
        // A huge box would make all costs of the SAH infinite; such grids are bounded by their rounding
        // anyhow.
        if (!std::isfinite(summaries[g].absolute_max))
            std::for_each(items.data() + first[g], items.data() + id,
                          [](SahItem& item) { item.box = Box3f(V3f(0), V3f(0)); });
    });
}

}  // namespace trapeze
