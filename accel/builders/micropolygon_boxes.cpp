#include "accel/builders/micropolygon_boxes.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace trapeze {

void boxes_of_grid(const Grid& grid, const Frame& frame, float time01, uint32_t first_id, SahItem* items) {
    V3f vertices[kMaxGridVertices];
    for (int j = 0; j <= grid.shape.nv; ++j)
        for (int i = 0; i <= grid.shape.nu; ++i)
            vertices[grid.shape.row_index(i, j)] = frame.from_space(grid.vertex(i, j, time01));
    const int row = grid.shape.vertices_u();
    for (int v = 0; v < grid.shape.nv; ++v)
        for (int u = 0; u < grid.shape.nu; ++u, ++items) {
            const V3f* q = vertices + v * row + u;
            Box3f box;
            for (const V3f& p : {q[0], q[1], q[row], q[row + 1]}) box.extendBy(p);
            *items = {box, 1, first_id++};
        }
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
            ids[id] = {static_cast<uint32_t>(g), static_cast<uint8_t>(i % grid.shape.nu),
                       static_cast<uint8_t>(i / grid.shape.nu)};
            // A huge box would make all costs of the SAH infinite; such grids are bounded by their rounding
            // anyhow.
            if (!std::isfinite(summaries[g].absolute_max)) items[id].box = Box3f(V3f(0), V3f(0));
        }
    });
}

}  // namespace trapeze
