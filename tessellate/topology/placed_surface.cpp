#include "tessellate/topology/placed_surface.h"

#include <algorithm>
#include <cmath>

#include "tessellate/topology/point_lanes.h"

namespace trapeze {
namespace {

/// Element by element: points then move on straight lines, as motion keys have it.
M44f lerp(const M44f& a, const M44f& b, float t) {
    M44f m;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) m[i][j] = a[i][j] + (b[i][j] - a[i][j]) * t;
    return m;
}

/// Whether any pose differs; a primitive may have several that are equal, bit for bit.
bool really_moves(const Primitive& primitive) {
    const std::span<const M44f> m = primitive.camera_from_object;
    return primitive.shape_keys.size() > 1 ||
           std::any_of(m.begin(), m.end(), [&](const M44f& other) { return other != m.front(); });
}

/// A box about a transformed box.
Box3f transformed(const M44f& m, const Box3f& box) {
    const V3f center = transform_point(m, (box.min + box.max) * 0.5f);
    const V3f half = (box.max - box.min) * 0.5f;
    V3f extent;
    for (int j = 0; j < 3; ++j)
        extent[j] = std::abs(m[0][j]) * half.x + std::abs(m[1][j]) * half.y + std::abs(m[2][j]) * half.z;
    return {center - extent, center + extent};
}

}  // namespace

/// Vertices move linearly between the transform's keys: so do the matrix' elements.
std::vector<M44f> matrices_at_keys(const Primitive& primitive, int keys) {
    const std::span<const M44f> given = primitive.camera_from_object;
    const int segments = static_cast<int>(given.size()) - 1;
    std::vector<M44f> matrices(keys, given.front());
    if (segments == 0 || keys == 1) return matrices;
    const int keys_per_segment = (keys - 1) / segments;
    for (int key = 0; key < keys; ++key) {
        const int first = std::min(key / keys_per_segment, segments);
        const int rest = key - first * keys_per_segment;
        matrices[key] = rest == 0 ? given[first]
                                  : lerp(given[first], given[first + 1],
                                         static_cast<float>(rest) / static_cast<float>(keys_per_segment));
    }
    return matrices;
}

/// Four at a time, the oldest goes: a thread mostly works on one surface, or on a few by turns.
SurfaceScratch* EvaluationScratch::of(const Surface& surface) {
    for (Entry& entry : entries_)
        if (entry.surface == &surface) return entry.scratch.get();
    Entry& entry = entries_[next_];
    next_ = (next_ + 1) % entries_.size();
    entry.surface = &surface;
    entry.scratch = surface.make_scratch();
    return entry.scratch.get();
}

std::span<V3f> EvaluationScratch::points(size_t slot, size_t count) {
    std::vector<V3f>& points = points_[slot];
    if (points.size() < count) points.resize(count);
    return {points.data(), count};
}

/// Parentheses fix the order of sums: point_lanes.cpp does the same in vectors.
V3f transform_point(const M44f& m, const V3f& p) {
    return {((p.x * m[0][0] + p.y * m[1][0]) + p.z * m[2][0]) + m[3][0],
            ((p.x * m[0][1] + p.y * m[1][1]) + p.z * m[2][1]) + m[3][1],
            ((p.x * m[0][2] + p.y * m[1][2]) + p.z * m[2][2]) + m[3][2]};
}

V3f transform_vector(const M44f& m, const V3f& v) {
    return {(v.x * m[0][0] + v.y * m[1][0]) + v.z * m[2][0], (v.x * m[0][1] + v.y * m[1][1]) + v.z * m[2][1],
            (v.x * m[0][2] + v.y * m[1][2]) + v.z * m[2][2]};
}

/// Cofactors need no division, and so no care for determinants near 0.
M44f normal_matrix(const M44f& m) {
    const V3f x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    const V3f rows[3] = {y.cross(z), z.cross(x), x.cross(y)};
    const float sign = x.dot(rows[0]) < 0 ? -1.0f : 1.0f;
    M44f n;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) n[i][j] = sign * rows[i][j];
    return n;
}

/// One key where nothing moves, so that still primitives cost nothing more in frames with motion.
PlacedSurface::PlacedSurface(const Surface& surface, const Primitive& primitive, bool moves)
    : surface_(&surface),
      primitive_(&primitive),
      camera_from_object_(
          matrices_at_keys(primitive, moves && really_moves(primitive) ? primitive.key_count() : 1)) {}

ShapeMix PlacedSurface::mix_of(int key) const {
    return surface_->has_motion_keys() ? ShapeMix{key, 0} : shape_mix(*primitive_, key, key_count());
}

/// Keys of the primitive are as many as both its transforms and its shapes need: shape keys lie at even
/// distances among them.
ShapeMix shape_mix(const Primitive& primitive, int key, int key_count) {
    const int segments = static_cast<int>(primitive.shape_keys.size()) - 1;
    if (segments == 0 || key_count == 1) return {};
    const int keys_per_segment = (key_count - 1) / segments;
    const int first = key / keys_per_segment;
    return {first, static_cast<float>(key % keys_per_segment) / static_cast<float>(keys_per_segment)};
}

void PlacedSurface::positions(int face, std::span<const V2f> uv, int keys, EvaluationScratch& scratch,
                              std::span<V3f> P) const {
    positions_and_derivatives(face, uv, keys, scratch, P, {}, {});
}

/// Points are mixed in object space and then transformed, key by key; the surface is evaluated once for each
/// shape key, whatever the number of motion keys.
void PlacedSurface::positions_and_derivatives(int face, std::span<const V2f> uv, int keys,
                                              EvaluationScratch& scratch, std::span<V3f> P,
                                              std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const size_t n = uv.size();
    SurfaceScratch* const surface_scratch = scratch.of(*surface_);
    // Two shape keys at a time: slots 0 and 1 hold keys of even and odd numbers.
    int held[2] = {-1, -1};
    const auto object_points = [&](int shape_key) {
        const std::span<V3f> points = scratch.points(shape_key & 1, n);
        if (held[shape_key & 1] != shape_key) {
            const bool derivatives = shape_key == 0;
            surface_->evaluate(face, uv, shape_key, surface_scratch, points,
                               derivatives ? dPdu : std::span<V3f>{}, derivatives ? dPdv : std::span<V3f>{});
            held[shape_key & 1] = shape_key;
        }
        return points;
    };
    for (int key = 0; key < keys; ++key) {
        const ShapeMix mix = mix_of(key);
        const M44f& m = camera_from_object_[key];
        V3f* const out = P.data() + key * n;
        const std::span<const V3f> a = object_points(mix.first);
        if (mix.to_next == 0) {
            transform_points(m, a.first(n), out);
            continue;
        }
        const std::span<const V3f> b = object_points(mix.first + 1);
        for (size_t i = 0; i < n; ++i) out[i] = a[i] + (b[i] - a[i]) * mix.to_next;
        transform_points(m, {out, n}, out);
    }
    // Derivatives are wanted at the first key alone.
    transform_vectors(camera_from_object_[0], dPdu);
    transform_vectors(camera_from_object_[0], dPdv);
}

/// Points go straight from one shape key to the next, and so stay in the box about both.
Box3f PlacedSurface::bound(int face, V2f lo, V2f hi, int key) const {
    const ShapeMix mix = mix_of(key);
    Box3f box = surface_->bound(face, lo, hi, mix.first);
    if (box.isEmpty()) return {};
    if (mix.to_next != 0) {
        const Box3f next = surface_->bound(face, lo, hi, mix.first + 1);
        if (next.isEmpty()) return {};
        box.extendBy(next);
    }
    return bound(box, key);
}

Box3f PlacedSurface::bound(const Box3f& object_box, int key) const {
    return transformed(camera_from_object_[key], object_box);
}

bool PlacedSurface::is_rigid() const {
    return key_count() == 1 || (!surface_->has_motion_keys() && primitive_->shape_keys.size() == 1);
}

}  // namespace trapeze
