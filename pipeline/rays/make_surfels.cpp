#include "pipeline/rays/make_surfels.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace trapeze {
namespace {

constexpr size_t kSurfelGrain = 16;  // subpatches

int blocks(int micropolygons) {
    return (micropolygons + kSurfelSide - 1) / kSurfelSide;
}

size_t surfels_of(const GridShape& shape) {
    return static_cast<size_t>(blocks(shape.nu) * blocks(shape.nv));
}

/// Sums over the micropolygons of a block.
struct SurfelSums {
    V3f place{0, 0, 0}, vector_area{0, 0, 0};
    float area = 0, hiding_area = 0;

    void add(const Grid& grid, int u, int v) {
        V3f middle(0), opacity(0);
        for (int corner = 0; corner < 4; ++corner) {
            const int i = u + (corner & 1), j = v + (corner >> 1);
            middle += grid.vertex(i, j, 0) * 0.25f, opacity += grid.opacity(i, j) * 0.25f;
        }
        const V3f across = grid.vertex(u + 1, v + 1, 0) - grid.vertex(u, v, 0);
        const V3f other = grid.vertex(u, v + 1, 0) - grid.vertex(u + 1, v, 0);
        const V3f own = across.cross(other) * 0.5f;
        const float size = own.length();
        area += size, vector_area += own, place += middle * size;
        hiding_area += size * std::clamp((opacity.x + opacity.y + opacity.z) / 3, 0.0f, 1.0f);
    }
};

/// The first micropolygon's.
uint64_t surfel_id(uint32_t subpatch, int u, int v) {
    return MicropolygonId{subpatch, static_cast<uint8_t>(u), static_cast<uint8_t>(v)}.packed();
}

/// The discs of a grid, from number `at` on. Blocks without an area, or that are not seen, stay without one.
void put(const Grid& grid, bool reversed, Surfels& surfels, size_t at) {
    for (int v = 0; v < grid.shape.nv; v += kSurfelSide)
        for (int u = 0; u < grid.shape.nu; u += kSurfelSide, ++at) {
            SurfelSums sums;
            for (int j = v; j < std::min<int>(v + kSurfelSide, grid.shape.nv); ++j)
                for (int i = u; i < std::min<int>(u + kSurfelSide, grid.shape.nu); ++i) sums.add(grid, i, j);
            surfels.positions[at] = sums.area > 0 ? sums.place / sums.area : V3f(0);
            surfels.normals[at] = sums.vector_area.normalized() * (reversed ? -1.0f : 1.0f);
            surfels.areas[at] = sums.hiding_area;
            surfels.ids[at] = surfel_id(static_cast<uint32_t>(grid.ordinal), u, v);
            const int u1 = std::min<int>(u + kSurfelSide, grid.shape.nu);
            const int v1 = std::min<int>(v + kSurfelSide, grid.shape.nv);
            surfels.quads[at] = {grid.vertex(u, v, 0), grid.vertex(u1, v, 0), grid.vertex(u1, v1, 0),
                                 grid.vertex(u, v1, 0)};
        }
}

}  // namespace

int dice_surfel(const RayDicer& dicer, uint64_t id, ShadingGrid& grid) {
    const MicropolygonId first = MicropolygonId::unpack(id);
    const GridShape shape = dicer.tessellation().subpatches()[first.grid].shape;
    const auto middle = [](int at, int end) {
        return static_cast<float>(at + std::min(at + kSurfelSide, end)) / static_cast<float>(2 * end);
    };
    return dicer.make_point({first.grid, {middle(first.u, shape.nu), middle(first.v, shape.nv)}}, grid);
}

std::optional<Surfels> make_surfels(const RayDicer& dicer, const std::function<bool(uint32_t)>& wanted,
                                    size_t most_bytes) {
    const std::vector<SubpatchInfo>& subpatches = dicer.tessellation().subpatches();
    std::vector<size_t> first(subpatches.size() + 1, 0);
    for (size_t i = 0; i < subpatches.size(); ++i)
        first[i + 1] = first[i] + (wanted(subpatches[i].primitive) ? surfels_of(subpatches[i].shape) : 0);
    Surfels surfels;
    if (first.back() > most_bytes / (2 * sizeof(V3f) + sizeof(float) + sizeof(SurfelQuad) + sizeof(uint64_t)))
        return {};
    surfels.positions.resize(first.back(), V3f(0)), surfels.normals.resize(first.back(), V3f(0));
    surfels.areas.resize(first.back(), 0), surfels.quads.resize(first.back());
    surfels.ids.resize(first.back());
    // Who waits for it may hold what other tasks of the frame want.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, subpatches.size(), kSurfelGrain), [&](const auto& range) {
                for (size_t i = range.begin(); i != range.end() && !dicer.context().is_cancelled(); ++i) {
                    if (first[i] == first[i + 1]) continue;
                    GridArena passing(1);
                    const Grid grid = dicer.make(i, passing);
                    put(grid, dicer.attributes(grid.primitive).reverse_orientation, surfels, first[i]);
                }
            });
    });
    return surfels;
}

}  // namespace trapeze
