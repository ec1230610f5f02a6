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

/// A grid where it is met.
struct PlacedGrid {
    const Grid& grid;
    const ObjectPlace* place;  ///< null: in camera space

    V3f vertex(int i, int j) const {
        const V3f P = grid.vertex(i, j, 0);
        return place ? place->to_camera(P, 0) : P;
    }
};

/// Sums over the micropolygons of a block.
struct SurfelSums {
    V3f place{0, 0, 0}, vector_area{0, 0, 0};
    float area = 0, hiding_area = 0;

    void add(const PlacedGrid& placed, int u, int v) {
        V3f middle(0), opacity(0);
        for (int corner = 0; corner < 4; ++corner) {
            const int i = u + (corner & 1), j = v + (corner >> 1);
            middle += placed.vertex(i, j) * 0.25f, opacity += placed.grid.opacity(i, j) * 0.25f;
        }
        const V3f across = placed.vertex(u + 1, v + 1) - placed.vertex(u, v);
        const V3f other = placed.vertex(u, v + 1) - placed.vertex(u + 1, v);
        const V3f own = across.cross(other) * 0.5f;
        const float size = own.length();
        area += size, vector_area += own, place += middle * size;
        hiding_area += size * std::clamp((opacity.x + opacity.y + opacity.z) / 3, 0.0f, 1.0f);
    }
};

/// The number of a place is above that of the first micropolygon.
constexpr int kPlaceShift = 40;
constexpr size_t kMostPlaces = size_t{1} << (64 - kPlaceShift);

uint64_t surfel_id(uint64_t subpatch, int u, int v, uint64_t place) {
    return MicropolygonId{static_cast<uint32_t>(subpatch), static_cast<uint8_t>(u), static_cast<uint8_t>(v)}
               .packed() |
           place << kPlaceShift;
}

/// Where a subpatch is met: places by their numbers, from 1 on, or 0: camera space.
struct PlaceRange {
    size_t first = 0, end = 1;
};

/// Of each shared object; its places follow each other.
std::vector<PlaceRange> places_of(const SharedObjects& shared) {
    std::vector<PlaceRange> ranges(shared.objects.size(), {0, 0});
    for (size_t i = 0; i < shared.places.size(); ++i) {
        PlaceRange& range = ranges[shared.places[i].object];
        if (range.end == 0) range.first = i + 1;
        range.end = i + 2;
    }
    return ranges;
}

/// The discs of a grid, from number `at` on. Blocks without an area, or that are not seen, stay without one.
void put(const RayDicer& dicer, const Grid& grid, size_t place_number, Surfels& surfels, size_t at) {
    const SharedObjects& shared = dicer.shared();
    const ObjectPlace* const place = place_number > 0 ? &shared.places[place_number - 1] : nullptr;
    const uint32_t primitive = place ? shared.primitive_at(*place, grid.primitive) : grid.primitive;
    const bool reversed = dicer.attributes(primitive).reverse_orientation;
    const PlacedGrid placed{grid, place};
    for (int v = 0; v < grid.shape.nv; v += kSurfelSide)
        for (int u = 0; u < grid.shape.nu; u += kSurfelSide, ++at) {
            SurfelSums sums;
            for (int j = v; j < std::min<int>(v + kSurfelSide, grid.shape.nv); ++j)
                for (int i = u; i < std::min<int>(u + kSurfelSide, grid.shape.nu); ++i)
                    sums.add(placed, i, j);
            surfels.positions[at] = sums.area > 0 ? sums.place / sums.area : V3f(0);
            surfels.normals[at] = sums.vector_area.normalized() * (reversed ? -1.0f : 1.0f);
            surfels.areas[at] = sums.hiding_area;
            surfels.opacities[at] = sums.area > 0 ? sums.hiding_area / sums.area : 1;
            surfels.ids[at] = surfel_id(grid.ordinal, u, v, place_number);
            const int u1 = std::min<int>(u + kSurfelSide, grid.shape.nu);
            const int v1 = std::min<int>(v + kSurfelSide, grid.shape.nv);
            surfels.quads[at] = {placed.vertex(u, v), placed.vertex(u1, v), placed.vertex(u1, v1),
                                 placed.vertex(u, v1)};
        }
}

}  // namespace

int dice_surfel(const RayDicer& dicer, uint64_t id, ShadingGrid& grid) {
    const MicropolygonId first = MicropolygonId::unpack(id & ((uint64_t{1} << kPlaceShift) - 1));
    const GridShape shape = dicer.tessellation().shape_of(first.grid);
    uint32_t primitive = dicer.tessellation().primitive_of(first.grid);
    if (const auto number = static_cast<size_t>(id >> kPlaceShift); number > 0)
        primitive = dicer.shared().primitive_at(dicer.shared().places[number - 1], primitive);
    const auto middle = [](int at, int end) {
        return static_cast<float>(at + std::min(at + kSurfelSide, end)) / static_cast<float>(2 * end);
    };
    return dicer.make_point({first.grid, {middle(first.u, shape.nu), middle(first.v, shape.nv)}, primitive},
                            grid);
}

std::optional<Surfels> make_surfels(const RayDicer& dicer, const std::function<bool(uint32_t)>& wanted,
                                    size_t most_bytes) {
    const std::vector<SubpatchInfo>& subpatches = dicer.tessellation().subpatches();
    const SharedObjects& shared = dicer.shared();
    if (shared.places.size() >= kMostPlaces || dicer.tessellation().makes_lists_again()) return {};
    const std::vector<PlaceRange> of_objects = places_of(shared);
    const auto places = [&](size_t subpatch) {
        const int object = shared.object_of(subpatches[subpatch].primitive);
        return object < 0 ? PlaceRange() : of_objects[static_cast<size_t>(object)];
    };
    std::vector<size_t> first(subpatches.size() + 1, 0);
    for (size_t i = 0; i < subpatches.size(); ++i) {
        const auto [begin, end] = places(i);
        first[i + 1] = first[i];
        if (wanted(subpatches[i].primitive)) first[i + 1] += (end - begin) * surfels_of(subpatches[i].shape);
    }
    Surfels surfels;
    if (first.back() >
        most_bytes / (2 * sizeof(V3f) + 2 * sizeof(float) + sizeof(SurfelQuad) + sizeof(uint64_t)))
        return {};
    surfels.positions.resize(first.back(), V3f(0)), surfels.normals.resize(first.back(), V3f(0));
    surfels.areas.resize(first.back(), 0), surfels.quads.resize(first.back());
    surfels.ids.resize(first.back()), surfels.opacities.resize(first.back(), 1);
    // Who waits for it may hold what other tasks of the frame want.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, subpatches.size(), kSurfelGrain), [&](const auto& range) {
                for (size_t i = range.begin(); i != range.end() && !dicer.context().is_cancelled(); ++i) {
                    if (first[i] == first[i + 1]) continue;
                    GridArena passing(1);
                    const Grid grid = dicer.make(i, passing);
                    const auto [begin, end] = places(i);
                    for (size_t place = begin; place < end; ++place)
                        put(dicer, grid, place, surfels, first[i] + (place - begin) * surfels_of(grid.shape));
                }
            });
    });
    if (std::ranges::all_of(surfels.opacities, [](float opacity) { return opacity == 1; }))
        surfels.opacities = {};
    return surfels;
}

}  // namespace trapeze
