/// Curves (RISpec 5.6): ribbons that face the camera, or lie across their normals "N". u runs across, v along
/// the whole curve. Where a ribbon faces the camera it does so at every motion key by itself.
#include <algorithm>
#include <cmath>

#include "tessellate/surfaces/camera_facing.h"
#include "tessellate/surfaces/curve_values.h"
#include "tessellate/surfaces/surface_variables.h"
#include "tessellate/topology/placed_surface.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// Segments a face of curves that join smoothly: as many as pieces that an edge is measured by first, so that
/// none is missed.
constexpr int kSmoothSegmentsPerFace = 4;
/// A line's joint grows no wider than so many times its width.
constexpr float kMitreLimit = 2;

/// What shapes the ribbons at one shape key.
struct RibbonVariables {
    CurveVariable P, width, N;
};

V3f xyz(const Control& c) {
    return {c[0], c[1], c[2]};
}

V3f unit_or_zero(const V3f& v) {
    const float length = v.length();
    return length > 0 ? v / length : V3f(0, 0, 0);
}

/// Ribbons, evaluated at motion keys because they face the camera at each by themselves. P = centre + (u -
/// 1/2) * span, where span is as long as the width.
class CurvesSurface : public TopologySurface<CurvesSurface> {
  public:
    CurvesSurface(const Primitive& primitive, const Camera* camera, std::vector<RibbonVariables> keys);

    const CurveTopology& topology() const { return topology_; }
    V2f faces_per_unit(int face) const override {
        const CurveTopology::Strip strip = topology_.strip(face);
        return {1, static_cast<float>(strip.all) / static_cast<float>(strip.count)};
    }
    bool has_motion_keys() const override { return true; }

    void evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int key) const override;

  private:
    friend class CurveComponents;

    /// One segment at one motion key.
    struct Segment {
        CurvePiece P, width, N;
        V3f start{0, 0, 0}, end{0, 0, 0};  ///< of a line: what the ribbon spans at its joints
    };
    /// The centre line's place and what the ribbon spans there, with their derivatives along the segment.
    struct Across {
        V3f centre{0, 0, 0}, by_t{0, 0, 0}, span{0, 0, 0}, span_by_t{0, 0, 0};
    };

    /// A variable along a segment at a motion key, between its shape keys.
    CurvePiece piece(CurveVariable RibbonVariables::*variable, int curve, int segment, int key) const;
    /// A control point's place at a motion key.
    V3f control(int curve, int point, int key) const;
    /// All that shapes one segment at a motion key.
    Segment segment(int curve, int number, int key) const;
    /// What the ribbon of a line spans at its begin (t = 0) or end (1), which is control point `point`.
    V3f joint_span(const Segment& segment, int curve, int point, float t, int key) const;
    /// The unit direction across the ribbon: across N where there is one, else across the ray that sees it.
    V3f direction(const Segment& segment, const V3f& at, const V3f& tangent, float t, int key) const;
    /// The ribbon at t of a segment. The direction's own change along the curve is left out of the
    /// derivative.
    Across across(const Segment& segment, float t, int key) const;

    const Primitive& primitive_;
    const Curves& curves_;
    const std::vector<RibbonVariables> keys_;  ///< by shape key
    std::vector<CameraFacing> facing_;         ///< by motion key
    CurveTopology topology_;
    CurvePieces pieces_;
};

CurvesSurface::CurvesSurface(const Primitive& primitive, const Camera* camera,
                             std::vector<RibbonVariables> keys)
    : primitive_(primitive),
      curves_(std::get<Curves>(primitive.shape().topology)),
      keys_(std::move(keys)),
      topology_(curves_, joins_smoothly(curves_) ? kSmoothSegmentsPerFace : 1, joins(curves_)),
      pieces_(curves_, topology_) {
    for (const M44f& m : matrices_at_keys(primitive, primitive.key_count())) facing_.emplace_back(m, camera);
}

CurvePiece CurvesSurface::piece(CurveVariable RibbonVariables::*variable, int curve, int segment,
                                int key) const {
    const ShapeMix mix = shape_mix(primitive_, key, primitive_.key_count());
    CurvePiece piece = pieces_.piece(keys_[mix.first].*variable, curve, segment);
    if (mix.to_next != 0)
        piece.mix(pieces_.piece(keys_[mix.first + 1].*variable, curve, segment), mix.to_next);
    return piece;
}

V3f CurvesSurface::control(int curve, int point, int key) const {
    const ShapeMix mix = shape_mix(primitive_, key, primitive_.key_count());
    const V3f p = xyz(pieces_.control(keys_[mix.first].P, curve, point));
    if (mix.to_next == 0) return p;
    return p + (xyz(pieces_.control(keys_[mix.first + 1].P, curve, point)) - p) * mix.to_next;
}

CurvesSurface::Segment CurvesSurface::segment(int curve, int number, int key) const {
    Segment s;
    s.P = piece(&RibbonVariables::P, curve, number, key);
    if (keys_.front().width)
        s.width = piece(&RibbonVariables::width, curve, number, key);
    else
        // RISpec's default width.
        s.width.curve.p[0][0] = s.width.curve.p[1][0] = 1;
    if (keys_.front().N) s.N = piece(&RibbonVariables::N, curve, number, key);
    if (!curves_.cubic) {
        s.start = joint_span(s, curve, number, 0, key);
        s.end = joint_span(s, curve, number + 1, 1, key);
    }
    return s;
}

/// What a ribbon of lines spans at a control point: lines meet in a mitre, wider by 1 / cos of half the bend.
/// bend.
V3f CurvesSurface::joint_span(const Segment& segment, int curve, int point, float t, int key) const {
    const int n = topology_.vertices_of(curve);
    const V3f at = control(curve, point, key);
    // Unit directions of the lines that come to the point and leave it; 0 at an end.
    V3f in(0, 0, 0), out(0, 0, 0);
    if (curves_.periodic || point > 0) in = unit_or_zero(at - control(curve, point + n - 1, key));
    if (curves_.periodic || point + 1 < n) out = unit_or_zero(control(curve, point + 1, key) - at);
    V3f tangent = unit_or_zero(in + out);
    if (tangent == V3f(0, 0, 0)) tangent = out;
    // An end has no neighbour on one side: its own line is the tangent, and the cosine 1.
    const float cosine = tangent.dot(out == V3f(0, 0, 0) ? in : out);
    const float mitre = cosine * kMitreLimit > 1 ? 1 / cosine : kMitreLimit;
    return direction(segment, at, tangent, t, key) * (segment.width.at(t)[0] * mitre);
}

V3f CurvesSurface::direction(const Segment& segment, const V3f& at, const V3f& tangent, float t,
                             int key) const {
    if (keys_.front().N) {
        // Normals along the tangent say nothing: then the ribbon faces the camera there.
        const V3f side = unit_or_zero(unit_or_zero(tangent).cross(unit_or_zero(xyz(segment.N.at(t)))));
        if (side != V3f(0, 0, 0)) return side;
    }
    return facing_[key].across(at, tangent);
}

CurvesSurface::Across CurvesSurface::across(const Segment& segment, float t, int key) const {
    Control p, by_t, width, width_by_t;
    segment.P.at(t, &p, &by_t);
    Across a;
    a.centre = xyz(p), a.by_t = xyz(by_t);
    if (!curves_.cubic) {
        a.span = segment.start * (1 - t) + segment.end * t;
        a.span_by_t = segment.end - segment.start;
        return a;
    }
    // Where control points coincide the curve has no speed: the direction a little towards the middle.
    V3f tangent = a.by_t;
    const V3f chord = xyz(segment.P.curve.p[3]) - xyz(segment.P.curve.p[0]);
    if (!(tangent.dot(tangent) > 1e-10f * chord.dot(chord))) {
        Control near, near_by_t;
        segment.P.at(t + (0.5f - t) / 64, &near, &near_by_t);
        tangent = xyz(near_by_t);
    }
    segment.width.at(t, &width, &width_by_t);
    const V3f d = direction(segment, a.centre, tangent, t, key);
    a.span = d * width[0];
    a.span_by_t = d * width_by_t[0];
    return a;
}

void CurvesSurface::evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch*, std::span<V3f> P,
                             std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const CurveTopology::Strip strip = topology_.strip(face);
    const float count = static_cast<float>(strip.count);
    int loaded = -1;
    Segment of;
    Across a;
    for (size_t i = 0; i < uv.size(); ++i) {
        if (i == 0 || uv[i].y != uv[i - 1].y) {  // rows of grids have one v
            const float along = uv[i].y * count;
            const int number = std::clamp(static_cast<int>(along), 0, strip.count - 1);
            if (number != loaded) of = segment(strip.curve, strip.first + number, key);
            loaded = number;
            a = across(of, along - static_cast<float>(number), key);
        }
        const float u = uv[i].x - 0.5f;
        P[i] = a.centre + a.span * u;
        if (!dPdu.empty()) dPdu[i] = a.span;
        if (!dPdv.empty()) dPdv[i] = (a.by_t + a.span_by_t * u) * count;
    }
}

/// Values of variables on one face.
class CurveComponents : public VariableSource {
  public:
    CurveComponents(const CurvesSurface& surface, int face, std::span<const V2f> uv)
        : surface_(surface), strip_(surface.topology_.strip(face)), uv_(uv) {}

    void component(const Parameter& parameter, int component, std::span<float> values) const override {
        const CurveVariable variable = CurveVariable::of(&parameter, component, 1);
        int loaded = -1;
        CurvePiece piece;
        for (size_t i = 0; i < values.size(); ++i) {
            const float along = uv_[i].y * static_cast<float>(strip_.count);
            const int number = std::clamp(static_cast<int>(along), 0, strip_.count - 1);
            if (number != loaded)
                piece = surface_.pieces_.piece(variable, strip_.curve, strip_.first + number);
            loaded = number;
            values[i] = piece.at(along - static_cast<float>(number))[0];
        }
    }
    size_t uniform_index(const Parameter& parameter) const override {
        return parameter.declaration.storage == StorageClass::Constant ? 0 : strip_.curve;
    }

  private:
    const CurvesSurface& surface_;
    const CurveTopology::Strip strip_;
    std::span<const V2f> uv_;
};

bool CurvesSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch*,
                                       ShadingGrid& grid) const {
    const CurveTopology::Strip strip = topology_.strip(face);
    for (size_t i = 0; i < uv.size(); ++i) {
        grid.u[i] = uv[i].x;
        grid.v[i] = (static_cast<float>(strip.first) + uv[i].y * static_cast<float>(strip.count)) /
                    static_cast<float>(strip.all);
    }
    set_texture_coordinates(*primitive_.attributes, grid);
    return set_variables(primitive_.shape().variables, CurveComponents(*this, face, uv), grid);
}

/// The box of the centre line's hull, grown by half the width, and for mitres by as much more as they may be
/// longer.
Box3f CurvesSurface::bound(int face, V2f lo, V2f hi, int key) const {
    const CurveTopology::Strip strip = topology_.strip(face);
    const float from = lo.y * static_cast<float>(strip.count), to = hi.y * static_cast<float>(strip.count);
    Box3f box;
    float widest = 0;
    for (int i = 0; i < strip.count; ++i) {
        // Segment i of the strip is at v * count from i to i + 1.
        const float first = static_cast<float>(i);
        if (to < first || from > first + 1) continue;
        const Segment s = segment(strip.curve, strip.first + i, key);
        const CurvePiece part =
            s.P.restricted(std::clamp(from - first, 0.0f, 1.0f), std::clamp(to - first, 0.0f, 1.0f));
        for (const Control& p : part.hull()) box.extendBy(xyz(p));
        for (const Control& w : s.width.hull()) widest = std::max(widest, std::abs(w[0]));
    }
    const float grow = widest * (curves_.cubic ? 0.5f : 0.5f * kMitreLimit);
    box.min -= V3f(grow), box.max += V3f(grow);
    return box;
}

}  // namespace

std::unique_ptr<Surface> make_curves_surface(const Primitive& primitive, const Camera* camera, Diagnostics&) {
    std::vector<RibbonVariables> keys;
    for (const auto& shape : primitive.shape_keys) {
        const ParameterList& list = shape->variables;
        const Parameter* width = list.find("width");
        keys.push_back({CurveVariable::of(list.find("P"), 0, 3),
                        CurveVariable::of(width ? width : list.find("constantwidth"), 0, 1),
                        CurveVariable::of(list.find("N"), 0, 3)});
    }
    return std::make_unique<CurvesSurface>(primitive, camera, std::move(keys));
}

}  // namespace trapeze
