#include "shade/displace.h"

#include <algorithm>
#include <cmath>

#include "core/motion_keys.h"
#include "core/scene/scene.h"
#include "shade/materials/grid_shader.h"
#include "shade/planes/differences.h"

namespace trapeze {
namespace {

/// A primitive's matrix at a key of the grid, which may have more keys than the primitive. Matrices are mixed
/// linearly between their keys, as points move between them.
M44d pose_at_key(std::span<const M44f> poses, int key, int key_count) {
    const int count = static_cast<int>(poses.size());
    if (count <= 1) return count ? M44d(poses.front()) : M44d();
    const float time01 = key_count > 1 ? static_cast<float>(key) / static_cast<float>(key_count - 1) : 0.0f;
    const MotionSegment segment = segment_at(time01, count);
    const double w = segment.local;
    return M44d(poses[segment.index]) * (1 - w) + M44d(poses[segment.index + 1]) * w;
}

/// Turns displaced positions into displacement vectors, in place; those that are not finite become zero.
void subtract_positions(const Triples& P, size_t vertices, Plane3 moved) {
    for (size_t i = 0; i < vertices; ++i) {
        const V3f move = V3f(moved.x[i], moved.y[i], moved.z[i]) - P.at(i);
        const bool finite = std::isfinite(move.x) && std::isfinite(move.y) && std::isfinite(move.z);
        for (int k = 0; k < 3; ++k) moved[k][i] = finite ? move[k] : 0;
    }
}

/// Adds displacement vectors to the positions of a key, turned from the first key's pose to that key's;
/// returns the longest.
float move_key(const Plane3& moves, const M44d& key_from_first, Triples& P) {
    double longest = 0;
    for (size_t i = 0; i < P.size(); ++i) {
        const V3d move(moves.x[i], moves.y[i], moves.z[i]);
        V3d here;
        key_from_first.multDirMatrix(move, here);
        longest = std::max(longest, here.length());
        P.set(i, P.at(i) + V3f(here));
    }
    return static_cast<float>(longest);
}

/// Vertices first .. first + count - 1 of three planes.
Plane3 part(const Plane3& planes, size_t first, size_t count) {
    return {planes.x.subspan(first, count), planes.y.subspan(first, count), planes.z.subspan(first, count)};
}

void store(ConstPlane3 planes, size_t vertices, Triples& out) {
    for (int k = 0; k < 3; ++k) out.c[k].assign(planes[k].begin(), planes[k].begin() + vertices);
}

}  // namespace

Displaced displaced_by(const vm::Registers& registers, size_t first, size_t count) {
    const auto values = [&](std::string_view name) -> ConstPlane3 {
        if (!writes_variable(registers.program(), name)) return {};
        return part(variable_planes(registers, name), first, count);
    };
    return {values("P"), values("N")};
}

M44d key_from_first(const Primitive& primitive, int key, int key_count) {
    const std::span<const M44f> poses = primitive.camera_from_object;
    if (poses.size() <= 1 || key == 0) return M44d();
    return pose_at_key(poses, 0, key_count).inverse() * pose_at_key(poses, key, key_count);
}

float displace_grid(const Displaced& displaced, ShadingGrid& grid, PlanePool& pool) {
    const size_t vertices = grid.vertex_count();
    if (displaced.P.size() == 0) {
        if (displaced.N.size() != 0) store(displaced.N, vertices, grid.N);
        return 0;
    }
    pool.start(vertices);
    const Plane3 moves = pool.take3(), N = pool.take3(), P = pool.take3();
    for (int k = 0; k < 3; ++k) load(displaced.P[k], vertices, moves[k]);
    subtract_positions(grid.P.front(), vertices, moves);

    float longest = 0;
    for (size_t key = 0; key < grid.P.size(); ++key) {
        const M44d to_key = key_from_first(*grid.primitive, static_cast<int>(key), grid.key_count);
        longest = std::max(longest, move_key(moves, to_key, grid.P[key]));
    }
    grid.displaced = grid.displaced || longest > 0;
    for (int k = 0; k < 3; ++k) {
        load(grid.N.c[k], vertices, N[k]);
        load(grid.P.front().c[k], vertices, P[k]);
    }
    const auto in_piece = static_cast<size_t>(grid.shape.vertex_count());
    for (size_t first = 0; first < vertices; first += in_piece)
        find_normals(grid.shape, part(P, first, in_piece), grid.reverse_orientation,
                     part(N, first, in_piece));
    store(N, vertices, grid.Ng);
    store(displaced.N.size() != 0 ? displaced.N : ConstPlane3(N), vertices, grid.N);
    return longest;
}

float longest_move(const Displaced& displaced, const ShadingGrid& grid) {
    if (displaced.P.size() == 0) return 0;
    constexpr float kRounding = 1e-5f;  // of the distance from the eye: less is rounding, not displacement
    const Triples& P = grid.P.front();
    float longest = 0;
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        const V3f here = P.at(i);
        const float move = (V3f(displaced.P.x[i], displaced.P.y[i], displaced.P.z[i]) - here).length();
        if (move > kRounding * here.length()) longest = std::max(longest, move);
    }
    return longest;
}

}  // namespace trapeze
