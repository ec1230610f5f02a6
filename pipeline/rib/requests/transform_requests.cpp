/// RISpec 4.3.
#include <cmath>

#include "core/portable_math.h"
#include "pipeline/rib/reader/motion_collector.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// A request of so many numbers, which is multiplied to the current transformation or collected by a motion
/// block. Kinds and counts are template arguments since a row of the table holds a plain function pointer.
template <TransformKind kKind, size_t kCount>
void concat(TransformContext& r, ArgumentCursor& c) {
    r.motion.transform(kKind, c.numbers(kCount, "the transformation"));
}

/// Degrees, of the whole angle (RISpec 4.3).
void perspective(TransformContext& r, ArgumentCursor& c) {
    const std::vector<float> fov = c.numbers(1, "the field of view");
    if (!(fov[0] > 0 && fov[0] < 180)) throw RequestError{"the field of view must be between 0 and 180", {}};
    r.motion.transform(TransformKind::Perspective, fov);
}

/// Rotate angle dx dy dz: degrees about an axis through the origin. In a motion block such a pose is mixed
/// with others number by number, the axis included.
void rotate(TransformContext& r, ArgumentCursor& c) {
    std::vector<float> v = c.numbers(4, "the transformation");
    if (v[1] == 0 && v[2] == 0 && v[3] == 0) {
        if (v[0] != 0) throw RequestError{"the axis is 0", {}};
        v[3] = 1;  // exporters take the axis from a matrix, which has none when nothing turns
    }
    r.motion.transform(TransformKind::Rotate, v);
}

/// RISpec 4.3: the angle is below that between the axes, and above it less 180 degrees.
void skew(TransformContext& r, ArgumentCursor& c) {
    const std::vector<float> v = c.numbers(7, "the transformation");
    const V3d from(v[1], v[2], v[3]), to(v[4], v[5], v[6]);
    if (from.length() == 0 || to.length() == 0) throw RequestError{"an axis is 0", {}};
    const double between = portable::atan2(from.cross(to).length(), from.dot(to)) * (180 / M_PI);
    if (!(v[0] < between && v[0] > between - 180))
        throw RequestError{"the angle must be smaller than that between the axes", {}};
    r.motion.transform(TransformKind::Skew, v);
}

/// Row by row, for row vectors: the translation is in the last row.
void set_transform(TransformContext& r, ArgumentCursor& c) {
    const TransformArguments matrix = c.numbers(16, "the matrix");
    r.motion.set_transform(&matrix);
}

/// All of these move in motion blocks, but for the two that deal with named spaces.
constexpr RequestRow kTransformRequests[] = {
    {"Identity", [](TransformContext& r, ArgumentCursor&) { r.motion.set_transform(nullptr); }},
    {"Transform", set_transform},
    {"ConcatTransform", concat<TransformKind::Matrix, 16>},
    {"Translate", concat<TransformKind::Translate, 3>},
    {"Rotate", rotate},
    {"Scale", concat<TransformKind::Scale, 3>},
    {"Skew", skew},
    {"Perspective", perspective},
    {"CoordinateSystem",
     [](TransformContext& r, ArgumentCursor& c) { r.state.name_coordinate_system(c.string("the name")); }},
    {"CoordSysTransform",
     [](TransformContext& r, ArgumentCursor& c) { r.state.use_coordinate_system(c.string("the name")); }},
};

}  // namespace

std::span<const RequestRow> transform_requests() {
    return kTransformRequests;
}

}  // namespace trapeze::rib
