#include "accel/moving/swept_boxes.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

#include "accel/builders/micropolygon_boxes.h"
#include "core/motion_keys.h"

namespace trapeze {
namespace {

/// Boxes of all micropolygons of a grid, those at all keys of one after another.
void boxes_at_keys_of_grid(const Grid& grid, Box3f* boxes) {
    std::array<V3f, kMaxGridVertices> vertices;
    for (int key = 0; key < grid.key_count; ++key) {
        for (int j = 0; j <= grid.shape.nv; ++j)
            for (int i = 0; i <= grid.shape.nu; ++i)
                vertices[static_cast<size_t>(grid.shape.row_index(i, j))] = vertex_of_key(grid, key, i, j);
        for_each_box(grid.shape, vertices.data(), [&](int i, const Box3f& box) {
            boxes[i * grid.key_count + key] = grown_for_rounding(box);
        });
    }
}

}  // namespace

SweptBoxes::SweptBoxes(const Grids& grids, const std::vector<GridSummary>& summaries) {
    std::vector<uint32_t> first_of_grid(grids.grids.size());
    size_t boxes = 0;
    for (size_t g = 0; g < grids.grids.size(); ++g) {
        const Grid& grid = grids.grids[g];
        first_of_grid[g] = static_cast<uint32_t>(boxes);
        if (!std::isfinite(summaries[g].absolute_max)) continue;
        for (int i = 0; i < grid.shape.micropolygon_count(); ++i) {
            first_.push_back(static_cast<uint32_t>(boxes));
            ids_.push_back(micropolygon_of_grid(g, grid.shape, i));
            boxes += grid.key_count;
        }
    }
    first_.push_back(static_cast<uint32_t>(boxes));
    boxes_.resize(boxes);
    tbb::parallel_for(size_t{0}, grids.grids.size(), [&](size_t g) {
        if (std::isfinite(summaries[g].absolute_max))
            boxes_at_keys_of_grid(grids.grids[g], boxes_.data() + first_of_grid[g]);
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
