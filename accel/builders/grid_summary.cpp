#include "accel/builders/grid_summary.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace trapeze {
namespace {

/// Running maxima over keys, in the axes of the vertices given.
struct Extremes {
    float absolute_max = 0, quad_extent = 0;
};

/// Takes in one pose of a grid: its largest |coordinate| and its widest micropolygon along any one axis.
void extend_extremes(const GridShape& shape, const VerticesInAxes& p, Extremes& extremes) {
    const int row = shape.vertices_u();
    for (int k = 0; k < 3; ++k) {
        const float* c = p.c[k];
        for (int i = 0; i < shape.vertex_count(); ++i)
            extremes.absolute_max = std::max(extremes.absolute_max, std::abs(c[i]));
        for (int v = 0; v < shape.nv; ++v)
            for (int u = 0; u < shape.nu; ++u) {
                const float* q = c + v * row + u;
                const float low = std::min(std::min(q[0], q[1]), std::min(q[row], q[row + 1]));
                const float high = std::max(std::max(q[0], q[1]), std::max(q[row], q[row + 1]));
                extremes.quad_extent = std::max(extremes.quad_extent, high - low);
            }
    }
}

/// Whether a grid is a curve's ribbon: one micropolygon across and four or more along it. Its normal means
/// little, for it may be turned to face the camera; its direction is what groups of hair have in common.
bool is_curve(const GridShape& shape) {
    return std::min(shape.nu, shape.nv) == 1 && std::max(shape.nu, shape.nv) >= 4;
}

}  // namespace

V3f vertex_of_key(const Grid& grid, int key, int i, int j) {
    return KeyVertices(grid, key)[grid.shape.tiled_index(i, j)];
}

void vertices_in_axes(const Grid& grid, int key, const Axes& axes, VerticesInAxes& out) {
    const KeyVertices vertices(grid, key);
    int n = 0;
    for (int j = 0; j <= grid.shape.nv; ++j)
        for (int i = 0; i <= grid.shape.nu; ++i, ++n) {
            const V3f p = vertices[grid.shape.tiled_index(i, j)];
            for (int k = 0; k < 3; ++k)
                out.c[k][n] = (axes.axis[k].x * p.x + axes.axis[k].y * p.y) + axes.axis[k].z * p.z;
        }
}

GridSummary summarise_along_axes(const Grid& grid) {
    GridSummary summary;
    summary.weight = static_cast<uint32_t>(grid.shape.micropolygon_count());

    Extremes extremes;
    VerticesInAxes p;
    for (int key = 0; key < grid.key_count; ++key) {
        vertices_in_axes(grid, key, Axes{}, p);
        extend_extremes(grid.shape, p, extremes);
    }
    // Positions are finite numbers: pack_grid() sees to it.
    const bool boundable = extremes.absolute_max <= kBoundableCoordinate;
    summary.absolute_max = boundable ? extremes.absolute_max : std::numeric_limits<float>::infinity();
    summary.quad_extent = extremes.quad_extent;
    return summary;
}

GridSummary summarise(const Grid& grid) {
    const GridShape& shape = grid.shape;
    GridSummary summary = summarise_along_axes(grid);
    const bool boundable = std::isfinite(summary.absolute_max);

    // Not grown for rounding: it decides where a grid goes in a topology, never what a ray may skip.
    for (int j = 0; j <= shape.nv; ++j)
        for (int i = 0; i <= shape.nu; ++i) summary.box.extendBy(grid.vertex(i, j, 0.5f));

    // The paper's averaged edges [Hou10 sec. 3.3].
    // Sums of edges along u and v at mid-shutter: interior vertices cancel, so that border vertices are
    // enough.
    V3d along_u(0), along_v(0);
    for (int j = 0; j <= shape.nv; ++j)
        along_u += V3d(grid.vertex(shape.nu, j, 0.5f)) - V3d(grid.vertex(0, j, 0.5f));
    for (int i = 0; i <= shape.nu; ++i)
        along_v += V3d(grid.vertex(i, shape.nv, 0.5f)) - V3d(grid.vertex(i, 0, 0.5f));
    along_u /= shape.vertices_v() * shape.nu;  // averages of one edge
    along_v /= shape.vertices_u() * shape.nv;
    summary.axes = boundable ? axes_of(along_u, along_v) : Axes{};
    const bool long_u = shape.nu >= shape.nv;
    summary.main_direction = summary.axes.axis[2];
    // Of one direction alone the first axis is that direction.
    if (is_curve(shape) && boundable)
        summary.main_direction = axes_of(long_u ? along_u : along_v, V3d(0)).axis[0];
    return summary;
}

std::vector<GridSummary> oriented_summaries(const Grids& grids, const PaperTreeOptions& options) {
    std::vector<GridSummary> summaries(grids.grids.size());
    tbb::parallel_for(size_t{0}, summaries.size(), [&](size_t i) {
        summaries[i] = summarise(grids.grids[i]);
        if (!options.oriented()) summaries[i].axes = Axes{};
    });
    return summaries;
}

std::vector<GridSummary> summaries_along_axes(const Grids& grids) {
    std::vector<GridSummary> summaries(grids.grids.size());
    tbb::parallel_for(size_t{0}, summaries.size(),
                      [&](size_t i) { summaries[i] = summarise_along_axes(grids.grids[i]); });
    return summaries;
}

Box3f grown_for_axes(const Box3f& box, float absolute_max) {
    const V3f pad(kBoundRounding * absolute_max + 0x1p-80f);
    return {box.min - pad, box.max + pad};
}

HyperTrapezoid bound_in_axes(const Grid& grid, float absolute_max, const Axes& axes) {
    HyperTrapezoid bound{axes, {}};
    VerticesInAxes p;
    for (int key = 0; key < grid.key_count; ++key) {
        Box3f box(V3f(0), V3f(0));
        if (std::isfinite(absolute_max)) {
            vertices_in_axes(grid, key, axes, p);
            for (int k = 0; k < 3; ++k) {
                const auto [low, high] = std::minmax_element(p.c[k], p.c[k] + grid.shape.vertex_count());
                box.min[k] = *low, box.max[k] = *high;
            }
            box = grown_for_axes(box, absolute_max);
        }
        bound.keys.push_back(box);
    }
    return bound;
}

}  // namespace trapeze
