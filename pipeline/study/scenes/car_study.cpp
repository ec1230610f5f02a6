/// Cars on a street at dusk. The camera drives along with a red car, so that this one is at rest and all else
/// moves: a still camera, and a world that streams away from it along z.
#include "pipeline/study/scenes/car_model.h"
#include "pipeline/study/scenes/car_street.h"

namespace trapeze::scenes {
namespace {

constexpr double kDriven = 1.2;  ///< metres while the shutter is open: a hundred km/h and a 24th of a second
constexpr double kHeroZ = 7.9;

const Car kCars[] = {
    // place, heading, paint, moved, driven, head lamps, tail lamps
    {{3.55, 0, kHeroZ}, 176, {.50, .012, .018}, {0, 0, 0}, kDriven, 26, 2},
    {{-.2, 0, 24.5}, 180, {.10, .22, .42}, {0, 0, -.14}, kDriven + .14, 60, 2},
    {{3.7, 0, 46}, 180, {.55, .56, .58}, {0, 0, .10}, kDriven - .10, 70, 2},
    {{12.2, 0, 21.5}, 0, {.70, .42, .05}, {0, 0, 2.3}, 1.1, 20, 26},
    {{8.6, 0, 31}, 0, {.60, .62, .64}, {0, 0, 2.2}, 1.0, 20, 26},
    {{8.5, 0, 52}, 0, {.05, .20, .16}, {0, 0, 2.3}, 1.1, 20, 30},
};

/// Traffic too far away for more than lamps: pairs of these.
void write_distant_traffic(RibWriter& rib, const SceneParameters& p) {
    for (const bool away : {false, true}) {
        const auto traffic = rib.block("Attribute");
        write_moving(rib, "Translate", {0, 0, 0}, {0, 0, away ? 2.3 : 0}, p);
        for (uint32_t i = 0; i < 14; ++i) {
            Chance chance(away ? 31 : 32, i);
            const double z = 64 + 15 * i + chance.between(-4, 4);
            const double x = away ? (i % 2 ? 8.5 : 12.2) : (i % 2 ? -.2 : 3.6);
            const double bright = chance.between(40, 110);
            for (const double side : {-.65, .65}) {
                const auto lamp = rib.block("Attribute");
                rib.request("Color", away ? Numbers{bright, .07 * bright, .03 * bright}
                                          : Numbers{bright, .9 * bright, .75 * bright});
                rib.request("Translate", x + side, .7, z);
                rib.request("Sphere", .11, -.11, .11, 360);
            }
        }
    }
}

/// A spotlight of the street: where it is, what it points at, and its cone's angle in radians.
struct Spot {
    V3d from, to, color;
    double intensity, angle;
};

const Spot kSpots[] = {
    {{-3.6, 3.6, 2.2}, {3.3, .6, kHeroZ}, {.80, .90, 1}, 34, .42},  // what the camera's car throws
    {{3.7, 7.2, 12.5}, {3.5, .6, kHeroZ}, {1, .62, .28}, 70, .6},   // a street lamp behind the red car
    {{7.6, 6.5, 4.2}, {3.5, .5, kHeroZ}, {1, .70, .38}, 40, .55},
    {{-6, 5, 13}, {3.5, .6, kHeroZ}, {.75, .80, 1}, 60, .35},  // along its side
    {{1.2, 7.2, 30}, {1.2, 0, 27}, {1, .62, .28}, 120, .9},
    {{9.8, 7.2, 22}, {10, 0, 22}, {1, .62, .28}, 150, 1.1},
    {{3.2, .62, kHeroZ - 2.2}, {2.6, 0, -.5}, {1, .92, .80}, 5, .5},  // its head lamps on the road
    {{-.2, .62, 22}, {.2, 0, 12}, {1, .92, .80}, 16, .45},
};

void write_street_lights(RibWriter& rib) {
    int handle = 0;
    const auto numbers = [](const V3d& v) { return Numbers{v.x, v.y, v.z}; };
    rib.request("LightSource", "ambientlight", ++handle, "intensity", Numbers{.14}, "lightcolor",
                Numbers{.62, .72, 1});
    rib.request("LightSource", "distantlight", ++handle, "intensity", Numbers{.22}, "lightcolor",
                Numbers{.45, .60, 1}, "from", Numbers{-.4, 1, -.35}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", ++handle, "intensity", Numbers{.42}, "lightcolor",
                Numbers{1, .50, .26}, "from", Numbers{-.1, .16, 1}, "to", Numbers{0, 0, 0});
    for (const Spot& spot : kSpots)
        rib.request("LightSource", "spotlight", ++handle, "intensity", Numbers{spot.intensity}, "lightcolor",
                    numbers(spot.color), "from", numbers(spot.from), "to", numbers(spot.to), "coneangle",
                    Numbers{spot.angle}, "conedeltaangle", Numbers{.6 * spot.angle}, "beamdistribution",
                    Numbers{1});
}

void write_car_study_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("Rotate", -18.5, 0, 1, 0);
    write_street_lights(rib);
    write_horizon(rib);
    {
        const auto streaming = rib.block("Attribute");
        write_moving(rib, "Translate", {0, 0, 0}, {0, 0, kDriven}, p);
        write_street(rib);
    }
    write_car_objects(rib);
    for (const Car& car : kCars) write_car(rib, car, kRoad, p);
    rib.request("Surface", "constant");
    write_distant_traffic(rib, p);
}

Shot car_shot(double scale) {
    Shot shot;
    shot.name = "car-study";
    shot.comments = {
        "Cars on a street at dusk, the camera driving along with the red one: the B-splines of bodies with",
        "creases and holes, turning wheels.",
        "Right: the red car is nearly sharp and its wheels spin; road and barriers are streaks, the more the",
        "nearer; lamps and windows far away are large discs, white and amber ahead, red on the other side."};
    shot.eye = {0, 1.05, 0};
    shot.pitch = .2;
    shot.fov = 27;
    shot.f_stop = 2.8, shot.focal_length = .5, shot.focal_distance = 7.4;
    shot.shading_rate = 3.4 / scale;
    return shot;
}

}  // namespace

std::string car_study_scene(const SceneParameters& p) {
    return scene_of(car_shot(p.scale), write_car_study_world, p);
}

}  // namespace trapeze::scenes
