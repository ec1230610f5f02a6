#include "tessellate/shared_border.h"

#include <algorithm>
#include <cmath>

#include "tessellate/camera_variables.h"
#include "tessellate/normals.h"

namespace trapeze {
namespace {

/// A piece has 2x2 vertices; its sides are at most half a face long, so that it fits into the face whichever
/// way it lies, and not so small that differences round away.
constexpr size_t kPieceVertices = 4;
constexpr float kLeastStep = 1.0f / (1 << 14), kLargestStep = 0.5f;

/// A point that border vertices share, and its place among the pieces.
struct SharedPoint {
    const BorderPoint* point = nullptr;
    int first_vertex = 0;  ///< of the border grids' vertices in a row, the one that is the point itself

    /// What makes points the same, and the order of pieces: face by face.
    auto key() const {
        // Poles and other vertices are told by their number: edges may reach them on several faces.
        const V2f uv = point->is_vertex ? V2f(0, 0) : point->at.uv;
        return std::tuple(point->at.face, point->is_vertex, point->is_vertex ? point->vertex : 0, uv.x, uv.y);
    }
};

/// Makes the pieces of 2x2 vertices of points on one face, as a grid of `pieces` grids.
class PieceMaker {
  public:
    PieceMaker(const DiceContext& context, int face, DiceScratch::State& scratch)
        : context_(context), surface_(*context.surface), face_(face), scratch_(scratch) {}

    /// Makes the pieces of points[0..n): vertex numbers are set relative to the grid's first vertex.
    void make(std::span<SharedPoint> points, ShadingGrid& grid) {
        place_vertices(points);
        grid.shape = {1, 1};
        grid.pieces = static_cast<int>(points.size());
        grid.key_count = 1;
        grid.primitive = &surface_.primitive();
        grid.reverse_orientation = attributes().reverse_orientation;
        grid.P.resize(1);
        const size_t count = grid.vertex_count();
        for (Triples* t : {&grid.P[0], &grid.N, &grid.Ng, &grid.dPdu, &grid.dPdv, &grid.Ci, &grid.Oi})
            t->resize(count);
        for (std::vector<float>* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(count);
        grid.Cs.fill(count, attributes().color);
        grid.Os.fill(count, attributes().opacity);
        evaluate(grid);
        set_variables(grid);
    }

  private:
    const Attributes& attributes() const { return *surface_.primitive().attributes; }

    /// The parameter at the piece's other side, and whether that is the greater one.
    static float other_side(float at, float step) { return at + step <= 1 ? at + step : at - step; }

    /// A micropolygon's length in the face's parameter, where the surface runs along `derivative`.
    float step(const V3f& P, const V3f& derivative) const {
        constexpr float kProbe = 1.0f / 256;
        // Pixels for a unit of the parameter; a probe, because the derivative alone has no length on the
        // picture.
        const float pixels = context_.metric->length(P, P + derivative * kProbe) / kProbe;
        const float wanted = context_.pixels_per_segment / pixels;
        return pixels > 0 && wanted < kLargestStep ? std::max(wanted, kLeastStep) : kLargestStep;
    }

    void place_vertices(std::span<SharedPoint> points) {
        const size_t n = points.size();
        std::vector<V2f>& uv = scratch_.uv;
        uv.resize(n);
        for (size_t i = 0; i < n; ++i) uv[i] = points[i].point->at.uv;
        scratch_.P.resize(n), scratch_.dPdu.resize(n), scratch_.dPdv.resize(n);
        surface_.positions_and_derivatives(face_, uv, 1, scratch_.evaluation, scratch_.P, scratch_.dPdu,
                                           scratch_.dPdv);
        uv.resize(n * kPieceVertices);
        // From the last on: each point's parameters give way to four.
        for (size_t i = n; i-- > 0;) {
            const V2f at = uv[i];
            const float u = other_side(at.x, step(scratch_.P[i], scratch_.dPdu[i]));
            const float v = other_side(at.y, step(scratch_.P[i], scratch_.dPdv[i]));
            const V2f lo(std::min(at.x, u), std::min(at.y, v)), hi(std::max(at.x, u), std::max(at.y, v));
            const size_t first = i * kPieceVertices;
            uv[first] = lo, uv[first + 1] = {hi.x, lo.y}, uv[first + 2] = {lo.x, hi.y}, uv[first + 3] = hi;
            points[i].first_vertex = static_cast<int>(first) + (u < at.x ? 1 : 0) + (v < at.y ? 2 : 0);
        }
    }

    /// Positions, normals and derivatives at shutter open, as Dicer makes them for a grid.
    void evaluate(ShadingGrid& grid) {
        const size_t count = grid.vertex_count();
        scratch_.P.resize(count), scratch_.dPdu.resize(count), scratch_.dPdv.resize(count);
        surface_.positions_and_derivatives(face_, scratch_.uv, 1, scratch_.evaluation, scratch_.P,
                                           scratch_.dPdu, scratch_.dPdv);
        const float outside = attributes().reverse_orientation ? -1.0f : 1.0f;
        const V2f faces = surface_.surface().faces_per_unit(face_);
        for (size_t i = 0; i < count; ++i) {
            V3f du = scratch_.dPdu[i], dv = scratch_.dPdv[i];
            V3f normal = normal_at(surface_, {face_, scratch_.uv[i]}, scratch_.evaluation, &du, &dv);
            if (normal == V3f(0, 0, 0)) normal = V3f(0, 0, -outside);  // towards the eye
            grid.P[0].set(i, scratch_.P[i]);
            grid.Ng.set(i, normal * outside);
            grid.dPdu.set(i, du * faces.x);
            grid.dPdv.set(i, dv * faces.y);
        }
        for (int k = 0; k < 3; ++k) std::ranges::copy(grid.Ng.c[k], grid.N.c[k].begin());
    }

    /// As the grid's own: the piece is shaded by the same shaders.
    void set_variables(ShadingGrid& grid) {
        const bool own_normals = surface_.surface().evaluate_variables(
            face_, scratch_.uv, scratch_.evaluation.of(surface_.surface()), grid);
        const M44f& camera_from_object = surface_.camera_from_object(0);
        if (own_normals) normals_to_camera_space(camera_from_object, grid.Ng, grid.N);
        for (GridVariable& variable : grid.variables) to_camera_space(camera_from_object, variable);
    }

    const DiceContext& context_;
    const PlacedSurface& surface_;
    const int face_;
    DiceScratch::State& scratch_;
};

}  // namespace

/// Points that two sides list, corners above all, are one here: they are sorted by what makes them the same,
/// and each border vertex finds its point by a search.
void make_shared_border(const DiceContext& context, std::span<const BorderPoint> points,
                        std::span<const BorderVertex> border, ShadingGrid& grid,
                        DiceScratch::State& scratch) {
    std::array<SharedPoint, kMaxBorderPoints> all;
    for (size_t i = 0; i < points.size(); ++i) all[i].point = &points[i];
    const auto less = [](const SharedPoint& a, const SharedPoint& b) { return a.key() < b.key(); };
    std::sort(all.begin(), all.begin() + points.size(), less);
    const auto same = [](const SharedPoint& a, const SharedPoint& b) { return a.key() == b.key(); };
    const auto end = std::unique(all.begin(), all.begin() + points.size(), same);

    // Sorted points of one face come together: a grid of pieces for each face.
    size_t faces = 0;
    int vertices = 0;
    for (auto first = all.begin(); first != end; ++faces) {
        const int face = first->point->at.face;
        const auto last =
            std::find_if(first, end, [&](const SharedPoint& p) { return p.point->at.face != face; });
        if (grid.border.size() <= faces) grid.border.emplace_back();
        ShadingGrid& pieces = grid.border[faces];
        PieceMaker(context, face, scratch).make({first, last}, pieces);
        for (auto p = first; p != last; ++p) p->first_vertex += vertices;
        vertices += static_cast<int>(pieces.vertex_count());
        first = last;
    }
    grid.border.resize(faces);

    grid.shared_vertices.clear();
    for (const BorderVertex& at : border) {
        const auto found = std::lower_bound(all.begin(), end, SharedPoint{&points[at.point], 0}, less);
        grid.shared_vertices.push_back({at.vertex, found->first_vertex});
    }
}

}  // namespace trapeze
