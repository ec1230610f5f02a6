/// NuPatch (RISpec 5.2): tensor-product NURBS, a face for each pair of non-empty knot spans.
#include <algorithm>
#include <cmath>

#include "tessellate/surfaces/between.h"
#include "tessellate/surfaces/nurbs/knot_spans.h"
#include "tessellate/surfaces/nurbs/trimmed_patch.h"
#include "tessellate/surfaces/surface_variables.h"
#include "tessellate/topology/face_grid.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// Patches of higher orders are bounded by samples: their hulls cost more.
constexpr int kLargestHullOrder = 8;

/// Control points of one shape key: P, or Pw with weights.
struct ControlPoints {
    const float* values = nullptr;
    int floats = 3;

    bool rational() const { return floats == 4; }
    const float* at(size_t point) const { return values + point * floats; }
};

/// A weighted sum of control points, x y z w, in double.
struct Sum {
    double c[4] = {0, 0, 0, 0};

    void add(const float* p, int floats, double weight) {
        for (int k = 0; k < floats; ++k) c[k] += weight * static_cast<double>(p[k]);
    }
    void add(const Sum& s, double weight) {
        for (int k = 0; k < 4; ++k) c[k] += weight * s.c[k];
    }
    V3d xyz() const { return {c[0], c[1], c[2]}; }
};

/// A NURBS patch; threads share it. Control points stay in the primitive's arrays.
class NuPatchSurface : public TopologySurface<NuPatchSurface> {
  public:
    NuPatchSurface(const Primitive& primitive, std::vector<ControlPoints> points);

    const FaceGrid& topology() const { return faces_; }
    V2f faces_per_unit(int face) const override {
        return {static_cast<float>(1 / u_.length(faces_.column_of(face))),
                static_cast<float>(1 / v_.length(faces_.row_of(face)))};
    }

    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override;

  private:
    friend class NuPatchValues;

    /// The number of control point (i, j), i along u.
    size_t point(int i, int j) const { return static_cast<size_t>(j) * patch_.nu + i; }
    bool welds(bool along_u) const;
    /// Sets between which spans the surface jumps.
    void find_tears(bool along_u);
    bool is_pole(bool along_u, bool at_end) const;
    int pole_side(int face, V2f uv) const;
    void find_poles();

    const Primitive& primitive_;
    const NuPatch& patch_;
    std::vector<ControlPoints> points_;  ///< by shape key
    KnotSpans u_, v_;
    FaceGrid faces_;
    std::vector<std::array<V3f, 4>> poles_;  ///< by shape key: where the bottom, right, top, left are a point
};

/// All of the topology follows from the knots and from which control points coincide at all shape keys.
NuPatchSurface::NuPatchSurface(const Primitive& primitive, std::vector<ControlPoints> points)
    : primitive_(primitive),
      patch_(std::get<NuPatch>(primitive.shape().topology)),
      points_(std::move(points)),
      u_(patch_.u_knots, patch_.u_order, patch_.u_begin, patch_.u_end),
      v_(patch_.v_knots, patch_.v_order, patch_.v_begin, patch_.v_end) {
    faces_.columns = u_.count(), faces_.rows = v_.count();
    faces_.u_wraps = welds(true), faces_.v_wraps = welds(false);
    find_tears(true);
    find_tears(false);
    find_poles();
}

/// The control points that bear on the patch's border at the begin or the end of a direction, and their
/// weights there: one for knots that are clamped there, else up to order - 1.
struct BorderWeights {
    int first = 0;
    std::vector<double> weights;

    BorderWeights(const KnotSpans& spans, bool at_end) {
        const BasisValues b = spans.basis(at_end ? spans.count() - 1 : 0, at_end ? 1.0f : 0.0f);
        first = b.first;
        for (int i = 0; i < spans.order(); ++i) weights.push_back(b.value[i]);
        const auto none = [](double w) { return std::abs(w) < 1e-9; };
        while (weights.size() > 1 && none(weights.back())) weights.pop_back();
        while (weights.size() > 1 && none(weights.front())) weights.erase(weights.begin()), ++first;
    }
};

/// Whether the first and the last border are one curve: the same points bit for bit, by the same weights.
bool NuPatchSurface::welds(bool along_u) const {
    const BorderWeights a(along_u ? u_ : v_, false), b(along_u ? u_ : v_, true);
    if (a.weights.size() != b.weights.size()) return false;
    for (size_t i = 0; i < a.weights.size(); ++i)
        if (std::abs(a.weights[i] - b.weights[i]) > 1e-6) return false;
    for (const ControlPoints& points : points_)
        for (int line = 0; line < (along_u ? patch_.nv : patch_.nu); ++line)
            for (int i = 0; i < static_cast<int>(a.weights.size()); ++i) {
                const float* p = points.at(along_u ? point(a.first + i, line) : point(line, a.first + i));
                const float* q = points.at(along_u ? point(b.first + i, line) : point(line, b.first + i));
                if (!std::equal(p, p + points.floats, q)) return false;
            }
    return true;
}

/// Where a control point lies, divided by its weight.
V3f place_of(const ControlPoints& points, size_t point) {
    const float* const p = points.at(point);
    return V3f(p[0], p[1], p[2]) / (points.rational() ? p[3] : 1.0f);
}

/// A knot as often as the order says lets the surface jump, from one control point to the next; often those
/// are in one place.
void NuPatchSurface::find_tears(bool along_u) {
    const KnotSpans& spans = along_u ? u_ : v_;
    std::vector<bool> torn(spans.count());
    for (int i = 0; i + 1 < spans.count(); ++i) {
        const int last = spans.first_point(i) + spans.order() - 1, next = spans.first_point(i + 1);
        // Spans that share control points meet.
        if (next <= last) continue;
        for (const ControlPoints& points : points_)
            for (int line = 0; line < (along_u ? patch_.nv : patch_.nu); ++line) {
                const V3f a = place_of(points, along_u ? point(last, line) : point(line, last));
                const V3f b = place_of(points, along_u ? point(next, line) : point(line, next));
                if (!((a - b).length() <= 1e-6f * (a.length() + b.length()))) torn[i] = true;
            }
    }
    (along_u ? faces_.u_lines : faces_.v_lines).tear(torn, along_u ? faces_.u_wraps : faces_.v_wraps);
}

/// Whether a border is but one point, to the last places of the numbers.
bool NuPatchSurface::is_pole(bool along_u, bool at_end) const {
    const BorderWeights border(along_u ? u_ : v_, at_end);
    constexpr float kSame = 1e-6f;
    for (const ControlPoints& points : points_) {
        const auto place = [&](int i, int line) {
            return place_of(points, along_u ? point(border.first + i, line) : point(line, border.first + i));
        };
        float size = 0;
        for (size_t i = 0; i < static_cast<size_t>(patch_.nu) * patch_.nv; ++i)
            size = std::max(size, place_of(points, i).length());
        for (int line = 0; line < (along_u ? patch_.nv : patch_.nu); ++line)
            for (int i = 0; i < static_cast<int>(border.weights.size()); ++i)
                if (!((place(i, line) - place(0, 0)).length() <= kSame * size)) return false;
    }
    return true;
}

/// Sets which borders are points, and where these are. A direction that closes on itself has no borders.
void NuPatchSurface::find_poles() {
    if (!faces_.v_wraps)
        faces_.bottom_is_point = is_pole(false, false), faces_.top_is_point = is_pole(false, true);
    if (!faces_.u_wraps)
        faces_.left_is_point = is_pole(true, false), faces_.right_is_point = is_pole(true, true);
    const int last_u = BorderWeights(u_, true).first, last_v = BorderWeights(v_, true).first;
    const int first_u = BorderWeights(u_, false).first, first_v = BorderWeights(v_, false).first;
    for (const ControlPoints& points : points_)
        poles_.push_back({place_of(points, point(0, first_v)), place_of(points, point(last_u, 0)),
                          place_of(points, point(0, last_v)), place_of(points, point(first_u, 0))});
}

/// The border that a point is on if that is a pole, else -1.
int NuPatchSurface::pole_side(int face, V2f uv) const {
    const int column = faces_.column_of(face), row = faces_.row_of(face);
    if (faces_.bottom_is_point && row == 0 && uv.y == 0) return kBottom;
    if (faces_.top_is_point && row == faces_.rows - 1 && uv.y == 1) return kTop;
    if (faces_.left_is_point && column == 0 && uv.x == 0) return kLeft;
    if (faces_.right_is_point && column == faces_.columns - 1 && uv.x == 1) return kRight;
    return -1;
}

V3f to_float(const V3d& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Sums run in doubles over the points that bear on the span, weights included; the division by w is last.
void NuPatchSurface::evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch*,
                              std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const ControlPoints& points = points_[shape_key];
    const int column = faces_.column_of(face), row = faces_.row_of(face), floats = points.floats;
    const bool derivatives = !dPdu.empty() || !dPdv.empty();
    BasisValues bu, bv;
    for (size_t n = 0; n < uv.size(); ++n) {
        // Rows of grids have one v and columns one u: functions are computed again only where they change.
        if (n == 0 || uv[n].x != uv[n - 1].x) bu = u_.basis(column, uv[n].x);
        if (n == 0 || uv[n].y != uv[n - 1].y) bv = v_.basis(row, uv[n].y);
        Sum value, by_u, by_v;
        for (int j = 0; j < patch_.v_order; ++j) {
            Sum line, line_by_u;
            for (int i = 0; i < patch_.u_order; ++i) {
                const float* const p = points.at(point(bu.first + i, bv.first + j));
                line.add(p, floats, bu.value[i]);
                if (derivatives) line_by_u.add(p, floats, bu.slope[i]);
            }
            value.add(line, bv.value[j]);
            by_u.add(line_by_u, bv.value[j]);
            by_v.add(line, bv.slope[j]);
        }
        const double w = points.rational() ? value.c[3] : 1.0, scale = w != 0 ? 1 / w : 0.0;
        const V3d place = value.xyz() * scale;
        P[n] = to_float(place);
        // By the quotient rule; w's derivatives are 0 apart from rational patches.
        if (!dPdu.empty()) dPdu[n] = to_float((by_u.xyz() - place * by_u.c[3]) * scale);
        if (!dPdv.empty()) dPdv[n] = to_float((by_v.xyz() - place * by_v.c[3]) * scale);
        // All of a pole has the same bits, and no direction along it.
        if (const int side = pole_side(face, uv[n]); side >= 0) {
            P[n] = poles_[shape_key][side];
            const std::span<V3f> along = side == kBottom || side == kTop ? dPdu : dPdv;
            if (!along.empty()) along[n] = V3f(0, 0, 0);
        }
    }
}

/// Values of variables on one face.
class NuPatchValues : public VariableSource {
  public:
    NuPatchValues(const NuPatchSurface& surface, int face, std::span<const V2f> uv)
        : s_(surface), column_(s_.faces_.column_of(face)), row_(s_.faces_.row_of(face)), uv_(uv) {}

    void component(const Parameter& parameter, int component, std::span<float> values) const override {
        const size_t stride = parameter.declaration.floats_per_item();
        const float* const first = parameter.floats.data() + component;
        if (parameter.declaration.storage == StorageClass::Vertex) return at_points(first, stride, values);
        float c[4];
        for (int corner = 0; corner < 4; ++corner)
            c[corner] = first[corner_index(parameter.declaration.storage, corner) * stride];
        for (size_t i = 0; i < values.size(); ++i) {
            // Values are at the corners of knot intervals, of which the span may be a part.
            const float u = s_.u_.share_of_segment(column_, uv_[i].x);
            const float v = s_.v_.share_of_segment(row_, uv_[i].y);
            values[i] = between_corners(c[0], c[1], c[2], c[3], u, v);
        }
    }
    size_t uniform_index(const Parameter& parameter) const override {
        return parameter.declaration.storage == StorageClass::Constant ? 0 : segment();
    }

  private:
    /// Class vertex: a component by the surface's own basis functions, without weights.
    void at_points(const float* first, size_t stride, std::span<float> values) const {
        for (size_t n = 0; n < values.size(); ++n) {
            const BasisValues bu = s_.u_.basis(column_, uv_[n].x), bv = s_.v_.basis(row_, uv_[n].y);
            double sum = 0;
            for (int j = 0; j < s_.patch_.v_order; ++j)
                for (int i = 0; i < s_.patch_.u_order; ++i)
                    sum += bu.value[i] * bv.value[j] *
                           static_cast<double>(first[s_.point(bu.first + i, bv.first + j) * stride]);
            values[n] = static_cast<float>(sum);
        }
    }
    /// The patch's segment that the face lies in, counted as RISpec does, empty knot intervals too.
    size_t segment() const {
        return static_cast<size_t>(s_.v_.segment(row_)) * s_.patch_.segments_u() + s_.u_.segment(column_);
    }
    /// Corners 00, 10, 01, 11.
    size_t corner_index(StorageClass storage, int corner) const {
        if (storage != StorageClass::Varying) return segment() * 4 + corner;
        const int i = s_.u_.segment(column_) + (corner & 1), j = s_.v_.segment(row_) + (corner >> 1);
        return static_cast<size_t>(j) * (s_.patch_.segments_u() + 1) + i;
    }

    const NuPatchSurface& s_;
    int column_, row_;
    std::span<const V2f> uv_;
};

/// Texture coordinates go by the share of the range first, as the corners of TextureCoordinates are its ends.
bool NuPatchSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch*,
                                        ShadingGrid& grid) const {
    for (size_t i = 0; i < uv.size(); ++i) {
        grid.u[i] = u_.share_of_range(faces_.column_of(face), uv[i].x);
        grid.v[i] = v_.share_of_range(faces_.row_of(face), uv[i].y);
    }
    set_texture_coordinates(*primitive_.attributes, grid);
    // Unlike other surfaces' u and v, which run from 0 to 1, these are the knots' (RISpec 5).
    for (size_t i = 0; i < uv.size(); ++i) {
        grid.u[i] = static_cast<float>(u_.parameter(faces_.column_of(face), uv[i].x));
        grid.v[i] = static_cast<float>(v_.parameter(faces_.row_of(face), uv[i].y));
    }
    return set_variables(primitive_.shape().variables, NuPatchValues(*this, face, uv), grid);
}

/// The hull of the rectangle's own Bezier control points; no bound for high orders and weights that are not
/// positive.
Box3f NuPatchSurface::bound(int face, V2f lo, V2f hi, int shape_key) const {
    const int nu = patch_.u_order, nv = patch_.v_order;
    if (std::max(nu, nv) > kLargestHullOrder) return {};
    const ControlPoints& points = points_[shape_key];
    std::array<double, kLargestHullOrder * kLargestHullOrder> wu, wv;
    u_.bezier_weights(faces_.column_of(face), lo.x, hi.x, wu);
    v_.bezier_weights(faces_.row_of(face), lo.y, hi.y, wv);
    const int first_u = u_.first_point(faces_.column_of(face)), first_v = v_.first_point(faces_.row_of(face));
    Box3f box;
    for (int a = 0; a < nu; ++a) {
        std::array<Sum, kLargestHullOrder> column;
        for (int j = 0; j < nv; ++j)
            for (int i = 0; i < nu; ++i)
                column[j].add(points.at(point(first_u + i, first_v + j)), points.floats, wu[a * nu + i]);
        for (int b = 0; b < nv; ++b) {
            Sum control;
            for (int j = 0; j < nv; ++j) control.add(column[j], wv[b * nv + j]);
            const double w = points.rational() ? control.c[3] : 1.0;
            if (!(w > 0)) return {};  // outside its hull
            box.extendBy(to_float(control.xyz() / w));
        }
    }
    return box;
}

}  // namespace

/// Trimmed patches are meshes of pieces, each of them a part of one face of the whole.
std::unique_ptr<Surface> make_nu_patch_surface(const Primitive& primitive, Diagnostics& diagnostics) {
    std::vector<ControlPoints> points;
    for (const auto& shape : primitive.shape_keys) {
        const Parameter* P = shape->variables.find("P");
        const Parameter* Pw = shape->variables.find("Pw");
        if (!P && !Pw) {
            diagnostics.error(primitive.location, "NuPatch: has no control points; skipped",
                              "nupatch-points");
            return nullptr;
        }
        points.push_back(P ? ControlPoints{P->floats.data(), 3} : ControlPoints{Pw->floats.data(), 4});
    }
    auto surface = std::make_unique<NuPatchSurface>(primitive, std::move(points));
    const NuPatch& patch = std::get<NuPatch>(primitive.shape().topology);
    if (patch.trim_loops.empty()) return surface;
    return make_trimmed_patch(patch, std::move(surface));
}

}  // namespace trapeze
