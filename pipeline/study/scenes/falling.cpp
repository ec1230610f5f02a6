/// Paper flakes that fall onto a stage, each turning as it falls, until they lie there: a sequence, of which
/// `time` is a moment. In the kind of the falling triangles of [DynBvh06]: 149,000 things that all move, each
/// by itself. A flake is one micropolygon.
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr int kFlakesOfAll = 149000;  ///< at scale 1
constexpr double kFlakeSide = .034;   ///< at scale 1
constexpr double kStageFloor = -1.3, kHighest = 3.1;
constexpr double kShutter = 1.0 / 48;  ///< seconds that it is open, at motion 1
constexpr int kFlakesOfMesh = 4000;

/// What a flake is like at any time.
struct Flake {
    V3d start, axis;
    double speed, sway, phase, turn;
    V3d color;

    explicit Flake(uint32_t index) {
        static constexpr std::array<std::array<double, 3>, 5> kColors = {
            {{.93, .16, .20}, {.98, .73, .10}, {.10, .55, .80}, {.92, .90, .84}, {.14, .68, .36}}};
        Chance chance(31, index);
        // Denser towards the middle of the stage.
        const double radius = 4.2 * std::sqrt(chance.unit()) * chance.between(.55, 1);
        const double angle = chance.between(0, 2 * kPi);
        start = V3d(radius * std::cos(angle), chance.between(kStageFloor + .05, kHighest),
                    10.6 + .8 * radius * std::sin(angle));
        axis = chance.direction();
        speed = chance.between(.7, 1.5), sway = chance.between(.02, .12);
        phase = chance.between(0, 2 * kPi), turn = chance.between(-9, 9);
        const auto& c = kColors[static_cast<size_t>(chance.between(0, 5)) % kColors.size()];
        color = V3d(c[0], c[1], c[2]) * chance.between(.75, 1);
    }

    std::array<V3d, 4> corners(double time, double side, double rest) const {
        const double landing = std::max(0.0, (start.y - rest) / speed), t = std::min(time, landing);
        const V3d middle(start.x + sway * std::sin(phase + 3 * t), std::max(rest, start.y - speed * t),
                         start.z + sway * std::cos(phase + 2.4 * t));
        V3d u, v;
        if (time >= landing) {
            u = V3d(std::cos(phase), 0, std::sin(phase)), v = V3d(-u.z, 0, u.x);
        } else {
            u = axis.cross(std::abs(axis.y) < .7 ? V3d(0, 1, 0) : V3d(1, 0, 0)).normalized();
            const double angle = phase + turn * t;
            v = std::cos(angle) * axis + std::sin(angle) * u.cross(axis);
        }
        u *= .5 * side, v *= .5 * side;
        return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    }
};

void write_flakes(RibWriter& rib, uint32_t first, uint32_t last, const SceneParameters& p) {
    const double side = kFlakeSide / std::sqrt(p.scale);
    MovingQuads quads;
    for (uint32_t i = first; i < last; ++i) {
        const Flake flake(i);
        // What lies on what: a heap, a little higher with each flake.
        const double rest = kStageFloor + .002 + .03 * (i % 1009) / 1009.0;
        const double half = .5 * kShutter * p.motion;
        quads.add(flake.corners(p.time - half, side, rest), flake.corners(p.time + half, side, rest),
                  flake.color);
    }
    quads.write(rib, p);
}

void write_stage(RibWriter& rib) {
    const auto stage = rib.block("Attribute");
    rib.request("Surface", "matte");
    rib.request("Color", Numbers{.20, .13, .10});
    write_bilinear(
        rib, {{-16, kStageFloor, 2}, {16, kStageFloor, 2}, {-16, kStageFloor, 18}, {16, kStageFloor, 18}});
    rib.request("Color", Numbers{.16, .03, .045});
    // A curtain in folds.
    constexpr int kFolds = 60;
    for (int i = 0; i < kFolds; ++i) {
        const auto place = [](int n) {
            return V3d(-13 + 26.0 * n / kFolds, 0, 15.5 + (n % 2 == 0 ? .35 : -.1));
        };
        const V3d a = place(i), b = place(i + 1), low(0, kStageFloor, 0), high(0, 9, 0);
        write_bilinear(rib, {a + low, b + low, a + high, b + high});
    }
}

void write_falling_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.16}, "lightcolor",
                Numbers{.8, .85, 1});
    rib.request("LightSource", "spotlight", 2, "intensity", Numbers{75}, "lightcolor", Numbers{1, .93, .8},
                "from", Numbers{-4.5, 6.5, 5}, "to", Numbers{.2, -.4, 10.6}, "coneangle", Numbers{.62},
                "conedeltaangle", Numbers{.3}, "beamdistribution", Numbers{1});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.45}, "lightcolor", Numbers{.7, .8, 1},
                "from", Numbers{1, .7, -.8}, "to", Numbers{0, 0, 0});
    write_stage(rib);
    rib.request("Surface", "matte");
    const auto flakes = static_cast<uint32_t>(std::max(1.0, std::round(kFlakesOfAll * p.scale)));
    for (uint32_t first = 0; first < flakes; first += kFlakesOfMesh)
        write_flakes(rib, first, std::min(flakes, first + kFlakesOfMesh), p);
}

}  // namespace

std::string falling_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "falling";
    shot.comments = {
        "Paper flakes fall onto a stage, each turning as it falls, until they lie there.",
        "Right: a column of flakes of five colours before a dark curtain, more of them on the floor",
        "the later it is; near and far ones are soft."};
    shot.fov = 38;
    shot.f_stop = 4, shot.focal_length = .3, shot.focal_distance = 10.2;
    shot.eye = V3d(0, .9, 0);  // all flakes are in view at any time
    shot.shading_rate = 400;   // larger than any flake
    return scene_of(shot, write_falling_world, p);
}

}  // namespace trapeze::scenes
