/// Rectangles of micropolygons of one grid: the nodes of the implicit in-grid trees [Hou10 sec. 3.3], and how
/// a ray meets the micropolygons of a leaf. All tests here are the scalar predicate, core/hit_micropolygon.h:
/// what they find is the reference for every other tree and for the forms in vectors.
#pragma once

#include <cstdint>

#include "accel/trace_ray.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/stats.h"

namespace trapeze {

/// Micropolygons (u .. u + nu - 1, v .. v + nv - 1) of a grid. It has (nu + 1) x (nv + 1) vertices; those on
/// its border belong to its neighbours too.
struct GridBlock {
    uint8_t u = 0, v = 0;    ///< first micropolygon
    uint8_t nu = 1, nv = 1;  ///< how many

    int count() const { return nu * nv; }
};

/// The largest leaf_below that options may ask for: a leaf has fewer micropolygons than this.
inline constexpr int kMostSplitFrom = 32;

/// The two halves of a block at the midpoint of its longer parametric axis; of an odd side `high` gets one
/// column or row more. Equal sides are split along u.
struct BlockHalves {
    GridBlock low, high;
};

/// Depends on nothing but the shape, so that the topology of a grid's tree need not be stored.
constexpr BlockHalves halves(const GridBlock& b) {
    if (b.nu >= b.nv) {
        const auto n = static_cast<uint8_t>(b.nu / 2);
        return {{b.u, b.v, n, b.nv},
                {static_cast<uint8_t>(b.u + n), b.v, static_cast<uint8_t>(b.nu - n), b.nv}};
    }
    const auto n = static_cast<uint8_t>(b.nv / 2);
    return {{b.u, b.v, b.nu, n}, {b.u, static_cast<uint8_t>(b.v + n), b.nu, static_cast<uint8_t>(b.nv - n)}};
}

/// The facing as a ray sees it whose direction along its axis has this sign. Facing is defined by the sign of
/// the projected area for depths that grow with the axis; a ray that runs against the axis sees the other
/// side.
inline Facing facing_along(Facing facing, float sign) {
    if (sign > 0 || facing == Facing::Both) return facing;
    return facing == Facing::PositiveOnly ? Facing::NegativeOnly : Facing::PositiveOnly;
}

namespace grid_block_detail {

/// Vertices of a leaf block at the ray's time, row by row, u fastest, in the ray's turned axes. Moved by
/// Grid::vertex()'s arithmetic, because the predicate's answer must not depend on who moves the vertices.
struct Vertices {
    /// A block of n x 1 micropolygons has the most vertices for its number.
    static constexpr int kMaxVertices = 2 * kMostSplitFrom;
    float x[kMaxVertices], y[kMaxVertices], z[kMaxVertices];
};

/// Fills in the (nu + 1) x (nv + 1) vertices of a block. Neighbours share most of them: moving each vertex
/// once instead of four times is why blocks are tested as a whole. kMotion: grid.moves().
template <bool kMotion>
inline void gather(const Grid& grid, const GridBlock& block, const TraceRay& ray, Vertices& out) {
    // Three planes of positions, then (6 planes a segment) three of what a segment adds to them.
    const MotionSegment s = kMotion ? segment_at(ray.axis.time, grid.key_count) : MotionSegment{};
    const size_t plane_size = grid.shape.plane_size();
    const float* first = grid.plane(s.index, 0);
    const float* px = first + ray.planes[0] * plane_size;
    const float* py = first + ray.planes[1] * plane_size;
    const float* pz = first + ray.planes[2] * plane_size;
    const size_t to_delta = 3 * plane_size;
    int n = 0;
    for (int j = 0; j <= block.nv; ++j)
        for (int i = 0; i <= block.nu; ++i, ++n) {
            const int at = grid.shape.tiled_index(block.u + i, block.v + j);
            if constexpr (kMotion) {
                out.x[n] = position_at(px[at], px[at + to_delta], s.local);
                out.y[n] = position_at(py[at], py[at + to_delta], s.local);
                out.z[n] = position_at(pz[at], pz[at + to_delta], s.local);
            } else {
                out.x[n] = px[at], out.y[n] = py[at], out.z[n] = pz[at];
            }
        }
}

/// Tests a ray against one micropolygon and shows the policy what it hits within [t_min, t_max], ends
/// included. `quad` and `facing` are in the ray's turned axes.
template <class Policy>
inline void test_quad(const Grid& grid, const MicropolygonId& id, const Quad& quad, Facing facing,
                      TraceRay& ray, Policy& policy, SampleStats& stats) {
    float z;
    if (!hit_micropolygon(ray.axis, quad, facing, &z)) return;
    ++stats.predicate_hits;
    const Hit hit{ray.depth_of(z), id.packed()};
    if (hit.depth >= ray.t_min && hit.depth <= ray.t_max) policy.consider(hit, grid.opaque, ray);
}

}  // namespace grid_block_detail

/// Tests a ray against one micropolygon on its own, as a leaf that is a list of micropolygons must: nothing
/// is shared with neighbours, whose vertices test_block() moves only once.
template <class Policy>
inline void test_micropolygon(const Grid& grid, const MicropolygonId& id, TraceRay& ray, Policy& policy,
                              SampleStats& stats) {
    ++stats.predicate_tests;
    const Quad quad = grid.quad(id.u, id.v, ray.axis.time, ray.planes[0], ray.planes[1], ray.planes[2]);
    grid_block_detail::test_quad(grid, id, quad, facing_along(grid.facing, ray.sign), ray, policy, stats);
}

/// Tests a ray against every micropolygon of a leaf block (fewer than kMostSplitFrom) and shows the policy
/// what it hits. Counts a predicate test for each, whether its neighbours' vertices are shared or not.
template <class Policy>
inline void test_block(const Grid& grid, uint32_t grid_index, const GridBlock& block, TraceRay& ray,
                       Policy& policy, SampleStats& stats) {
    grid_block_detail::Vertices p;
    if (grid.moves())
        grid_block_detail::gather<true>(grid, block, ray, p);
    else
        grid_block_detail::gather<false>(grid, block, ray, p);
    const Facing facing = facing_along(grid.facing, ray.sign);
    const int row = block.nu + 1;
    stats.predicate_tests += static_cast<uint64_t>(block.count());
    for (int v = 0; v < block.nv; ++v)
        for (int u = 0; u < block.nu; ++u) {
            const int a = v * row + u, b = a + row;
            const Quad quad{{p.x[a], p.x[a + 1], p.x[b], p.x[b + 1]},
                            {p.y[a], p.y[a + 1], p.y[b], p.y[b + 1]},
                            {p.z[a], p.z[a + 1], p.z[b], p.z[b + 1]}};
            const MicropolygonId id{grid_index, static_cast<uint8_t>(block.u + u),
                                    static_cast<uint8_t>(block.v + v)};
            grid_block_detail::test_quad(grid, id, quad, facing, ray, policy, stats);
        }
}

}  // namespace trapeze
