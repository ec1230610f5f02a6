#include "shade/planes/differences.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

constexpr double kParallel = 1e-5;  ///< sine of the angle below which two chords count as parallel

V3f at(ConstPlane3 p, int i) {
    return {p.x[i], p.y[i], p.z[i]};
}

/// The vector between the vertices to both sides of (i, j) along an axis; at a border, from the vertex
/// itself.
V3d chord(const GridShape& shape, ConstPlane3 P, GridAxis axis, int i, int j) {
    const int u = axis == GridAxis::U ? 1 : 0, v = 1 - u;
    const int after = shape.row_index(std::min<int>(i + u, shape.nu), std::min<int>(j + v, shape.nv));
    const int before = shape.row_index(std::max(i - u, 0), std::max(j - v, 0));
    return V3d(at(P, after)) - V3d(at(P, before));
}

/// The unit normal at a vertex, or zero where its chords are parallel but for rounding. In doubles: the
/// coordinates of micropolygons far from the origin are large against their size, and products would lose it.
V3f normal_at(const GridShape& shape, ConstPlane3 P, int i, int j) {
    const V3d along_u = chord(shape, P, GridAxis::U, i, j);
    const V3d along_v = chord(shape, P, GridAxis::V, i, j);
    const V3d cross = along_u.cross(along_v);
    const double length = cross.length();
    if (!(length > kParallel * along_u.length() * along_v.length()) || !std::isfinite(length)) return V3f(0);
    return V3f(cross / length);
}

/// The mean normal of the vertices next to it: for a pole, and for borders where several vertices are snapped
/// to one point.
V3f normal_from_inside(const GridShape& shape, ConstPlane3 P, int i, int j) {
    V3f sum(0);
    for (const auto& [du, dv] : {std::pair{0, 1}, std::pair{0, -1}, std::pair{1, 0}, std::pair{-1, 0}}) {
        const int ni = i + du, nj = j + dv;
        if (ni < 0 || nj < 0 || ni > shape.nu || nj > shape.nv) continue;
        sum += normal_at(shape, P, ni, nj);
    }
    return unit_or_zero(sum);
}

}  // namespace

void difference(const GridShape& shape, GridAxis axis, ConstPlane values, Plane out) {
    for (int j = 0; j <= shape.nv; ++j)
        for (int i = 0; i <= shape.nu; ++i) {
            int before = 0, after = 0, steps = 1;
            if (axis == GridAxis::U) {
                const int a = std::max(i - 1, 0), b = std::min<int>(i + 1, shape.nu);
                before = shape.row_index(a, j), after = shape.row_index(b, j), steps = b - a;
            } else {
                const int a = std::max(j - 1, 0), b = std::min<int>(j + 1, shape.nv);
                before = shape.row_index(i, a), after = shape.row_index(i, b), steps = b - a;
            }
            out[shape.row_index(i, j)] =
                (values[after] - values[before]) / static_cast<float>(std::max(steps, 1));
        }
}

void find_normals(const GridShape& shape, ConstPlane3 P, bool reverse, Plane3 N) {
    for (int j = 0; j <= shape.nv; ++j)
        for (int i = 0; i <= shape.nu; ++i) {
            V3f normal = normal_at(shape, P, i, j);
            if (normal == V3f(0)) normal = normal_from_inside(shape, P, i, j);
            if (normal == V3f(0)) continue;
            if (reverse) normal = -normal;
            const int index = shape.row_index(i, j);
            for (int k = 0; k < 3; ++k) N[k][index] = normal[k];
        }
}

}  // namespace trapeze
