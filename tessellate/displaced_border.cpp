#include "tessellate/displaced_border.h"

#include <algorithm>
#include <cmath>

#include "tessellate/camera_variables.h"
#include "tessellate/normals.h"

namespace trapeze {
namespace {

/// An edge that is one point, such as a sphere's pole.
bool is_point(const Edges& edges, const BorderSide& side) {
    const EdgeLine line = edges.line(side.edge);
    return !line.start.on_edge && !line.finish.on_edge && line.start.id == line.finish.id &&
           side.interval->depth == 0 && side.interval->segments == 1;
}

struct SharedShading {
    V3f normal;
    float s = 0, t = 0;
};

/// Shading at points of one face.
void evaluate_points(const PlacedSurface& surface, int face, std::span<const V2f> uv,
                     DiceScratch::State& scratch, std::span<SharedShading> out) {
    const Attributes& attributes = *surface.primitive().attributes;
    const float outside = attributes.reverse_orientation ? -1.0f : 1.0f;
    const size_t n = uv.size();
    std::array<V3f, kMaxBorderPoints> P, dPdu, dPdv;
    surface.positions_and_derivatives(face, uv, 1, scratch.evaluation, {P.data(), n}, {dPdu.data(), n},
                                      {dPdv.data(), n});
    ShadingGrid& grid = scratch.points;
    grid.shape = {static_cast<uint8_t>(n - 1), 0};
    for (Triples* t : {&grid.N, &grid.Ng}) t->resize(n);
    for (std::vector<float>* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(n);
    grid.Cs.fill(n, attributes.color);
    grid.Os.fill(n, attributes.opacity);
    for (size_t i = 0; i < n; ++i) {
        V3f normal = unit_normal(dPdu[i], dPdv[i]);
        if (normal == V3f(0, 0, 0)) {
            nearby_derivatives(surface, {face, uv[i]}, scratch.evaluation, &dPdu[i], &dPdv[i]);
            normal = unit_normal(dPdu[i], dPdv[i]);
        }
        grid.Ng.set(i, normal * outside);
    }
    for (int k = 0; k < 3; ++k) std::ranges::copy(grid.Ng.c[k], grid.N.c[k].begin());
    if (surface.surface().evaluate_variables(face, uv, scratch.evaluation.of(surface.surface()), grid))
        normals_to_camera_space(surface.camera_from_object(0), grid.Ng, grid.N);
    for (size_t i = 0; i < n; ++i) out[i] = {grid.N.at(i), grid.s[i], grid.t[i]};
}

/// How far apart s (or t) may be on both sides of an edge where the texture goes on.
float tolerance(const std::vector<float>& values) {
    const auto [lo, hi] = std::ranges::minmax_element(values);
    return (*hi - *lo) / 4 + 1e-5f;
}

}  // namespace

void snap_border_parameters(const Edges& edges, const Subpatch& subpatch,
                            std::span<const BorderSide, 4> sides, std::span<const BorderPoint> points,
                            std::span<const BorderVertex> border, std::span<V2f> uv) {
    std::array<bool, 4> pole;
    for (int s = 0; s < 4; ++s) pole[s] = is_point(edges, sides[s]);
    int first_of_side = 0, side = -1;
    for (const BorderVertex& at : border) {
        if (at.side != side) side = at.side, first_of_side = at.point;
        const SurfaceSide& on = subpatch.sides[side];
        // A corner that lies within one of its edges and at the end of the other is moved along the former.
        if (pole[side] || on.begin == on.end || points[at.point].hops > 0) continue;
        const float parameter =
            sides[side].interval->parameter_of(sides[side].vertex(at.point - first_of_side));
        const float share = (parameter - on.begin) / (on.end - on.begin);
        const int axis = side == kBottom || side == kTop ? 0 : 1;
        const float own = subpatch.lo[axis] + (subpatch.hi[axis] - subpatch.lo[axis]) * share;
        uv[at.vertex][axis] = std::clamp(own, 0.0f, 1.0f);
    }
    for (const BorderVertex& at : border)
        if (at.corner >= 0 && !pole[at.side]) uv[at.vertex] = uv[at.corner];
    // The same bits as the shared point, where that is on this very side.
    for (const BorderVertex& at : border) {
        const BorderPoint& point = points[at.point];
        const V2f size = subpatch.hi - subpatch.lo, off = point.at.uv - uv[at.vertex];
        if (!point.is_vertex && point.at.face == subpatch.face && std::abs(off.x) < size.x / 1024 &&
            std::abs(off.y) < size.y / 1024)
            uv[at.vertex] = point.at.uv;
    }
}

void share_border_shading(const DiceContext& context, std::span<const BorderSide, 4> sides,
                          std::span<const BorderPoint> points, std::span<const BorderVertex> border,
                          ShadingGrid& grid, DiceScratch::State& scratch) {
    std::array<SharedShading, kMaxBorderPoints> shared;
    std::array<V2f, kMaxBorderPoints> uv;
    for (size_t i = 0; i < points.size();) {
        const int face = points[i].at.face;
        size_t n = 0;
        for (; i + n < points.size() && points[i + n].at.face == face; ++n) uv[n] = points[i + n].at.uv;
        evaluate_points(*context.surface, face, {uv.data(), n}, scratch, {shared.data() + i, n});
        i += n;
    }
    const float s_tolerance = tolerance(grid.s), t_tolerance = tolerance(grid.t);
    std::array<bool, 4> pole;
    for (int s = 0; s < 4; ++s) pole[s] = is_point(context.edges, sides[s]);
    for (const BorderVertex& at : border) {
        const SharedShading& shading = shared[at.point];
        if (shading.normal != V3f(0, 0, 0)) grid.N.set(at.vertex, shading.normal);
        const auto share = [&](float& own, float value, float slack) {
            if (pole[at.side] || std::abs(own - value) <= slack) own = value;
        };
        share(grid.s[at.vertex], shading.s, s_tolerance);
        share(grid.t[at.vertex], shading.t, t_tolerance);
    }
    for (const BorderVertex& at : border)
        if (at.corner >= 0) grid.s[at.vertex] = grid.s[at.corner], grid.t[at.vertex] = grid.t[at.corner];
}

}  // namespace trapeze
