/// Pinwheels that turn while the shutter is open: long, thin blades, each a micropolygon, whose ends move
/// farther than they are wide and in other directions than their roots. What spatial splits find hardest: a
/// part of a blade at mid-shutter is nowhere near the same part of the blade's box at other times
/// [Gruenschloss11 figure 3].
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr int kBladesOfAll = 60000;  ///< at scale 1
constexpr int kBlades = 24;          ///< of a wheel
constexpr int kWheelsOfMesh = 250;
constexpr double kMostTurn = 1.1;  ///< radians while the shutter is open, of the fastest wheel, at motion 1

struct Wheel {
    V3d middle, u, v, axis, color;
    double radius, width, angle, turn;

    explicit Wheel(uint32_t index, double size) {
        static constexpr std::array<std::array<double, 3>, 5> kColors = {
            {{.95, .30, .14}, {.98, .80, .20}, {.20, .62, .86}, {.90, .88, .80}, {.80, .22, .50}}};
        Chance chance(37, index);
        const double depth = chance.between(6, 15);
        middle = V3d(depth * chance.between(-.62, .62), depth * chance.between(-.36, .36), depth);
        axis = (V3d(0, 0, -1) + .7 * chance.direction()).normalized();
        u = axis.cross(V3d(0, 1, 0)).normalized(), v = u.cross(axis);
        radius = size * chance.between(.6, 1), width = radius * chance.between(.02, .05);
        angle = chance.between(0, 2 * kPi),
        turn = kMostTurn * chance.between(.2, 1) * (index % 2 == 0 ? 1 : -1);
        const auto& c = kColors[static_cast<size_t>(chance.between(0, 5)) % kColors.size()];
        color = V3d(c[0], c[1], c[2]) * chance.between(.7, 1);
    }

    /// Of a blade, the wheel being turned by so much: a sliver that is slanted, as folded paper is.
    std::array<V3d, 4> corners(int blade, double turned) const {
        const double at = angle + turned + 2 * kPi * blade / kBlades;
        const V3d along = std::cos(at) * u + std::sin(at) * v;
        const V3d across = width * ((-std::sin(at)) * u + std::cos(at) * v + .6 * axis);
        const V3d root = middle + .08 * radius * along, end = middle + radius * along;
        return {root - .3 * across, end - across, end + across, root + .3 * across};
    }
};

void write_wheels(RibWriter& rib, uint32_t first, uint32_t last, double size, const SceneParameters& p) {
    MovingQuads quads;
    for (uint32_t w = first; w < last; ++w) {
        const Wheel wheel(w, size);
        const double half = .5 * wheel.turn * p.motion;
        for (int blade = 0; blade < kBlades; ++blade)
            quads.add(wheel.corners(blade, -half), wheel.corners(blade, half), wheel.color);
    }
    quads.write(rib, p);
}

void write_pinwheels_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.3}, "lightcolor",
                Numbers{.8, .87, 1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.9}, "lightcolor",
                Numbers{1, .95, .85}, "from", Numbers{-.5, .8, -1}, "to", Numbers{0, 0, 0});
    rib.request("Surface", "constant");
    rib.request("Color", Numbers{.16, .28, .42});
    write_bilinear(rib, {{-20, -12, 18}, {20, -12, 18}, {-20, 12, 18}, {20, 12, 18}});
    rib.request("Surface", "matte");
    const auto wheels = static_cast<uint32_t>(std::max(1.0, std::round(kBladesOfAll * p.scale / kBlades)));
    for (uint32_t first = 0; first < wheels; first += kWheelsOfMesh)
        write_wheels(rib, first, std::min<uint32_t>(wheels, first + kWheelsOfMesh), .42 / std::sqrt(p.scale),
                     p);
}

}  // namespace

std::string pinwheels_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "pinwheels";
    shot.comments = {
        "Pinwheels of paper turn before the sky, some fast, some slowly, both ways round.",
        "Right: hubs are nearly sharp, blades blur towards their ends; near and far ones are soft."};
    shot.fov = 40;
    shot.f_stop = 4, shot.focal_length = .3, shot.focal_distance = 9;
    shot.shading_rate = 40000;  // larger than any blade
    return scene_of(shot, write_pinwheels_world, p);
}

}  // namespace trapeze::scenes
