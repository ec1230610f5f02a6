#include "pipeline/study/scenes/moving_cage.h"

#include <array>
#include <map>

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {

void write_moving_cage(RibWriter& rib, const CageAt& cage_at, double shutter, const SceneParameters& p) {
    if (!(p.motion > 0)) return cage_at(p.time).write(rib);
    rib.request("MotionBegin", Numbers{0, .5, 1});
    for (const double moment : {-.5, 0.0, .5}) cage_at(p.time + moment * shutter * p.motion).write(rib);
    rib.request("MotionEnd");
}

void add_tube(Cage& cage, const Tube& tube) {
    const int rings = tube.rings, n = tube.around;
    const auto add = [&](int ring, int i) {
        const double u = static_cast<double>(ring) / (rings + 1), angle = 2 * kPi * i / n;
        return cage.add(tube.place(u, angle), tube.color(u, angle));
    };
    const int first = add(0, 0), before = first + 1;
    for (int ring = 1; ring <= rings; ++ring)
        for (int i = 0; i < n; ++i) add(ring, i);
    const int last = add(rings + 1, 0);
    const auto at = [&](int ring, int i) { return before + ring * n + i % n; };
    for (int i = 0; i < n; ++i) {
        cage.face({first, at(0, i + 1), at(0, i)});
        for (int ring = 0; ring + 1 < rings; ++ring)
            cage.face({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
        cage.face({at(rings - 1, i), at(rings - 1, i + 1), last});
    }
}

void add_ball(Cage& cage, int cells, const std::function<V3d(const V3d&)>& place,
              const std::function<V3d(const V3d&)>& color) {
    std::map<std::array<int, 3>, int> points;  // by their place on the cube; sides share those of its edges
    const auto at = [&](int side, int i, int j) {
        const size_t axis = static_cast<size_t>(side / 2), other = (axis + 1) % 3, third = (axis + 2) % 3;
        const bool low = side % 2 == 0;
        std::array<int, 3> on_cube{};
        on_cube[axis] = low ? 0 : cells, on_cube[other] = low ? j : i, on_cube[third] = low ? i : j;
        const auto found = points.find(on_cube);
        if (found != points.end()) return found->second;
        V3d direction;
        for (size_t k = 0; k < 3; ++k)
            direction[static_cast<int>(k)] = std::tan(kPi / 4 * (2.0 * on_cube[k] / cells - 1));
        direction.normalize();
        return points[on_cube] = cage.add(place(direction), color(direction));
    };
    for (int side = 0; side < 6; ++side)
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j)
                cage.face({at(side, i, j), at(side, i + 1, j), at(side, i + 1, j + 1), at(side, i, j + 1)});
}

}  // namespace trapeze::scenes
