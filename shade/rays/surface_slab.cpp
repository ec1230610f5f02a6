#include "shade/rays/surface_slab.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/scene.h"

namespace trapeze {
namespace {

constexpr float kRounding = std::numeric_limits<float>::epsilon();
/// Last bits of the largest terms that a position is the sum of: on the way from a face's corners to camera
/// space, once more for what rays meet, and where hits are found.
constexpr float kRoundings = 8;
/// Micropolygons that rays meet have sides of nearly twice what is wished, and diagonals of 2^1/2 times that:
/// within r = 2^1.5 sides of a vertex a surface of curvature k rises by k r^2 / 2.
constexpr float kBendOfSides = 4;
/// Shorter edges tell of rounding alone; in roundings.
constexpr float kShortestEdge = 16;

/// Adds two vertices beside each other: how far the surface turns, or rises above their tangent planes,
/// within the side of a micropolygon that rays meet. What turns over a longer edge may turn within a side of
/// it. Normals that turn along the edge away from each other bend inwards; across it they bend both ways.
void add_bend_along(const Triples& P, const Triples& Ng, size_t i, size_t j, float side, float rounding,
                    SurfaceBend& bend) {
    constexpr float kAcross = 0.01f;
    const V3f way = P.at(j) - P.at(i);
    const V3f from = Ng.at(i), to = Ng.at(j);
    const float length = way.length();
    if (!(length > kShortestEdge * rounding)) return;
    const V3f turned = to - from;
    const float rise = std::max(std::abs(way.dot(from)), std::abs(way.dot(to))) - rounding;
    const float turn = std::max(turned.length(), 2 * rise / length);
    const float most = kBendOfSides * side * side * turn / std::min(length, side);
    const float apart = turned.dot(way) / length, across = kAcross * turned.length();
    bend.most = std::max(bend.most, most);
    if (apart >= -across) bend.inwards = std::max(bend.inwards, most);
    if (apart <= across) bend.outwards = std::max(bend.outwards, most);
}

/// Of the slab's half thickness, so that rays leave their own slab before they come to that of another face,
/// unless they are nearly along their own; of a side.
constexpr float kInwards = 16, kMostInwards = 1.0f / 4;

}  // namespace

float rounding_at(const ShadingGrid& grid, size_t vertex) {
    float reach =
        grid.P.front().at(vertex).length() + grid.dPdu.at(vertex).length() + grid.dPdv.at(vertex).length();
    const std::span<const M44f> poses = grid.primitive->camera_from_object;
    if (!poses.empty())
        reach += 2 * V3f(poses.front()[3][0], poses.front()[3][1], poses.front()[3][2]).length();
    return kRoundings * kRounding * reach;
}

SurfaceBend bend_of(const ShadingGrid& grid, const RayScene& scene, float pixels) {
    const Triples& P = grid.P.front();
    const size_t row = size_t{grid.shape.nu} + 1;
    SurfaceBend bend{.most = 0};
    for (size_t v = 0; v <= grid.shape.nv; ++v)
        for (size_t u = 0; u < row; ++u) {
            const size_t at = v * row + u;
            const float side = pixels * scene.spacing(P.at(at)), rounding = rounding_at(grid, at);
            const auto look = [&](size_t i, size_t j) {
                add_bend_along(P, grid.Ng, i, j, side, rounding, bend);
            };
            const bool across = u + 1 < row, along = v < grid.shape.nv;
            if (across) look(at, at + 1);
            if (along) look(at, at + row);
            if (!across || !along) continue;
            look(at, at + row + 1);
            look(at + 1, at + row);
        }
    return bend;
}

V3f inwards_at(const ShadingGrid& grid, size_t vertex, float half, uint8_t sides) {
    if (grid.hit_vertex >= 0) return V3f(0, 0, 0);
    const Triples& P = grid.P.front();
    const size_t row = size_t{grid.shape.nu} + 1, u = vertex % row, v = vertex / row;
    const V3f here = P.at(vertex);
    V3f way(0, 0, 0);
    // Towards the vertex beside it, or where that is in the same place, as those of grids that join coarser
    // ones may be, towards the one across the micropolygon.
    const size_t beside_u = u < grid.shape.nu ? vertex + 1 : vertex - 1;
    const size_t across = v < grid.shape.nv ? beside_u + row : beside_u - row;
    const auto look_at = [&](uint8_t side, bool is_on_it, size_t beside) {
        if (!is_on_it || (sides & side) == 0) return;
        const V3f to_it = P.at(beside) - here;
        way += to_it != V3f(0, 0, 0) ? to_it : P.at(across) - here;
    };
    look_at(ShadingGrid::kFirstU, u == 0, vertex + 1);
    look_at(ShadingGrid::kLastU, u == grid.shape.nu, vertex - 1);
    look_at(ShadingGrid::kFirstV, v == 0, vertex + row);
    look_at(ShadingGrid::kLastV, v == grid.shape.nv, vertex - row);
    const V3f normal = grid.Ng.at(vertex);
    way -= normal * way.dot(normal);  // a chord would lead below what is convex
    const float length = way.length();
    return length > 0 ? way * std::min(kInwards * half / length, kMostInwards) : way;
}

bool is_cramped_at(const ShadingGrid& grid, size_t vertex, float half, uint8_t sides) {
    constexpr float kAll = 0.99f;
    const float length = inwards_at(grid, vertex, half, sides).length();
    return length > 0 && length < kAll * kInwards * half;
}

}  // namespace trapeze
