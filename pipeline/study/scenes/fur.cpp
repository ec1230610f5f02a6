#include "pipeline/study/scenes/fur.h"

#include <algorithm>

namespace trapeze::scenes {
namespace {

constexpr int kHairsOfRequest = 1000;

/// Control points of one Bezier segment, bent towards the ground and swirling about the upright axis.
void append_hair(Numbers& points, Chance chance) {
    const V3d n = chance.direction(), up(0, 1, 0);
    const double length = chance.between(.35, .6), step = length / 3;
    V3d direction = (n + .4 * up.cross(n) - .9 * up + .3 * chance.direction()).normalized();
    V3d point = .97 * n;
    for (int i = 0; i < 4; ++i) {
        points.insert(points.end(), {point.x, point.y, point.z});
        point += step * direction;
        direction = (direction + .45 * V3d(0, -1, 0)).normalized();
    }
}

void write_hairs(RibWriter& rib, int first, int count, double width, const V3d& color) {
    Numbers points, widths, colors;
    for (int i = first; i < first + count; ++i) {
        append_hair(points, Chance(11, static_cast<uint32_t>(i)));
        Chance chance(12, static_cast<uint32_t>(i));
        const double root = width * chance.between(.8, 1.2), light = chance.between(.6, 1.1);
        widths.insert(widths.end(), {root, .2 * root});
        colors.insert(colors.end(), {color.x * light, color.y * light, color.z * light});
    }
    rib.request("Curves", "cubic", Integers(static_cast<size_t>(count), 4), "nonperiodic", "P", points,
                "varying float width", widths, "uniform color Cs", colors);
}

}  // namespace

void write_fur(RibWriter& rib, int first, int count, double width, const V3d& color) {
    for (int done = 0; done < count; done += kHairsOfRequest)
        write_hairs(rib, first + done, std::min(kHairsOfRequest, count - done), width, color);
}

}  // namespace trapeze::scenes
