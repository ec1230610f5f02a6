/// Curves (RISpec 5.6): ribbons that face the camera, or lie across their normals "N". u runs across, v along
/// the whole curve. Where a ribbon faces the camera it does so at every motion key by itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tessellate/surfaces/ribbon_cache.h"
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

/// What shapes the ribbons at one shape key. Without a width the ribbon is 1 wide, without N it faces the
/// camera.
struct RibbonVariables {
    CurveVariable P, width, N;
};

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
    bool stands_alone(int face) const override { return topology_.stands_alone(face); }
    bool has_motion_keys() const override { return true; }
    std::unique_ptr<SurfaceScratch> make_scratch() const override { return std::make_unique<RibbonCache>(); }

    void evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int key) const override;
    bool has_lattices() const override { return rows_come_together(); }
    void lattices(int first, int count, int key, bool beside, FaceLattices& lattices) const override;

  private:
    friend class CurveComponents;

    /// Whether facing_rows() knows this kind of ribbon.
    bool rows_come_together() const { return curves_.cubic && !keys_.front().N; }
    /// A variable along a segment at a motion key, between its shape keys.
    CurvePiece piece(CurveVariable RibbonVariables::*variable, int curve, int segment, int key) const;
    /// A control point's place at a motion key.
    V3f control(int curve, int point, int key) const;
    /// All that shapes one segment at a motion key.
    RibbonSegment segment(int curve, int number, int key) const;
    /// What the ribbon of a line spans at its begin (t = 0) or end (1), which is control point `point`.
    V3f joint_span(const RibbonSegment& segment, int curve, int point, float t, int key) const;
    /// The unit direction across the ribbon: across N where there is one, else across the ray that sees it.
    V3f direction(const RibbonSegment& segment, const V3f& at, const V3f& tangent, float t, int key) const;
    /// The ribbon at t of a segment.
    RibbonRow across(const RibbonSegment& segment, float t, int key) const;
    /// The ribbon at several places of a segment, the same bits.
    void make_rows(const RibbonSegment& segment, int key, std::span<const RibbonCache::WantedRow> wanted,
                   std::span<RibbonRow> rows) const;
    /// The ribbon at the first `count` of cache.v of a face, to cache.rows.
    /// `keep`: they will be asked for again.
    void make_rows(int face, int key, size_t count, bool keep, RibbonCache& cache) const;

    const Primitive& primitive_;
    const Curves& curves_;
    const std::vector<RibbonVariables> keys_;  ///< by shape key
    std::vector<CameraFacing> facing_;         ///< by motion key
    CurveTopology topology_;
    CurvePieces pieces_;
};

/// One frame for each key, as the ribbon turns to the camera at each; faces are runs of segments where these
/// join smoothly.
CurvesSurface::CurvesSurface(const Primitive& primitive, const Camera* camera,
                             std::vector<RibbonVariables> keys)
    : primitive_(primitive),
      curves_(std::get<Curves>(primitive.shape().topology)),
      keys_(std::move(keys)),
      topology_(curves_, joins_smoothly(curves_) ? kSmoothSegmentsPerFace : 1, joins(curves_)),
      pieces_(curves_, topology_) {
    for (const M44f& m : matrices_at_keys(primitive, primitive.key_count())) facing_.emplace_back(m, camera);
}

/// A key of motion lies on a key of the shape or between two of them, which are mixed then.
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

RibbonSegment CurvesSurface::segment(int curve, int number, int key) const {
    RibbonSegment s;
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
V3f CurvesSurface::joint_span(const RibbonSegment& segment, int curve, int point, float t, int key) const {
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

/// The way across the ribbon: with normals it lies across them, without it faces the camera.
V3f CurvesSurface::direction(const RibbonSegment& segment, const V3f& at, const V3f& tangent, float t,
                             int key) const {
    if (keys_.front().N) {
        // Normals along the tangent say nothing: then the ribbon faces the camera there.
        const V3f side = unit_or_zero(unit_or_zero(tangent).cross(unit_or_zero(xyz(segment.N.at(t)))));
        if (side != V3f(0, 0, 0)) return side;
    }
    return facing_[key].across(at, tangent);
}

/// The ribbon's direction is constant along a step of the derivative: how it turns is left out of dPdv.
RibbonRow CurvesSurface::across(const RibbonSegment& segment, float t, int key) const {
    Control p, by_t, width, width_by_t;
    segment.P.at(t, &p, &by_t);
    RibbonRow a;
    a.centre = xyz(p), a.by_t = xyz(by_t);
    if (!curves_.cubic) {
        a.span = segment.start * (1 - t) + segment.end * t;
        a.span_by_t = segment.end - segment.start;
        return a;
    }
    // Where control points coincide the curve has no speed: the direction a little towards the middle.
    V3f tangent = a.by_t;
    const V3f chord = xyz(segment.P.curve.p[3]) - xyz(segment.P.curve.p[0]);
    if (!(tangent.dot(tangent) > kLeastSpeed2 * chord.dot(chord))) {
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

/// What vectors cannot do with care enough (facing_rows() says so) is done row by row; both ways give the
/// same bits where both apply.
void CurvesSurface::make_rows(const RibbonSegment& segment, int key,
                              std::span<const RibbonCache::WantedRow> wanted,
                              std::span<RibbonRow> rows) const {
    for (; !wanted.empty(); wanted = wanted.subspan(std::min(wanted.size(), kRowsAtOnce))) {
        const size_t count = std::min(wanted.size(), kRowsAtOnce);
        std::array<RibbonRow*, kRowsAtOnce> out;
        for (size_t i = 0; i < count; ++i) out[i] = &rows[wanted[i].number];
        uint32_t others = (1u << count) - 1;
        if (rows_come_together()) {
            std::array<float, kRowsAtOnce> t;
            for (size_t i = 0; i < count; ++i) t[i] = wanted[i].t;
            others = facing_rows(segment.P.curve, segment.width, facing_[key], {t.data(), count}, out);
        }
        for (size_t i = 0; i < count; ++i)
            if (others >> i & 1) *out[i] = across(segment, wanted[i].t, key);
    }
}

/// Rows of one segment are gathered before they are made, so that vectors are full. Rows that have been made
/// lately are taken from the cache: neighbours along a curve ask for the same ends.
void CurvesSurface::make_rows(int face, int key, size_t count, bool keep, RibbonCache& cache) const {
    const CurveTopology::Strip strip = topology_.strip(face);
    size_t wants = 0;
    int of = -1;  // the segment that they are of
    const auto make = [&] {
        if (wants == 0) return;
        RibbonCache::Segment& held = cache.segment_at(key, of);
        if (!held.is(face, key, of)) held = {face, key, of, segment(strip.curve, strip.first + of, key)};
        const std::span<const RibbonCache::WantedRow> wanted(cache.wanted.data(), wants);
        make_rows(held.segment, key, wanted, cache.rows);
        for (const RibbonCache::WantedRow& row : keep ? wanted : wanted.first(0))
            cache.row_at(cache.v[row.number]) = {face, key, cache.v[row.number], cache.rows[row.number]};
        wants = 0;
    };
    for (size_t i = 0; i < count; ++i) {
        const float v = cache.v[i];
        const RibbonCache::Row& held = cache.row_at(v);
        if (held.is(face, key, v)) {
            cache.rows[i] = held.row;
            continue;
        }
        const float along = v * static_cast<float>(strip.count);
        const int number = std::clamp(static_cast<int>(along), 0, strip.count - 1);
        if (number != of) make();
        of = number;
        cache.wanted[wants++] = {along - static_cast<float>(number), i};
    }
    make();
}

/// By rows of one v, as grids come: a row costs what a curve costs, its points across are linear.
void CurvesSurface::evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch* scratch,
                             std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    std::unique_ptr<SurfaceScratch> own;
    if (!scratch) own = make_scratch(), scratch = own.get();
    RibbonCache& cache = static_cast<RibbonCache&>(*scratch);
    const float count = static_cast<float>(topology_.strip(face).count);
    for (size_t first = 0, end = 0; first < uv.size(); first = end) {
        // Rows of grids have one v.
        size_t rows = 0;
        for (; end < uv.size(); ++end) {
            if (end > first && uv[end].y == uv[end - 1].y) continue;
            if (rows == RibbonCache::kMostRows) break;
            cache.v[rows++] = uv[end].y;
        }
        make_rows(face, key, rows, dPdu.empty(), cache);
        const RibbonRow* row = cache.rows.data();
        for (size_t i = first; i < end; ++i) {
            if (i > first && uv[i].y != uv[i - 1].y) ++row;
            P[i] = row->centre + row->span * (uv[i].x - 0.5f);
        }
        if (dPdu.empty() && dPdv.empty()) continue;
        row = cache.rows.data();
        for (size_t i = first; i < end; ++i) {
            if (i > first && uv[i].y != uv[i - 1].y) ++row;
            if (!dPdu.empty()) dPdu[i] = row->span;
            if (!dPdv.empty()) dPdv[i] = (row->by_t + row->span_by_t * (uv[i].x - 0.5f)) * count;
        }
    }
}

/// As CurvesSurface::bound() of whole faces of cubic ribbons, in lanes.
void bound_ribbons(std::span<const RibbonLanes> segments, bool cubic_width, FaceLattices& lattices) {
    constexpr int kFaces = FaceLattices::kFaces;
    std::array<float, kFaces> grow{};
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < kFaces; ++i)
            lattices.low[k][i] = std::numeric_limits<float>::max(),
            lattices.high[k][i] = std::numeric_limits<float>::lowest();
    for (const RibbonLanes& segment : segments)
        for (int p = 0; p < 4; ++p)
            for (int i = 0; i < kFaces; ++i) {
                for (int k = 0; k < 3; ++k) {
                    const float at = segment.P[p][k][i];
                    lattices.low[k][i] = at < lattices.low[k][i] ? at : lattices.low[k][i];
                    lattices.high[k][i] = at > lattices.high[k][i] ? at : lattices.high[k][i];
                }
                if (cubic_width || p < 2) grow[i] = std::max(grow[i], std::abs(segment.width[p][i]));
            }
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < kFaces; ++i)
            lattices.low[k][i] -= grow[i] * 0.5f, lattices.high[k][i] += grow[i] * 0.5f;
    lattices.bounded = true;
}

/// Faces with as many segments as the first one. Foreshortening is not looked at.
void CurvesSurface::lattices(int first, int count, int key, bool, FaceLattices& lattices) const {
    std::array<RibbonLanes, kSmoothSegmentsPerFace> segments;
    const int of_first = topology_.strip(first).count;
    uint32_t faces = 0;
    bool cubic_width = false;
    for (int i = 0; i < FaceLattices::kFaces; ++i) {
        // Lanes without such a face are as the first.
        CurveTopology::Strip strip = topology_.strip(i < count ? first + i : first);
        if (strip.count != of_first)
            strip = topology_.strip(first);
        else if (i < count)
            faces |= 1u << i;
        for (int number = 0; number < of_first; ++number) {
            const RibbonSegment s = segment(strip.curve, strip.first + number, key);
            RibbonLanes& lanes = segments[number];
            cubic_width = s.width.cubic;
            for (int p = 0; p < 4; ++p) {
                for (int k = 0; k < 3; ++k) lanes.P[p][k][i] = s.P.curve.p[p][k];
                lanes.width[p][i] = s.width.curve.p[p][0];
            }
        }
    }
    facing_lattices({segments.data(), static_cast<size_t>(of_first)}, cubic_width, facing_[key], faces,
                    lattices);
    bound_ribbons({segments.data(), static_cast<size_t>(of_first)}, cubic_width, lattices);
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

/// u goes across the ribbon, v along the whole curve, over all of its faces.
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
        const RibbonSegment s = segment(strip.curve, strip.first + i, key);
        const float low = std::clamp(from - first, 0.0f, 1.0f), high = std::clamp(to - first, 0.0f, 1.0f);
        const CurvePiece part = low == 0 && high == 1 ? s.P : s.P.restricted(low, high);
        for (const Control& p : part.hull()) box.extendBy(xyz(p));
        for (const Control& w : s.width.hull()) widest = std::max(widest, std::abs(w[0]));
    }
    const float grow = widest * (curves_.cubic ? 0.5f : 0.5f * kMitreLimit);
    box.min -= V3f(grow), box.max += V3f(grow);
    return box;
}

}  // namespace

/// "constantwidth" is one width for all; "width" counts where both are given.
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
