#include "shade/grid_footprints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "core/axes_around.h"
#include "core/portable_math.h"
#include "core/scene/scene.h"
#include "shade/materials/polygon_parameters.h"
#include "shade/planes/differences.h"

namespace trapeze {
namespace {

/// The least length of a footprint's axis, in pixels: what a micropolygon that is seen square on covers at a
/// shading rate of 1. Half of it is a little nearer to the truth, since the pixel filter spreads once more,
/// but far rows show grain.
constexpr float kLeastAxis = 1.0f;
/// The least cosine of the angle between the view's axis and a point that is projected: points farther aside
/// are left as they are.
constexpr float kLeastCosine = 0.05f;

/// The mean parameter steps of a piece, measured along its middle: vertices of its borders may be moved along
/// them to where a neighbour has its own. `first` is the piece's first vertex.
ParameterSteps mean_steps(const ShadingGrid& grid, size_t first) {
    const GridShape& shape = grid.shape;
    const auto step = [&](const std::vector<float>& values, int from, int to, int count, float alone) {
        return count > 0
                   ? (values[first + static_cast<size_t>(to)] - values[first + static_cast<size_t>(from)]) /
                         static_cast<float>(count)
                   : alone;
    };
    const int u0 = shape.row_index(0, shape.nv / 2), u1 = shape.row_index(shape.nu, shape.nv / 2);
    const int v0 = shape.row_index(shape.nu / 2, 0), v1 = shape.row_index(shape.nu / 2, shape.nv);
    return {{step(grid.u, u0, u1, shape.nu, 1), step(grid.v, u0, u1, shape.nu, 0)},
            {step(grid.u, v0, v1, shape.nv, 0), step(grid.v, v0, v1, shape.nv, 1)}};
}

/// Whether the grid is of a patch that is trimmed: its border's pieces lie as the curves run.
bool is_trimmed(const ShadingGrid& grid) {
    if (!grid.primitive || grid.primitive->shape_keys.empty()) return false;
    const auto* patch = std::get_if<NuPatch>(&grid.primitive->shape().topology);
    return patch && !patch->trim_loops.empty();
}

/// Parameter steps of a piece: u goes along the first axis and v along the second, except on polygons, where
/// they are places in object space, and on trimmed patches.
ParameterSteps parameter_steps(const ShadingGrid& grid, size_t first) {
    ParameterSteps steps = mean_steps(grid, first);
    if (has_places_as_parameters(grid)) {
        const V2f of_face = steps_of_face(grid, first / static_cast<size_t>(grid.shape.vertex_count()));
        if (of_face.x == 0) return steps;
        steps.along_u.x = of_face.x, steps.along_v.y = of_face.y;
    } else if (is_trimmed(grid)) {
        return steps;
    }
    steps.along_u.y = steps.along_v.x = 0;
    return steps;
}

/// How far a parameter goes over both steps together, each made wider by a factor: du and dv of the language,
/// with which textures are filtered. Never negative, whichever way a grid's axes run.
float way_of(float along_u, float wider_u, float along_v, float wider_v) {
    return std::abs(along_u) * wider_u + std::abs(along_v) * wider_v;
}

/// The step from a vertex of a displaced piece to the next along an axis, taken at a vertex inside, since
/// border vertices may share places. `index` is in row order in the piece.
V3f displaced_step(const ShadingGrid& grid, size_t piece, int index, GridAxis axis) {
    const GridShape& shape = grid.shape;
    const auto inside = [](int i, int last) { return last >= 2 ? std::clamp(i, 1, last - 1) : i; };
    const int i = inside(index % shape.vertices_u(), shape.nu),
              j = inside(index / shape.vertices_u(), shape.nv);
    const int u = axis == GridAxis::U ? 1 : 0, v = 1 - u;
    const int i0 = std::max(i - u, 0), i1 = std::min<int>(i + u, shape.nu);
    const int j0 = std::max(j - v, 0), j1 = std::min<int>(j + v, shape.nv);
    const Triples& P = grid.P.front();
    const V3f way = P.at(piece + static_cast<size_t>(shape.row_index(i1, j1))) -
                    P.at(piece + static_cast<size_t>(shape.row_index(i0, j0)));
    return way / static_cast<float>(std::max(i1 - i0 + j1 - j0, 1));
}

/// The steps along u and v, camera space, that a vertex's micropolygon has.
struct VertexSteps {
    V3f u, v;

    VertexSteps(const ShadingGrid& grid, size_t piece, size_t vertex, const ParameterSteps& step) {
        if (!grid.displaced) {
            const V3f dPdu = grid.dPdu.at(vertex), dPdv = grid.dPdv.at(vertex);
            u = dPdu * step.along_u.x + dPdv * step.along_u.y;
            v = dPdu * step.along_v.x + dPdv * step.along_v.y;
            return;
        }
        const int index = static_cast<int>(vertex - piece);
        u = displaced_step(grid, piece, index, GridAxis::U);
        v = displaced_step(grid, piece, index, GridAxis::V);
    }
    /// Whether the steps make a plane: false where the surface has none, as at a pole.
    bool span_a_plane() const {
        constexpr float kLeastSine = 1e-4f;
        return u.cross(v).length2() > kLeastSine * kLeastSine * u.length2() * v.length2();
    }
};

/// A small vector `d` at P as it is seen, in pixels: the derivative of the projection. `pixels` is how many
/// one unit is at depth 1 (at any depth without perspective).
V2f seen(const V3f& P, const V3f& d, const V2f& pixels, bool perspective) {
    if (!perspective) return {d.x * pixels.x, d.y * pixels.y};
    const float nearness = 1 / P.z;
    return {(d.x - P.x * nearness * d.z) * nearness * pixels.x,
            (d.y - P.y * nearness * d.z) * nearness * pixels.y};
}

/// The stretch of a micropolygon at P; none behind the eye, far aside, or where the surface has no plane.
Stretch stretch_at(const V3f& P, const VertexSteps& along, const Camera& camera, float least) {
    if (camera.perspective && !(P.z > 0 && P.z * P.z > kLeastCosine * kLeastCosine * P.length2())) return {};
    const V2f pixels(std::abs(1 / camera.plane_scale_x), std::abs(1 / camera.plane_scale_y));
    const Stretch found = stretch_to_least(seen(P, along.u, pixels, camera.perspective),
                                           seen(P, along.v, pixels, camera.perspective), least);
    return along.span_a_plane() && found.is_finite() ? found : Stretch();
}

/// The stretch of a micropolygon that a ray has hit, which comes along `I`: up to where the rays beside it
/// meet the plane. Where these are not known it is as large as the micropolygon at least. None where the
/// surface has no plane.
Stretch stretch_at_hit(const ShadingGrid& grid, const V3f& I, const VertexSteps& along) {
    const RayFootprint& ray = grid.hit_ray;
    const V3f way = unit_or_zero(I);
    if (way == V3f(0, 0, 0) || !along.span_a_plane()) return {};
    const AxesAround<float> axes(way);
    const Stretch found = stretch_to_ellipse(axes.across_of(along.u), axes.across_of(along.v),
                                             axes.across_of(grid.hit_across[0]),
                                             axes.across_of(grid.hit_across[1]), ray.width, ray.is_known());
    return found.is_finite() ? found : Stretch();
}

/// Marks with 1 the vertices of a piece that stretch_at() may stretch, the others with 0; for a piece that is
/// not displaced. Most need no closer look: their micropolygon's area is so large that no axis is short.
void find_thin(const ShadingGrid& grid, size_t piece, const ParameterSteps& step, const Camera& camera,
               float least, Plane thin) {
    const auto from = [piece](const Triples& triples, int k) { return triples.c[k].data() + piece; };
    const float *const Px = from(grid.P.front(), 0), *const Py = from(grid.P.front(), 1),
                       *const Pz = from(grid.P.front(), 2);
    const float *const ux = from(grid.dPdu, 0), *const uy = from(grid.dPdu, 1),
                       *const uz = from(grid.dPdu, 2);
    const float *const vx = from(grid.dPdv, 0), *const vy = from(grid.dPdv, 1),
                       *const vz = from(grid.dPdv, 2);
    const float pixels_x = std::abs(1 / camera.plane_scale_x), pixels_y = std::abs(1 / camera.plane_scale_y);
    const float of_depth = camera.perspective ? 1.0f : 0.0f;  // seen(), without a branch
    const V2f U = step.along_u, V = step.along_v;
    float* __restrict const out = thin.data();
    for (size_t i = 0; i < thin.size(); ++i) {
        const float nearness = of_depth / Pz[i] + (1 - of_depth), x = Px[i] * nearness * of_depth,
                    y = Py[i] * nearness * of_depth;
        const float across = nearness * pixels_x, down = nearness * pixels_y;
        const float z_of_u = uz[i] * U.x + vz[i] * U.y, z_of_v = uz[i] * V.x + vz[i] * V.y;
        const float x_of_u = (ux[i] * U.x + vx[i] * U.y - x * z_of_u) * across;
        const float y_of_u = (uy[i] * U.x + vy[i] * U.y - y * z_of_u) * down;
        const float x_of_v = (ux[i] * V.x + vx[i] * V.y - x * z_of_v) * across;
        const float y_of_v = (uy[i] * V.x + vy[i] * V.y - y * z_of_v) * down;
        const float area = x_of_u * y_of_v - y_of_u * x_of_v;
        const float squares = x_of_u * x_of_u + y_of_u * y_of_u + x_of_v * x_of_v + y_of_v * y_of_v;
        // The shorter axis is not less than area / root of the squares' sum; half a thousandth is for
        // rounding.
        out[i] = area * area >= 1.001f * least * least * squares ? 0.0f : 1.0f;
    }
}

}  // namespace

const vm::Footprint& GridFootprints::get() {
    if (found_) return footprint_;
    found_ = true;
    size_t vertices = 0;
    for (const ShadingGrid* grid : grids_) vertices += grid->vertex_count();
    pool_.start(vertices);
    Plane* const planes[] = {&u_,  &v_,  &u_of_a_, &v_of_a_, &u_of_b_, &v_of_b_,
                             &du_, &dv_, &uu_,     &uv_,     &vv_,     &widening_};
    for (Plane* plane : planes) *plane = pool_.take();
    thin_ = pool_.take();
    size_t first = 0;
    for (const ShadingGrid* grid : grids_) {
        std::ranges::copy(grid->u, u_.begin() + static_cast<std::ptrdiff_t>(first));
        std::ranges::copy(grid->v, v_.begin() + static_cast<std::ptrdiff_t>(first));
        find(*grid, first);
        first += grid->vertex_count();
    }
    for (Plane* plane : planes)
        std::fill(plane->begin() + static_cast<std::ptrdiff_t>(first), plane->end(),
                  first > 0 ? (*plane)[first - 1] : 0.0f);
    const auto operand = [](Plane plane) { return vm::Operand{plane.data(), ~size_t{0}, 0, 0, 0}; };
    footprint_ = {operand(u_), operand(v_), u_of_a_.data(),   v_of_a_.data(), u_of_b_.data(), v_of_b_.data(),
                  du_.data(),  dv_.data(),  widening_.data(), uu_.data(),     uv_.data(),     vv_.data()};
    return footprint_;
}

void GridFootprints::find(const ShadingGrid& grid, size_t first) {
    const auto in_piece = static_cast<size_t>(grid.shape.vertex_count());
    for (size_t piece = 0; piece < grid.vertex_count(); piece += in_piece) {
        const ParameterSteps step = parameter_steps(grid, piece);
        const V2f &U = step.along_u, &V = step.along_v;
        const auto fill = [&](Plane& plane, float value) {
            std::fill_n(plane.begin() + static_cast<std::ptrdiff_t>(first + piece), in_piece, value);
        };
        fill(u_of_a_, U.x), fill(v_of_a_, U.y), fill(u_of_b_, V.x), fill(v_of_b_, V.y);
        fill(du_, way_of(U.x, 1, V.x, 1)), fill(dv_, way_of(U.y, 1, V.y, 1));
        fill(uu_, 1), fill(uv_, 0), fill(vv_, 1), fill(widening_, 1);
        if (!stretched_) continue;
        if (grid.I.size() > 0)
            stretch_to_ray(grid, piece, first + piece, step);
        else
            stretch_to_pixels(grid, piece, first + piece, step);
    }
}

void GridFootprints::stretch_to_pixels(const ShadingGrid& grid, size_t piece, size_t lane,
                                       const ParameterSteps& step) {
    const auto in_piece = static_cast<size_t>(grid.shape.vertex_count());
    const float rate = grid.primitive ? grid.primitive->attributes->shading_rate : 1.0f;
    const float least = kLeastAxis * std::sqrt(std::clamp(rate, 0.0f, 1.0f));
    const Triples& P = grid.P.front();
    const Plane thin = thin_.subspan(lane, in_piece);
    if (grid.displaced)
        std::ranges::fill(thin, 1.0f);
    else
        find_thin(grid, piece, step, camera_, least, thin);
    for (size_t i = 0; i < in_piece; ++i) {
        if (thin[i] == 0) continue;
        const size_t vertex = piece + i;
        put(lane + i, step, stretch_at(P.at(vertex), VertexSteps(grid, piece, vertex, step), camera_, least));
    }
}

void GridFootprints::stretch_to_ray(const ShadingGrid& grid, size_t piece, size_t lane,
                                    const ParameterSteps& step) {
    for (size_t i = 0; i < static_cast<size_t>(grid.shape.vertex_count()); ++i) {
        const size_t vertex = piece + i;
        put(lane + i, step, stretch_at_hit(grid, grid.I.at(vertex), VertexSteps(grid, piece, vertex, step)));
    }
}

void GridFootprints::put(size_t lane, const ParameterSteps& step, const Stretch& s) {
    const V2f &U = step.along_u, &V = step.along_v;
    const float wider_u = portable::hypot(s.uu, s.uv), wider_v = portable::hypot(s.uv, s.vv);
    uu_[lane] = s.uu, uv_[lane] = s.uv, vv_[lane] = s.vv;
    u_of_a_[lane] = U.x * s.uu + V.x * s.uv, v_of_a_[lane] = U.y * s.uu + V.y * s.uv;
    u_of_b_[lane] = U.x * s.uv + V.x * s.vv, v_of_b_[lane] = U.y * s.uv + V.y * s.vv;
    du_[lane] = way_of(U.x, wider_u, V.x, wider_v), dv_[lane] = way_of(U.y, wider_u, V.y, wider_v);
    widening_[lane] = wider_u * wider_v;
}

}  // namespace trapeze
