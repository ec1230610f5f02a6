#include "shade/displace.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/motion_keys.h"
#include "core/scene/motion_turn.h"
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

/// Vertices first .. first + count - 1 of three planes.
Plane3 part(const Plane3& planes, size_t first, size_t count) {
    return {planes.x.subspan(first, count), planes.y.subspan(first, count), planes.z.subspan(first, count)};
}

V3f at(const Plane3& planes, size_t i) {
    return {planes.x[i], planes.y[i], planes.z[i]};
}

/// How a surface lies at each vertex of a grid, as its vertices tell: unit normals, and ways along u.
struct Lie {
    Plane3 normals, along;

    Lie(const ShadingGrid& grid, const Triples& P, const M44d& moved, PlanePool& pool)
        : normals(pool.take3()), along(pool.take3()) {
        const Plane3 places = pool.take3();
        for (size_t i = 0; i < P.size(); ++i) {
            const V3f place(V3d(P.at(i)) * moved);
            for (int k = 0; k < 3; ++k) places[k][i] = place[k], normals[k][i] = 0;
        }
        const auto in_piece = static_cast<size_t>(grid.shape.vertex_count());
        for (size_t first = 0; first < P.size(); first += in_piece) {
            const Plane3 here = part(places, first, in_piece);
            find_normals(grid.shape, here, grid.reverse_orientation, part(normals, first, in_piece));
            for (int k = 0; k < 3; ++k)
                difference(grid.shape, GridAxis::U, here[k], part(along, first, in_piece)[k]);
        }
    }
    /// Along u in the tangent plane, of unit length or 0.
    V3f tangent(size_t i) const { return across(at(normals, i), at(along, i)); }
    static V3f across(const V3f& normal, const V3f& way) {
        return (way - normal * way.dot(normal)).normalized();
    }
};

/// How the surface of a grid turns in deforming, from the first key to another one, besides how its pose
/// turns: as its normal does by the shortest way, and then about that as its u does.
class LieTurn {
  public:
    LieTurn(const ShadingGrid& grid, size_t key, const M44d& key_from_first, PlanePool& pool)
        : before_(grid, grid.P.front(), key_from_first, pool), after_(grid, grid.P[key], M44d(), pool) {}

    V3f turned(const V3f& move, size_t i) const {
        const V3f from = at(before_.normals, i), to = at(after_.normals, i);
        const V3f along = Lie::across(to, turned_from(from, to, before_.tangent(i)));
        return turned_from(along, after_.tangent(i), turned_from(from, to, move));
    }

  private:
    Lie before_, after_;
};

/// Displacement vectors at a key: turned from the first key's pose to that key's, and as the surface
/// deforms.
std::vector<V3f> moves_at_key(const Plane3& moves, size_t key, const ShadingGrid& grid, PlanePool& pool) {
    const M44d to_key = key_from_first(*grid.primitive, static_cast<int>(key), grid.key_count);
    std::optional<LieTurn> turn;
    if (key > 0 && grid.primitive->shape_keys.size() > 1) turn.emplace(grid, key, to_key, pool);
    std::vector<V3f> at_key;
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        V3d here;
        to_key.multDirMatrix(V3d(at(moves, i)), here);
        at_key.push_back(turn ? turn->turned(V3f(here), i) : V3f(here));
    }
    return at_key;
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
    // The first key last: how the others have turned is seen from it as it was.
    for (size_t key = grid.P.size(); key-- > 0;) {
        const std::vector<V3f> at_key = moves_at_key(moves, key, grid, pool);
        for (size_t i = 0; i < vertices; ++i) {
            longest = std::max(longest, at_key[i].length());
            grid.P[key].set(i, grid.P[key].at(i) + at_key[i]);
        }
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
