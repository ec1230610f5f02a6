#include "tessellate/dice.h"

#include <algorithm>
#include <cmath>

#include "tessellate/camera_variables.h"
#include "tessellate/normals.h"
#include "tessellate/shared_border.h"
#include "tessellate/topology/point_lanes.h"

namespace trapeze {
namespace {

/// Of the angle between derivatives below which no place is looked for.
constexpr double kLeastSquaredSine = 1e-10;
/// Steps of parameters that are no more than rounding.
constexpr float kCloseParameters = 1e-7f;

/// Makes one grid, step by step. One object a grid, on the stack: the steps share the subpatch' sides and the
/// lists of border points.
class Dicer {
  public:
    Dicer(const DiceContext& context, const Subpatch& subpatch, ShadingGrid& grid,
          DiceScratch::State& scratch)
        : context_(context),
          surface_(*context.surface),
          subpatch_(subpatch),
          attributes_(*surface_.primitive().attributes),
          grid_(grid),
          scratch_(scratch),
          shape_(subpatch.shape),
          count_(shape_.vertex_count()) {}

    /// Interior vertices are evaluated on the subpatch; border vertices then take the shared points'
    /// positions, because the same point evaluated on two faces differs in its last bits.
    void run(DiceFor wanted) {
        prepare_grid();
        const bool alone = is_alone();
        find_parameters();
        if (wanted == DiceFor::Hits && !context_.displaced) {
            evaluate_places();
            if (!alone) set_border_positions();
            if (has_own_colors()) set_variables();
            return;
        }
        evaluate();
        if (!alone) set_border_positions();
        set_normals();
        set_variables();
        if (context_.displaced) make_shared_border(context_, points(), border(), grid_, scratch_);
    }

    /// The face's parameters where the grid has a place in its unit square, which is within one of a
    /// micropolygon's two triangles (core/hit_micropolygon.h).
    V2f parameters_at(const V2f& at) {
        const PlaceInGrid place(at, shape_);
        const bool is_flat = context_.flat_cuts.are_wanted();
        if ((!place.is_on_border || is_alone()) && !is_flat)
            return subpatch_.lo + (subpatch_.hi - subpatch_.lo) * at;
        find_parameters();
        const std::array<V2f, 4> corners{uv_of(place, 0, 0), uv_of(place, 1, 0), uv_of(place, 0, 1),
                                         uv_of(place, 1, 1)};
        return is_flat ? parameters_on_flat(corners, place.within) : in_triangles(corners, place.within);
    }

    /// As run(), of a piece that shares no border with anything.
    void run_alone() {
        prepare_grid();
        grid_.border.clear();
        place_vertices();
        evaluate();
        set_normals();
        set_variables();
    }

  private:
    /// A place in the grid's unit square: in which micropolygon, and where in that.
    struct PlaceInGrid {
        std::array<int, 2> first;
        V2f within;
        bool is_on_border = false;

        PlaceInGrid(const V2f& at, const GridShape& shape) {
            const std::array<int, 2> segments{shape.nu, shape.nv};
            for (int axis = 0; axis < 2; ++axis) {
                const float place = std::clamp(at[axis], 0.0f, 1.0f) * static_cast<float>(segments[axis]);
                first[axis] = std::min(static_cast<int>(place), segments[axis] - 1);
                within[axis] = place - static_cast<float>(first[axis]);
                is_on_border |= first[axis] == 0 || first[axis] == segments[axis] - 1;
            }
        }
    };
    V2f uv_of(const PlaceInGrid& place, int i, int j) const {
        return scratch_.uv[shape_.row_index(place.first[0] + i, place.first[1] + j)];
    }

    /// Of values at a micropolygon's corners, on the triangle that holds a place of its unit square.
    template <class T>
    static T in_triangles(const std::array<T, 4>& corners, const V2f& within) {
        const float u = within.x, v = within.y;
        return corners[k00] * (1 - std::max(u, v)) + corners[k11] * std::min(u, v) +
               (u >= v ? corners[k10] * (u - v) : corners[k01] * (v - u));
    }

    /// The parameters of the place itself at key 0, by Newton's steps: a large triangle has them where its
    /// corners say only if the face is linear.
    V2f parameters_on_flat(const std::array<V2f, 4>& corners, const V2f& within) {
        std::array<V3f, 4> places;
        surface_.positions(subpatch_.face, corners, 1, scratch_.evaluation, places);
        const V3f wanted = in_triangles(places, within);
        V2f uv = in_triangles(corners, within);
        const float most = surface_.surface().last_parameter(subpatch_.face);
        constexpr int kSteps = 4;
        for (int step = 0; step < kSteps; ++step) {
            V3f P, along_u, along_v;
            surface_.positions_and_derivatives(subpatch_.face, {&uv, 1}, 1, scratch_.evaluation, {&P, 1},
                                               {&along_u, 1}, {&along_v, 1});
            const V3d off(wanted - P), u(along_u), v(along_v);
            const double uu = u.dot(u), across = u.dot(v), vv = v.dot(v);
            const double determinant = uu * vv - across * across;
            if (!(determinant > kLeastSquaredSine * uu * vv)) break;
            const double by_u = off.dot(u), by_v = off.dot(v);
            const V2f by(static_cast<float>((by_u * vv - by_v * across) / determinant),
                         static_cast<float>((by_v * uu - by_u * across) / determinant));
            uv.x = std::clamp(uv.x + by.x, 0.0f, most), uv.y = std::clamp(uv.y + by.y, 0.0f, most);
            if (std::abs(by.x) < kCloseParameters && std::abs(by.y) < kCloseParameters) break;
        }
        return uv;
    }

    /// Borders of pieces that are displaced are kept whatever they join.
    bool is_alone() const { return subpatch_.alone && !context_.displaced; }

    /// Of all vertices.
    void find_parameters() {
        if (!is_alone()) find_border();
        place_vertices();
        if (!all_in_place_)
            snap_border_parameters(context_.edges, subpatch_, sides_, points(), border(), context_.displaced,
                                   scratch_.uv);
    }

    /// Which of the subpatch's sides are the face's.
    uint8_t sides_of_face() const {
        const auto bit = [](bool is_on_it, uint8_t side) { return is_on_it ? side : uint8_t{0}; };
        return static_cast<uint8_t>(
            bit(subpatch_.lo.x <= 0, ShadingGrid::kFirstU) | bit(subpatch_.hi.x >= 1, ShadingGrid::kLastU) |
            bit(subpatch_.lo.y <= 0, ShadingGrid::kFirstV) | bit(subpatch_.hi.y >= 1, ShadingGrid::kLastV));
    }

    /// Sizes all of the grid's planes. P's of unused keys wait in the scratch, so that grids with fewer keys
    /// in between cost no allocations.
    void prepare_grid() {
        grid_.shape = shape_;
        grid_.face_sides = sides_of_face();
        grid_.key_count = surface_.key_count();
        grid_.primitive = &surface_.primitive();
        grid_.reverse_orientation = attributes_.reverse_orientation;
        grid_.displaced = false;
        grid_.I.resize(0);
        grid_.hit_vertex = -1, grid_.hit_level = 0, grid_.hit_place.reset();
        grid_.hit_ray = RayFootprint();
        grid_.medium = {};
        grid_.own_colors = grid_.is_end = false;
        grid_.shared_vertices.clear();
        if (!context_.displaced) grid_.border.clear();
        const size_t keys = surface_.key_count();
        std::vector<Triples>& spare = scratch_.spare_keys;
        for (; grid_.P.size() > keys; grid_.P.pop_back()) spare.push_back(std::move(grid_.P.back()));
        for (; grid_.P.size() < keys && !spare.empty(); spare.pop_back())
            grid_.P.push_back(std::move(spare.back()));
        grid_.P.resize(keys);
        for (Triples& P : grid_.P) P.resize(count_);
        for (Triples* t : {&grid_.N, &grid_.Ng, &grid_.dPdu, &grid_.dPdv, &grid_.Ci, &grid_.Oi})
            t->resize(count_);
        for (std::vector<float>* values : {&grid_.u, &grid_.v, &grid_.s, &grid_.t}) values->resize(count_);
        grid_.Cs.fill(count_, attributes_.color);
        grid_.Os.fill(count_, attributes_.opacity);
    }

    /// Lists the shared points of the four sides and which border vertex takes which. A side with more
    /// vertices than its edge repeats points: micropolygons there have sides of no length.
    void find_border() {
        for (int s = 0; s < 4; ++s) {
            BorderSide& side = sides_[s] = border_side(context_.edges, subpatch_.sides[s]);
            const EdgeLine line = context_.edges.line(side.edge);
            const int n = s == kBottom || s == kTop ? shape_.nu : shape_.nv;
            side.in_place = !context_.displaced && is_whole_edge(side, line, s, n);
            all_in_place_ &= side.in_place;
            const int first = point_count_;
            if (side.in_place) {
                for (const EdgeEnd* end : {&line.start, &line.finish}) {
                    const int corner = border_vertex(s, end == &line.start ? 0 : n);
                    scratch_.border_vertices[border_count_++] = {corner, point_count_, s, corner};
                    scratch_.points[point_count_++] = {true, end->id, {}, 1, false};
                }
                continue;
            }
            for (int i = 0; i <= side.count; ++i)
                scratch_.points[point_count_++] = context_.edges.vertex(line, *side.interval, side.vertex(i));
            for (int i = 0; i <= n; ++i) {
                const int point = side.vertex_of_border(i, n);
                const int corner = point == 0            ? border_vertex(s, 0)
                                   : point == side.count ? border_vertex(s, n)
                                                         : -1;
                scratch_.border_vertices[border_count_++] = {border_vertex(s, i), first + point, s, corner};
            }
        }
    }

    /// Whether a side is a whole edge of this face between vertices, as finely cut as the grid: then
    /// place_vertices() has the edge's own parameters.
    bool is_whole_edge(const BorderSide& side, const EdgeLine& line, int s, int n) const {
        const SurfaceSide& on = subpatch_.sides[s];
        if (line.face != subpatch_.face || side.count != n || side.interval->depth != 0 || on.begin != 0 ||
            on.end != 1 || line.start.on_edge || line.finish.on_edge)
            return false;
        const V2f& lo = subpatch_.lo;
        const V2f& hi = subpatch_.hi;
        const V2f from = s == kRight ? V2f(hi.x, lo.y) : s == kTop ? V2f(lo.x, hi.y) : lo;
        const V2f to = s == kBottom ? V2f(hi.x, lo.y) : s == kLeft ? V2f(lo.x, hi.y) : hi;
        return line.from == from && line.to == to && line_uv(line, *side.interval, n) == to;
    }

    std::span<const BorderPoint> points() const {
        return {scratch_.points.data(), static_cast<size_t>(point_count_)};
    }
    /// Side by side; corners come twice.
    std::span<const BorderVertex> border() const {
        return {scratch_.border_vertices.data(), static_cast<size_t>(border_count_)};
    }

    /// The grid's number of vertex i of a side, counted from its low end.
    int border_vertex(int side, int i) const {
        switch (side) {
            case kBottom:
                return shape_.row_index(i, 0);
            case kRight:
                return shape_.row_index(shape_.nu, i);
            case kTop:
                return shape_.row_index(i, shape_.nv);
            default:
                return shape_.row_index(0, i);
        }
    }

    /// Uniform over the subpatch, in the arithmetic of line_uv.
    void place_vertices() {
        scratch_.uv.resize(count_);
        const auto along = [](float lo, float hi, int i, int n) {
            return i == n ? hi : lo + (hi - lo) * (static_cast<float>(i) / static_cast<float>(n));
        };
        for (int j = 0; j <= shape_.nv; ++j)
            for (int i = 0; i <= shape_.nu; ++i)
                scratch_.uv[shape_.row_index(i, j)] = {along(subpatch_.lo.x, subpatch_.hi.x, i, shape_.nu),
                                                       along(subpatch_.lo.y, subpatch_.hi.y, j, shape_.nv)};
    }

    /// Positions at all keys and derivatives at the first, at all vertices.
    void evaluate() {
        const size_t keys = grid_.P.size();
        scratch_.P.resize(count_ * keys);
        scratch_.dPdu.resize(count_);
        scratch_.dPdv.resize(count_);
        surface_.positions_and_derivatives(subpatch_.face, scratch_.uv, static_cast<int>(keys),
                                           scratch_.evaluation, scratch_.P, scratch_.dPdu, scratch_.dPdv);
        for (size_t key = 0; key < keys; ++key)
            to_planes({scratch_.P.data() + key * count_, count_}, 1, grid_.P[key]);
    }

    /// Positions alone.
    void evaluate_places() {
        const size_t keys = grid_.P.size();
        scratch_.P.resize(count_ * keys);
        surface_.positions(subpatch_.face, scratch_.uv, static_cast<int>(keys), scratch_.evaluation,
                           scratch_.P);
        for (size_t key = 0; key < keys; ++key)
            to_planes({scratch_.P.data() + key * count_, count_}, 1, grid_.P[key]);
    }

    /// Whether the primitive has variables that stand for Cs or Os.
    bool has_own_colors() const {
        return std::ranges::any_of(surface_.primitive().shape().variables.values, [](const Parameter& value) {
            return value.name == "Cs" || value.name == "Os";
        });
    }

    /// A border vertex that lies at its edge's vertex, bit for bit, has its position already.
    bool is_in_place(int vertex, const BorderPoint& point) const {
        return !point.is_vertex && point.at.face == subpatch_.face && point.at.uv == scratch_.uv[vertex];
    }

    /// Puts border vertices where their shared points are, at all keys. Only the others are evaluated.
    void set_border_positions() {
        const size_t keys = grid_.P.size();
        std::array<BorderPoint, kMaxBorderPoints>& wanted = scratch_.wanted;
        std::array<int, kMaxBorderPoints> place;  // of border points in `wanted`; -1: not wanted
        std::fill_n(place.begin(), point_count_, -1);
        size_t count = 0;
        for (const BorderVertex& at : border()) {
            if (place[at.point] >= 0 || is_in_place(at.vertex, scratch_.points[at.point])) continue;
            place[at.point] = static_cast<int>(count);
            wanted[count++] = scratch_.points[at.point];
        }
        scratch_.border.resize(std::max(scratch_.border.size(), kMaxBorderPoints * keys));
        border_positions(surface_, *context_.vertices, {wanted.data(), count}, scratch_.evaluation,
                         scratch_.border);
        for (const BorderVertex& at : border()) {
            if (place[at.point] < 0) continue;
            for (size_t key = 0; key < keys; ++key)
                grid_.P[key].set(at.vertex, scratch_.border[place[at.point] * keys + key]);
        }
    }

    /// Unit normals that point outside, and derivatives by the whole surface's parameters.
    void set_normals() {
        const float outside = attributes_.reverse_orientation ? -1.0f : 1.0f;
        scratch_.degenerate.clear();
        unit_normals(scratch_.dPdu, scratch_.dPdv, grid_.Ng);
        for (size_t i = 0; i < count_; ++i) {
            if (grid_.Ng.at(i) != V3f(0, 0, 0)) continue;
            const V3f n = normal_at(surface_, {subpatch_.face, scratch_.uv[i]}, scratch_.evaluation,
                                    &scratch_.dPdu[i], &scratch_.dPdv[i]);
            if (n == V3f(0, 0, 0)) scratch_.degenerate.push_back(static_cast<int>(i));
            grid_.Ng.set(i, n);
        }
        if (outside < 0)
            for (std::vector<float>& plane : grid_.Ng.c)
                for (float& value : plane) value = -value;
        borrow_normals();
        const V2f faces = surface_.surface().faces_per_unit(subpatch_.face);
        to_planes(scratch_.dPdu, faces.x, grid_.dPdu);
        to_planes(scratch_.dPdv, faces.y, grid_.dPdv);
        for (int k = 0; k < 3; ++k) std::ranges::copy(grid_.Ng.c[k], grid_.N.c[k].begin());
    }

    /// Where the surface has no normal, the nearest vertex' that has one; else towards the eye.
    void borrow_normals() {
        for (const int vertex : scratch_.degenerate) {
            const int row = shape_.vertices_u(), i = vertex % row, j = vertex / row;
            V3f normal(0, 0, -1);
            int nearest = 1 << 20;
            for (size_t other = 0; other < count_; ++other) {
                const V3f n = grid_.Ng.at(other);
                const int du = static_cast<int>(other) % row - i, dv = static_cast<int>(other) / row - j;
                if (n == V3f(0, 0, 0) || du * du + dv * dv >= nearest) continue;
                if (std::ranges::binary_search(scratch_.degenerate, static_cast<int>(other))) continue;
                nearest = du * du + dv * dv, normal = n;
            }
            grid_.Ng.set(vertex, normal);
        }
    }

    /// Primitive variables at the vertices, and shading normals where the primitive has its own.
    void set_variables() {
        const bool own_normals = surface_.surface().evaluate_variables(
            subpatch_.face, scratch_.uv, scratch_.evaluation.of(surface_.surface()), grid_);
        const M44f& camera_from_object = surface_.camera_from_object(0);
        if (own_normals) normals_to_camera_space(camera_from_object, grid_.Ng, grid_.N);
        for (GridVariable& variable : grid_.variables) to_camera_space(camera_from_object, variable);
    }

    const DiceContext& context_;
    const PlacedSurface& surface_;
    const Subpatch& subpatch_;
    const Attributes& attributes_;
    ShadingGrid& grid_;
    DiceScratch::State& scratch_;
    const GridShape shape_;
    const size_t count_;
    std::array<BorderSide, 4> sides_;
    int point_count_ = 0, border_count_ = 0;
    bool all_in_place_ = true;  ///< all sides are
};

/// Micropolygons along u and v whose sides are as long as the shading rate wishes.
std::array<int, 2> shaded_segments(const DiceContext& context, const Subpatch& subpatch,
                                   DiceScratch::State& scratch) {
    if (!context.flat_cuts.are_wanted()) return {subpatch.shape.nu, subpatch.shape.nv};
    const V2f &lo = subpatch.lo, &hi = subpatch.hi;
    std::array<V3f, 4> corners;
    context.surface->positions(subpatch.face, std::array{lo, V2f(hi.x, lo.y), V2f(lo.x, hi.y), hi}, 1,
                               scratch.evaluation, corners);
    return context.flat_cuts.fine_segments(corners);
}

}  // namespace

void dice_subpatch(const DiceContext& context, const Subpatch& subpatch, ShadingGrid& grid,
                   DiceScratch::State& scratch, DiceFor wanted) {
    Dicer(context, subpatch, grid, scratch).run(wanted);
}

/// A grid of one micropolygon whose sides are as long as those of the subpatch's own, so that derivatives are
/// the same as in the whole grid. It lies beyond the place, or before it where it would reach out of the
/// subpatch, or of what flat faces' parameters mean.
int dice_point(const DiceContext& context, const Subpatch& subpatch, const V2f& at, ShadingGrid& grid,
               DiceScratch::State& scratch) {
    const V2f place = Dicer(context, subpatch, grid, scratch).parameters_at(at);
    Subpatch piece = subpatch;
    piece.shape = {1, 1};
    int vertex = 0;
    const std::array<int, 2> segments = shaded_segments(context, subpatch, scratch);
    // Large micropolygons may reach far over the border, where they share a neighbour's vertices.
    const bool is_flat = context.flat_cuts.are_wanted();
    for (int axis = 0; axis < 2; ++axis) {
        const float lo = is_flat ? 0 : subpatch.lo[axis];
        const float hi =
            is_flat ? context.surface->surface().last_parameter(subpatch.face) : subpatch.hi[axis];
        const float side = (subpatch.hi[axis] - subpatch.lo[axis]) / static_cast<float>(segments[axis]);
        const float from = std::clamp(place[axis], lo, hi);
        const bool is_high = from + side > hi;  // then the other vertex is before it
        piece.lo[axis] = is_high ? std::max(from - side, lo) : from;
        piece.hi[axis] = is_high ? from : from + side;
        if (is_high) vertex += axis == 0 ? 1 : 2;
    }
    Dicer(context, piece, grid, scratch).run_alone();
    return vertex;
}

}  // namespace trapeze
