#include "pipeline/rays/round_shapes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "core/motion_keys.h"
#include "core/portable_math.h"

namespace trapeze {
namespace {

/// A number that all points have, or each its own.
float of_point(const Parameter* parameter, size_t point) {
    if (!parameter || parameter->floats.empty()) return 1;
    return parameter->floats[std::min(point, parameter->floats.size() - 1)];
}

/// Where a point is at a time when shape or pose has a key, camera space; nothing: there is no such point.
/// Between their own keys both are mixed linearly.
std::optional<V3f> place_of_point(const Primitive& points, size_t point, float time) {
    const auto& shapes = points.shape_keys;
    const MotionSegment of_shape = segment_at(time, static_cast<int>(shapes.size()));
    const auto at_key = [&](int key) -> std::optional<V3f> {
        const Parameter* P = shapes[static_cast<size_t>(key)]->variables.find("P");
        if (!P || 3 * point + 2 >= P->floats.size()) return {};
        return V3f(P->floats[3 * point], P->floats[3 * point + 1], P->floats[3 * point + 2]);
    };
    const auto from = at_key(of_shape.index);
    const auto to = shapes.size() > 1 ? at_key(of_shape.index + 1) : from;
    if (!from || !to) return {};
    const V3f place = *from + (*to - *from) * of_shape.local;
    const auto& poses = points.camera_from_object;
    const MotionSegment of_pose = segment_at(time, static_cast<int>(poses.size()));
    const V3f posed = place * poses[static_cast<size_t>(of_pose.index)];
    if (poses.size() == 1) return posed;
    return posed + (place * poses[static_cast<size_t>(of_pose.index) + 1] - posed) * of_pose.local;
}

/// The middle of a ribbon at one of its rows, and half its width there.
struct Section {
    V3f middle{0, 0, 0};
    float radius = 0;
};

/// Of a grid with the ribbon's u from 0 to `part`, at a time. Where pieces of a curve meet the row lies
/// askew.
Section section_of(const ShadingGrid& ribbon, int row, float part, float time) {
    const auto at = [&](int column) { return static_cast<size_t>(ribbon.shape.row_index(column, row)); };
    const size_t left = at(0), right = at(ribbon.shape.nu);
    const auto half = [&](float when) {
        return (place_at(ribbon, right, when) - place_at(ribbon, left, when)) / (2 * part);
    };
    const V3f along = (ribbon.dPdv.at(left) + ribbon.dPdv.at(right)).normalized();
    return {place_at(ribbon, left, time) + half(time), half(0).cross(along).length()};
}

}  // namespace

bool are_balls(const Primitive& primitive) {
    if (!std::holds_alternative<Points>(primitive.shape().topology)) return false;
    const Parameter* type = primitive.shape().variables.find("type");
    return !type || type->strings.empty() || (type->strings[0] != "patch" && type->strings[0] != "sprite");
}

bool are_tubes(const Primitive& primitive) {
    return std::holds_alternative<Curves>(primitive.shape().topology) &&
           !primitive.shape().variables.find("N");
}

void add_balls(const Primitive& points, float time, LightMesh& mesh) {
    const ParameterList& list = points.shape().variables;
    const Parameter* width = list.find("width");
    if (!width) width = list.find("constantwidth");
    const M44f& space = points.camera_from_object.front();
    // As the camera sees them: of the mean scale.
    const double scale = portable::cbrt(std::abs(M44d(space).determinant()));
    const auto count = static_cast<size_t>(std::get<Points>(points.shape().topology).count);
    const int keys = points.key_count();
    const MotionSegment segment = segment_at(time, keys);
    const auto time_of_key = [keys](int key) {
        return keys > 1 ? static_cast<float>(key) / static_cast<float>(keys - 1) : 0.0f;
    };
    for (size_t i = 0; i < count; ++i) {
        const auto from = place_of_point(points, i, time_of_key(segment.index));
        const auto to = keys > 1 ? place_of_point(points, i, time_of_key(segment.index + 1)) : from;
        if (!from || !to) return;
        const double radius = std::abs(static_cast<double>(of_point(width, i))) / 2 * scale;
        mesh.balls.push_back({*from + (*to - *from) * segment.local, static_cast<float>(radius)});
    }
}

void add_tubes(const ShadingGrid& ribbon, float time, LightMesh& mesh) {
    const auto u_at = [&](int column) {
        return ribbon.u[static_cast<size_t>(ribbon.shape.row_index(column, 0))];
    };
    const float part = u_at(ribbon.shape.nu);
    if (u_at(0) != 0 || !(part > 0)) return;
    for (int row = 0; row < ribbon.shape.nv; ++row) {
        const Section near = section_of(ribbon, row, part, time),
                      far = section_of(ribbon, row + 1, part, time);
        mesh.tubes.push_back({near.middle, far.middle, near.radius, far.radius});
    }
}

}  // namespace trapeze
