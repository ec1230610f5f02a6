#include "pipeline/rib/state/motion_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/motion_keys.h"
#include "core/portable_math.h"
#include "pipeline/rib/state/deforming_shape.h"

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

/// Hands on points "P", and "Pw" over their weights; points without a positive weight have no place, and are
/// handed on as nothing.
template <class Visit>
void for_each_point(const ParameterList& variables, const Visit& visit) {
    if (const Parameter* P = variables.find("P"); P && P->declaration.floats_per_item() == 3)
        for (size_t i = 0; i + 3 <= P->floats.size(); i += 3)
            visit(std::optional(V3f(P->floats[i], P->floats[i + 1], P->floats[i + 2])));
    if (const Parameter* Pw = variables.find("Pw"); Pw && Pw->declaration.floats_per_item() == 4)
        for (size_t i = 0; i + 4 <= Pw->floats.size(); i += 4) {
            std::optional<V3f> point;
            if (const float w = Pw->floats[i + 3]; w > 0)
                point = V3f(Pw->floats[i], Pw->floats[i + 1], Pw->floats[i + 2]) / w;
            visit(point);
        }
}

void extend(Box3f& box, const ParameterList& variables) {
    for_each_point(variables, [&](const std::optional<V3f>& point) {
        if (point) box.extendBy(*point);
    });
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

std::vector<V3f> corners_of_box(const Box3f& box) {
    std::vector<V3f> corners;
    if (box.isEmpty()) return corners;
    for (int c = 0; c < 8; ++c)
        corners.emplace_back(c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y,
                             c & 4 ? box.max.z : box.min.z);
    return corners;
}

Box3f box_of(const Shape& shape) {
    Box3f box;
    extend(box, shape.variables);
    if (const auto* quadric = std::get_if<Quadric>(&shape.topology)) extend(box, *quadric);
    if (const auto* blobby = std::get_if<Blobby>(&shape.topology)) extend(box, *blobby);
    return box;
}

/// The same ones at each of a shape's keys: its points, else its box's corners.
std::vector<std::optional<V3f>> points_of(const Shape& shape) {
    std::vector<std::optional<V3f>> points;
    for_each_point(shape.variables, [&](const std::optional<V3f>& point) { points.push_back(point); });
    if (points.empty())
        for (const V3f& corner : corners_of_box(box_of(shape))) points.emplace_back(corner);
    return points;
}

}  // namespace

/// The box stands for all points: a rotation bends the paths of those farthest from its centre most, and no
/// point of the box is farther from any centre than one of its corners.
std::vector<V3f> corners_of(std::span<const std::shared_ptr<const Shape>> shape_keys) {
    Box3f box;
    for (const auto& key : shape_keys) box.extendBy(box_of(*key));
    return corners_of_box(box);
}

/// Of all points "P" and "Pw"; quadrics and blobbies by their boxes.
std::vector<V3f> ways_of(std::span<const std::shared_ptr<const Shape>> shape_keys) {
    Box3f ways;
    for (size_t key = 0; key + 1 < shape_keys.size(); ++key) {
        const auto from = points_of(*shape_keys[key]), to = points_of(*shape_keys[key + 1]);
        for (size_t i = 0; i < std::min(from.size(), to.size()); ++i)
            if (from[i] && to[i]) ways.extendBy(*to[i] - *from[i]);
    }
    if (ways.isEmpty() || (ways.min == V3f(0, 0, 0) && ways.max == ways.min)) return {};
    return corners_of_box(ways);
}

/// A path bends most in the middle of a segment. Where points move themselves, by p and by M as time goes on,
/// the chord at a part t of the segment is off by t (1 - t) of the change of p taken by the change of M,
/// beside what M alone does to points that stand still.
float chord_error(const MovingTransform& transform, float open, float close, int keys,
                  const PointPaths& paths, const std::vector<float>& times, const Camera& camera) {
    const double segment = (static_cast<double>(close) - open) / (keys - 1);
    // Ways go from one of the shape's keys to the next.
    const double part_of_way = std::min(1.0, static_cast<double>(paths.shape_keys - 1) / (keys - 1));
    float most = 0;
    M44d from = transform.at(open);
    auto next_time = times.begin();
    for (int k = 0; k + 1 < keys; ++k) {
        const double begin = open + k * segment, end = begin + segment;
        const M44d to = transform.at(static_cast<float>(end));
        const auto look = [&](double part) {
            const M44d exact = transform.at(static_cast<float>(begin + part * segment));
            for (const V3f& p : paths.points) {
                const V3d at = transformed(exact, p),
                          chord = transformed(from, p) * (1 - part) + transformed(to, p) * part;
                most = std::max(most, pixels_between(at, chord, camera));
                for (const V3f& way : paths.ways) {
                    V3d before, after;
                    from.multDirMatrix(V3d(way), before), to.multDirMatrix(V3d(way), after);
                    const V3d off = (after - before) * (part * (1 - part) * part_of_way);
                    most = std::max(most, pixels_between(at, chord + off, camera));
                }
            }
        };
        look(0.5);
        for (; next_time != times.end() && *next_time < end; ++next_time)
            if (*next_time > begin) look((*next_time - begin) / segment);
        from = to;
    }
    return most;
}

namespace {

/// Points of given poses, the same ones of each: some thousands of them, evenly.
using PosePoints = std::vector<std::vector<std::optional<V3f>>>;

constexpr size_t kMostPosePoints = 4096;

PosePoints points_of_poses(std::span<const std::shared_ptr<const Shape>> shapes) {
    PosePoints poses;
    for (const auto& shape : shapes) {
        const std::vector<std::optional<V3f>> all = points_of(*shape);
        const size_t step = all.size() / kMostPosePoints + 1;
        std::vector<std::optional<V3f>>& some = poses.emplace_back();
        for (size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    }
    return poses;
}

/// Where a point is at a time, mixed linearly from pose to pose (RISpec 6).
std::optional<V3d> point_at(const PosePoints& poses, const std::vector<float>& times, size_t point,
                            float time) {
    const size_t after = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    const size_t next = std::min(after, times.size() - 1), last = after == 0 ? 0 : after - 1;
    const std::optional<V3f>&from = poses[last][point], &to = poses[next][point];
    if (!from || !to) return {};
    const double span = static_cast<double>(times[next]) - times[last];
    const double part = span > 0 ? std::clamp((time - times[last]) / span, 0.0, 1.0) : 0;
    return V3d(*from) * (1 - part) + V3d(*to) * part;
}

/// The farthest, in pixels, that a point of a pose is from its chord between two keys.
float pose_error(const PosePoints& poses, const std::vector<float>& times, const std::vector<float>& between,
                 const MovingTransform& transform, float open, float close, int keys, const Camera& camera) {
    float most = 0;
    for (const float time : between) {
        const M44d matrix = transform.at(time);
        const double place = (static_cast<double>(time) - open) / (close - open) * (keys - 1);
        const int key = std::clamp(static_cast<int>(place), 0, keys - 2);
        const double part = place - key;
        const float from = key_time(open, close, key, keys), to = key_time(open, close, key + 1, keys);
        for (size_t i = 0; i < poses.front().size(); ++i) {
            const auto at = point_at(poses, times, i, time), a = point_at(poses, times, i, from),
                       b = point_at(poses, times, i, to);
            if (!at || !a || !b) continue;
            V3d seen, chord;
            matrix.multVecMatrix(*at, seen), matrix.multVecMatrix(*a * (1 - part) + *b * part, chord);
            most = std::max(most, pixels_between(seen, chord, camera));
        }
    }
    return most;
}

}  // namespace

int keys_for_poses(std::span<const std::shared_ptr<const Shape>> shapes, const std::vector<float>& times,
                   const MovingTransform& transform, float open, float close, const Camera& camera) {
    if (shapes.size() < 2 || !(close > open) || !(close > times.front()) || !(open < times.back())) return 1;
    int keys = keys_meeting(times, open, close);
    PosePoints poses;
    while (keys < kMaxKeyCount) {
        const std::vector<float> between = times_between_keys(times, open, close, keys);
        if (between.empty()) break;
        if (poses.empty()) poses = points_of_poses(shapes);
        if (pose_error(poses, times, between, transform, open, close, keys, camera) <= kMostPixels) break;
        keys = 2 * keys - 1;
    }
    return keys;
}

/// Doubles the segments: keys that were met stay met.
int keys_for_paths(const MovingTransform& transform, float open, float close,
                   std::span<const std::shared_ptr<const Shape>> shape_keys, const Camera& camera) {
    int keys = transform.wanted_keys(open, close);
    if (keys == 1) return keys;
    const bool bends = transform.may_bend(open, close, shape_keys.size() > 1);
    std::vector<float> unmet = transform.unmet_times(open, close, keys);
    if (!bends && unmet.empty()) return keys;
    const PointPaths paths{corners_of(shape_keys), ways_of(shape_keys), static_cast<int>(shape_keys.size())};
    while (keys < kMaxKeyCount &&
           chord_error(transform, open, close, keys, paths, unmet, camera) > kMostPixels) {
        keys = 2 * keys - 1;
        unmet = transform.unmet_times(open, close, keys);
    }
    return keys;
}

}  // namespace trapeze::rib
