#include "accel/builders/micropolygon_boxes.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace trapeze {

void boxes_of_grid(const Grid& grid, const Frame& frame, float time01, uint32_t first_id, SahItem* items) {
    V3f vertices[kMaxGridVertices];
    for (int j = 0; j <= grid.shape.nv; ++j)
        for (int i = 0; i <= grid.shape.nu; ++i)
            vertices[grid.shape.row_index(i, j)] = frame.from_space(grid.vertex(i, j, time01));
    for_each_box(grid.shape, vertices, [&](int i, const Box3f& box) {
        items[i] = {box, 1, first_id + static_cast<uint32_t>(i)};
    });
}

void micropolygon_items(const Grids& grids, const std::vector<GridSummary>& summaries,
                        std::vector<MicropolygonId>& ids, std::vector<SahItem>& items) {
    std::vector<uint32_t> first(grids.grids.size());
    uint32_t count = 0;
    for (size_t g = 0; g < first.size(); ++g) {
        first[g] = count;
        count += static_cast<uint32_t>(grids.grids[g].shape.micropolygon_count());
    }
    ids.resize(count);
    items.resize(count);
    tbb::parallel_for(size_t{0}, first.size(), [&](size_t g) {
        const Grid& grid = grids.grids[g];
        boxes_of_grid(grid, Frame{}, 0.5f, first[g], items.data() + first[g]);
        for (int i = 0; i < grid.shape.micropolygon_count(); ++i) {
            const uint32_t id = first[g] + static_cast<uint32_t>(i);
            ids[id] = micropolygon_of_grid(g, grid.shape, i);
            // A huge box would make all costs of the SAH infinite; such grids are bounded by their rounding
            // anyhow.
            if (!std::isfinite(summaries[g].absolute_max)) items[id].box = Box3f(V3f(0), V3f(0));
        }
    });
}

}  // namespace trapeze
