#include "tessellate/surfaces/nurbs/trimmed_patch.h"

#include <algorithm>
#include <cmath>

#include "tessellate/surfaces/face_evaluation.h"
#include "tessellate/surfaces/nurbs/knot_spans.h"
#include "tessellate/surfaces/nurbs/trim_cells.h"
#include "tessellate/topology/mesh_topology.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// Cells across the patch along each direction, at least.
constexpr int kCells = 24;

/// The patch's parameter plane in cells: each knot span, which is a face of the whole patch, has equally
/// many, so that no piece lies on two faces.
struct CellPlane {
    int columns = 1, rows = 1;        ///< knot spans
    int per_column = 1, per_row = 1;  ///< cells

    int face_of(TrimmedCells::Cell cell) const { return cell.j / per_row * columns + cell.i / per_column; }
};

/// The pieces of cells as faces; every point of them is evaluated on the whole patch.
class TrimmedPatch : public TopologySurface<TrimmedPatch> {
  public:
    TrimmedPatch(std::unique_ptr<Surface> whole, TrimmedCells cells, const CellPlane& plane)
        : whole_(std::move(whole)),
          cells_(std::move(cells)),
          plane_(plane),
          topology_(cells_.vertices_per_face, cells_.vertices, static_cast<int>(cells_.points.size()), 4,
                    {}) {}

    const MeshTopology& topology() const { return topology_; }
    std::unique_ptr<SurfaceScratch> make_scratch() const override { return whole_->make_scratch(); }
    V2f faces_per_unit(int face) const override {
        return whole_->faces_per_unit(plane_.face_of(cell(topology_.piece(face))));
    }

    /// Derivatives are by the parameters of the whole patch's face: those of the pieces run at odds with the
    /// surface's.
    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override {
        const FacePiece piece = topology_.piece(face);
        whole_->evaluate(plane_.face_of(cell(piece)), on_whole(piece, uv), shape_key, scratch, P, dPdu, dPdv);
    }
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override {
        const FacePiece piece = topology_.piece(face);
        return whole_->evaluate_variables(plane_.face_of(cell(piece)), on_whole(piece, uv), scratch, grid);
    }
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override {
        const FacePiece piece = topology_.piece(face);
        const V2f corners[4] = {lo, {hi.x, lo.y}, {lo.x, hi.y}, hi};
        V2f least(1, 1), most(0, 0);  // a bilinear piece lies within its corners' hull
        for (const V2f& p : on_whole(piece, corners))
            for (int k = 0; k < 2; ++k)
                least[k] = std::min(least[k], p[k]), most[k] = std::max(most[k], p[k]);
        constexpr float kRounding = 1e-6f;
        for (int k = 0; k < 2; ++k)
            least[k] = std::max(least[k] - kRounding, 0.0f), most[k] = std::min(most[k] + kRounding, 1.0f);
        return whole_->bound(plane_.face_of(cell(piece)), least, most, shape_key);
    }

  private:
    TrimmedCells::Cell cell(const FacePiece& piece) const { return cells_.cells[piece.mesh_face]; }

    /// Points of a piece as points of the whole patch's face.
    std::vector<V2f> on_whole(const FacePiece& piece, std::span<const V2f> uv) const {
        const TrimmedCells::Cell at = cell(piece);
        // The least cell of the span that the piece lies in: (0, 0) of the whole patch's face.
        const double first_i = at.i / plane_.per_column * plane_.per_column;
        const double first_j = at.j / plane_.per_row * plane_.per_row;
        std::vector<V2f> corners, result(uv.size());
        for (const int v : topology_.face_vertices(piece.mesh_face)) {
            const V2d& p = cells_.points[v];
            corners.push_back({static_cast<float>((p.x - first_i) / plane_.per_column),
                               static_cast<float>((p.y - first_j) / plane_.per_row)});
        }
        if (uv.empty()) return result;
        evaluate_linear_piece(piece, &corners.front().x, 2, uv, {&result.front().x, 2, 1}, {}, {});
        // Points at the rim lie a little outside (off_lines() in trim_cells.cpp).
        for (V2f& p : result) p = {std::clamp(p.x, 0.0f, 1.0f), std::clamp(p.y, 0.0f, 1.0f)};
        return result;
    }

    const std::unique_ptr<Surface> whole_;
    const TrimmedCells cells_;
    const CellPlane plane_;
    const MeshTopology topology_;
};

}  // namespace

/// A loop with a point more wherever it goes from one knot span to the next, along an axis: within a span,
/// shares of the range and cells are straight lines of each other, across several they are not.
std::vector<V2d> cut_between_spans(const std::vector<V2d>& loop, int axis, const KnotSpans& spans) {
    std::vector<V2d> result;
    for (size_t i = 0; i < loop.size(); ++i) {
        const V2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
        result.push_back(a);
        const bool rises = a[axis] < b[axis];
        const auto span_at = [&](double share) {
            return static_cast<int>(std::clamp(spans.spans_before(share), 0.0, spans.count() - 1.0));
        };
        const int first = span_at(std::min(a[axis], b[axis])) + 1, last = span_at(std::max(a[axis], b[axis]));
        for (int n = first; n <= last; ++n) {
            const double border = spans.begin_of_share(rises ? n : first + last - n);
            const double share = (border - a[axis]) / (b[axis] - a[axis]);
            if (share > 0 && share < 1) result.push_back(a + (b - a) * share);
        }
    }
    return result;
}

/// Pieces are not smaller than the loops need, but at least so small that a bilinear piece of the parameter
/// plane follows the loop's points.
std::unique_ptr<Surface> make_trimmed_patch(const NuPatch& patch, std::unique_ptr<Surface> whole) {
    const KnotSpans u(patch.u_knots, patch.u_order, patch.u_begin, patch.u_end);
    const KnotSpans v(patch.v_knots, patch.v_order, patch.v_begin, patch.v_end);
    CellPlane plane;
    plane.columns = u.count(), plane.rows = v.count();
    plane.per_column = (kCells + u.count() - 1) / u.count();
    plane.per_row = (kCells + v.count() - 1) / v.count();
    std::vector<std::vector<V2d>> loops = flattened_loops(patch);
    for (std::vector<V2d>& loop : loops) {
        loop = cut_between_spans(cut_between_spans(loop, 0, u), 1, v);
        // From shares of the range to cells: spans have equally many, however long they are.
        for (V2d& p : loop) p = {u.spans_before(p.x) * plane.per_column, v.spans_before(p.y) * plane.per_row};
    }
    TrimmedCells cells = trim_cells(std::move(loops), plane.columns * plane.per_column,
                                    plane.rows * plane.per_row, patch.trim_outside);
    if (cells.cells.empty()) return nullptr;
    return std::make_unique<TrimmedPatch>(std::move(whole), std::move(cells), plane);
}

}  // namespace trapeze
