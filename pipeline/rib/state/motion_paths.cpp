#include "pipeline/rib/state/motion_paths.h"

#include <algorithm>
#include <cmath>

#include "core/motion_keys.h"
#include "core/portable_math.h"

namespace trapeze::rib {
namespace {

/// Pixels that a chord may be off its path.
constexpr float kMostPixels = 0.25f;
/// Nearer than this part of a point's distance from the eye, a depth is taken to be this part: what comes
/// close to the eye would want any number of keys.
constexpr double kLeastDepth = 0.05;

/// Whole quadrics, whatever their angles: about the z axis, from the lowest to the highest z.
void extend(Box3f& box, const Quadric& quadric) {
    const auto& v = quadric.values;
    const auto round = [&](float radius, float low, float high) {
        const float r = std::abs(radius);
        box.extendBy(V3f(-r, -r, std::min(low, high)));
        box.extendBy(V3f(r, r, std::max(low, high)));
    };
    switch (quadric.kind) {
        case Quadric::Kind::Sphere:
        case Quadric::Kind::Cylinder:
        case Quadric::Kind::Paraboloid:
            return round(v[0], v[1], v[2]);
        case Quadric::Kind::Cone:
            return round(v[1], 0, v[0]);
        case Quadric::Kind::Disk:
            return round(v[1], v[0], v[0]);
        case Quadric::Kind::Torus:
            return round(std::abs(v[0]) + std::abs(v[1]), -std::abs(v[1]), std::abs(v[1]));
        case Quadric::Kind::Hyperboloid:
            return round(std::max(portable::hypot(v[0], v[1]), portable::hypot(v[3], v[4])), v[2], v[5]);
    }
}

/// Extents of a blobby's leaves: twice as far as where they are drawn.
void extend(Box3f& box, const Blobby& blobby) {
    const auto& f = blobby.floats;
    // Steps over operations by the number of their operands (RISpec 5.6): 1001 is an ellipsoid, whose
    // sixteen floats are its matrix; 1002 a segment of two ends, a radius and a matrix.
    for (size_t at = 0, next; at < blobby.code.size(); at = next) {
        const int op = blobby.code[at];
        next = at + (op == 1004 ? 6 : op == 1003 ? 3 : op >= 1000 ? 2 : op < 4 ? 2 + blobby.code[at + 1] : 3);
        if (op == 6 || op == 7) next = at + 2;
        if (op != 1001 && op != 1002) continue;
        const size_t first = static_cast<size_t>(blobby.code[at + 1]);
        const float* const m = &f[first + (op == 1002 ? 7 : 0)];
        const float radius = op == 1002 ? f[first + 6] : 1;
        for (int end = 0; end < (op == 1002 ? 2 : 1); ++end) {
            V3f centre(0, 0, 0);
            if (op == 1002) centre = V3f(f[first + 3 * end], f[first + 3 * end + 1], f[first + 3 * end + 2]);
            for (int k = 0; k < 3; ++k) {
                float at_k = m[12 + k], reach = 0;
                for (int row = 0; row < 3; ++row) {
                    at_k += centre[row] * m[4 * row + k];
                    reach += std::abs(radius * m[4 * row + k]);
                }
                box.min[k] = std::min(box.min[k], at_k - reach);
                box.max[k] = std::max(box.max[k], at_k + reach);
            }
        }
    }
}

/// Points "P", and "Pw" over their weights; points without a positive weight have no place.
void extend(Box3f& box, const ParameterList& variables) {
    if (const Parameter* P = variables.find("P"); P && P->declaration.floats_per_item() == 3)
        for (size_t i = 0; i + 3 <= P->floats.size(); i += 3)
            box.extendBy(V3f(P->floats[i], P->floats[i + 1], P->floats[i + 2]));
    if (const Parameter* Pw = variables.find("Pw"); Pw && Pw->declaration.floats_per_item() == 4)
        for (size_t i = 0; i + 4 <= Pw->floats.size(); i += 4)
            if (const float w = Pw->floats[i + 3]; w > 0)
                box.extendBy(V3f(Pw->floats[i], Pw->floats[i + 1], Pw->floats[i + 2]) / w);
}

/// Pixels from one place to another as the camera sees them; 0 where it cannot. To first order, about the
/// nearer of the two: they are close together where the result matters.
float pixels_between(const V3d& a, const V3d& b, const Camera& camera) {
    const double depth =
        camera.perspective ? std::max(std::min(a.z, b.z), kLeastDepth * std::max(a.length(), b.length())) : 1;
    // Points behind the eye are not seen, and do not count.
    if (camera.perspective && !(std::max(a.z, b.z) > 0)) return 0;
    const V2f pixels = camera.pixels_per_length(static_cast<float>(depth));
    // Towards the eye a point moves on the picture as its place times the change of depth.
    const V3d d = a - b;
    double x = d.x, y = d.y;
    if (camera.perspective) x -= d.z * a.x / depth, y -= d.z * a.y / depth;
    return static_cast<float>(portable::hypot(x * pixels.x, y * pixels.y));
}

/// In double: the error that is looked for is far below a float's of large scenes.
V3d transformed(const M44d& m, const V3f& p) {
    V3d out;
    m.multVecMatrix(V3d(p), out);
    return out;
}

}  // namespace

/// The box stands for all points: a rotation bends the paths of those farthest from its centre most, and no
/// point of the box is farther from any centre than one of its corners.
std::vector<V3f> corners_of(const std::vector<std::shared_ptr<const Shape>>& shape_keys) {
    Box3f box;
    for (const auto& key : shape_keys) {
        extend(box, key->variables);
        if (const auto* quadric = std::get_if<Quadric>(&key->topology)) extend(box, *quadric);
        if (const auto* blobby = std::get_if<Blobby>(&key->topology)) extend(box, *blobby);
    }
    std::vector<V3f> corners;
    if (box.isEmpty()) return corners;
    for (int c = 0; c < 8; ++c)
        corners.emplace_back(c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y,
                             c & 4 ? box.max.z : box.min.z);
    return corners;
}

/// A path bends most in the middle of a segment, where the chord is compared with it.
float chord_error(const MovingTransform& transform, float open, float close, int keys,
                  const std::vector<V3f>& points, const Camera& camera) {
    const double segment = (static_cast<double>(close) - open) / (keys - 1);
    float most = 0;
    M44d from = transform.at(open);
    for (int k = 0; k + 1 < keys; ++k) {
        const M44d middle = transform.at(static_cast<float>(open + (k + 0.5) * segment));
        const M44d to = transform.at(static_cast<float>(open + (k + 1) * segment));
        for (const V3f& p : points) {
            const V3d chord = (transformed(from, p) + transformed(to, p)) * 0.5;
            most = std::max(most, pixels_between(transformed(middle, p), chord, camera));
        }
        from = to;
    }
    return most;
}

/// Doubles the segments: keys that were met stay met.
int keys_for_paths(const MovingTransform& transform, float open, float close,
                   const std::vector<std::shared_ptr<const Shape>>& shape_keys, const Camera& camera) {
    int keys = transform.wanted_keys(open, close);
    if (keys == 1 || !transform.may_bend(open, close)) return keys;
    const std::vector<V3f> corners = corners_of(shape_keys);
    while (keys < kMaxKeyCount && chord_error(transform, open, close, keys, corners, camera) > kMostPixels)
        keys = 2 * keys - 1;
    return keys;
}

}  // namespace trapeze::rib
