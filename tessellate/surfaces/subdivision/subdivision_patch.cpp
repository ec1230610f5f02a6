#include "tessellate/surfaces/subdivision/subdivision_patch.h"

#include <algorithm>

namespace trapeze {
namespace {

using OpenSubdiv::Bfr::Parameterization;

constexpr int kMostFloats = 16;  ///< that the library evaluates at once

/// A point of a piece in the parameters of the library's face, with their derivatives by u and v.
struct ChartPoint {
    float st[2];
    V2f st_u, st_v;
};

/// Pieces of quad schemes: Bfr has them as squares of half a unit on integer corners.
class SubFaceChart {
  public:
    SubFaceChart(const Parameterization& parameters, const FacePiece& piece)
        : corner_(corner(parameters, piece.piece)), next_(corner(parameters, piece.next())) {}

    ChartPoint at(V2f uv) const {
        if (uv.x <= 1) return {{corner_.x + 0.5f * uv.x, corner_.y + 0.5f * uv.y}, {0.5f, 0}, {0, 0.5f}};
        // Over the border: the next piece's v runs back along this piece's u.
        return {{next_.x + 0.5f * uv.y, next_.y + 0.5f * (2 - uv.x)}, {0, -0.5f}, {0.5f, 0}};
    }

  private:
    /// Where a piece's own corner lies in the library's parameters.
    static V2f corner(const Parameterization& parameters, int piece) {
        const float origin[2] = {0, 0};
        float st[2];
        parameters.ConvertNormalizedSubFaceToCoord(piece, origin, st);
        return {st[0], st[1]};
    }

    V2f corner_, next_;
};

/// Pieces of triangles: bilinear in the piece's corners.
class TriangleChart {
  public:
    explicit TriangleChart(const FacePiece& piece) {
        const float corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
        float st[8];
        piece_corners(piece, corners[0], 2, st);
        for (int i = 0; i < 4; ++i) corners_[i] = {st[2 * i], st[2 * i + 1]};
    }

    ChartPoint at(V2f uv) const {
        const float u = uv.x, v = uv.y;
        const V2f st = ((1 - u) * corners_[0] + u * corners_[1]) * (1 - v) +
                       ((1 - u) * corners_[3] + u * corners_[2]) * v;
        return {{st.x, st.y},
                (1 - v) * (corners_[1] - corners_[0]) + v * (corners_[2] - corners_[3]),
                (1 - u) * (corners_[3] - corners_[0]) + u * (corners_[2] - corners_[1])};
    }

  private:
    V2f corners_[4];
};

/// The chart of a whole quad: the library's parameters are ours.
struct WholeChart {
    ChartPoint at(V2f uv) const { return {{uv.x, uv.y}, {1, 0}, {0, 1}}; }
};

/// Evaluates a batch with the library, point by point, and turns its derivatives into those by the piece's u
/// and v.
template <class Chart>
void evaluate_in(const Chart& chart, const OpenSubdiv::Bfr::Surface<float>& surface, const float* points,
                 int size, int stride, std::span<const V2f> uv, const ValueSink& value, const ValueSink& du,
                 const ValueSink& dv) {
    const OpenSubdiv::Bfr::Surface<float>::PointDescriptor layout(size, stride);
    float p[kMostFloats], ps[kMostFloats], pt[kMostFloats];
    for (size_t i = 0; i < uv.size(); ++i) {
        const ChartPoint at = chart.at(uv[i]);
        if (du)
            surface.Evaluate(at.st, points, layout, p, ps, pt);
        else
            surface.Evaluate(at.st, points, layout, p);  // the same bits in half the time
        for (int k = 0; k < size; ++k) {
            if (value) value.at(i, k) = p[k];
            if (!du) continue;
            du.at(i, k) = ps[k] * at.st_u.x + pt[k] * at.st_u.y;
            dv.at(i, k) = ps[k] * at.st_v.x + pt[k] * at.st_v.y;
        }
    }
}

/// Sets the points beyond a boundary, by which the B-spline ends there: 2 p1 - p2, rows before columns, so
/// that corners come of both.
void extrapolate(float* controls, int size, const bool (&boundary)[4]) {
    // Four points of a line, a step apart: each is set from the two further inward.
    const auto line = [&](int first, int step, int inward) {
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < size; ++k) {
                float* c = controls + (first + i * step) * size + k;
                c[0] = 2 * c[inward * size] - c[2 * inward * size];
            }
    };
    if (boundary[kBottom]) line(0, 1, 4);
    if (boundary[kTop]) line(12, 1, -4);
    if (boundary[kLeft]) line(0, 4, 1);
    if (boundary[kRight]) line(3, 4, -1);
}

}  // namespace

/// The library's surface is set up in every case, since it alone knows which form the face has.
void LimitPatch::set_vertex(const Factory& factory, int mesh_face, std::span<const int> corners) {
    factory.InitVertexSurface(mesh_face, &surface_);
    classify(corners);
}

void LimitPatch::set_face_varying(const Factory& factory, int mesh_face, int channel,
                                  std::span<const int> corners) {
    factory.InitFaceVaryingSurface(mesh_face, &surface_, channel);
    classify(corners);
}

void LimitPatch::set_linear(std::span<const int> corners) {
    form_ = Form::Linear;
    corners_.assign(corners.begin(), corners.end());
}

void LimitPatch::classify(std::span<const int> corners) {
    if (!surface_.IsValid() || surface_.IsLinear()) return set_linear(corners);
    form_ = Form::Library;
    if (!surface_.IsRegular() || surface_.GetParameterization().GetType() != Parameterization::QUAD) return;
    // A regular quad has 16 control points; irregular ones have to go through the library.
    form_ = Form::Bspline;
    surface_.GetControlPointIndices(controls_.data());
    // Bfr keeps to itself which points lie beyond a boundary. They have no weight at the corners, where those
    // of an inner row or column have 1/36 to 4/9.
    const float low[2] = {0, 0}, high[2] = {1, 1};
    float at_low[16], at_high[16];
    surface_.EvaluateStencil(low, at_low);
    surface_.EvaluateStencil(high, at_high);
    const auto none = [](float a, float b, float c) { return a == 0 && b == 0 && c == 0; };
    boundary_[kBottom] = none(at_low[0], at_low[1], at_low[2]);
    boundary_[kLeft] = none(at_low[0], at_low[4], at_low[8]);
    boundary_[kTop] = none(at_high[13], at_high[14], at_high[15]);
    boundary_[kRight] = none(at_high[7], at_high[11], at_high[15]);
}

/// Points in the order that the form's evaluation wants; for Linear the corners of the mesh face, going
/// round.
void LimitPatch::gather(const float* values, int size, std::vector<float>& points) const {
    const auto copy = [&](std::span<const int> indices) {
        points.resize(indices.size() * size);
        for (size_t i = 0; i < indices.size(); ++i)
            std::copy_n(values + static_cast<size_t>(indices[i]) * size, size, points.data() + i * size);
    };
    switch (form_) {
        case Form::Linear:
            return copy(corners_);
        case Form::Bspline:
            copy(controls_);
            return extrapolate(points.data(), size, boundary_);
        // Bfr's own points of the patch: refined ones, made of the mesh's.
        case Form::Library:
            points.resize(static_cast<size_t>(surface_.GetNumPatchPoints()) * size);
            surface_.PreparePatchPoints(values, size, points.data(), size);
    }
}

void LimitPatch::evaluate(const std::vector<float>& points, int size, const FacePiece& piece,
                          std::span<const V2f> uv, ValueSink value, ValueSink du, ValueSink dv) const {
    if (form_ == Form::Bspline) return evaluate_bspline(points.data(), size, uv, value, du, dv);
    if (form_ == Form::Linear) return evaluate_linear_piece(piece, points.data(), size, uv, value, du, dv);
    // Many floats in parts; a part's points are `size` floats apart all the same.
    for (int first = 0; first < size; first += kMostFloats) {
        const auto part = [&](ValueSink sink) {
            if (sink) sink.data += first * sink.component_stride;
            return sink;
        };
        evaluate_library(points.data() + first, std::min(kMostFloats, size - first), size, piece, uv,
                         part(value), part(du), part(dv));
    }
}

/// Three kinds of parameters, by the shape of the mesh face: each has a chart from the unit square of a
/// piece.
void LimitPatch::evaluate_library(const float* points, int size, int stride, const FacePiece& piece,
                                  std::span<const V2f> uv, ValueSink value, ValueSink du,
                                  ValueSink dv) const {
    const Parameterization parameters = surface_.GetParameterization();
    switch (parameters.GetType()) {
        case Parameterization::QUAD:
            return evaluate_in(WholeChart(), surface_, points, size, stride, uv, value, du, dv);
        case Parameterization::TRI:
            return evaluate_in(TriangleChart(piece), surface_, points, size, stride, uv, value, du, dv);
        case Parameterization::QUAD_SUBFACES:
            return evaluate_in(SubFaceChart(parameters, piece), surface_, points, size, stride, uv, value, du,
                               dv);
    }
}

}  // namespace trapeze
