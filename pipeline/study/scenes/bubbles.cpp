/// Bubbles that rise and wobble, each by itself: surfaces that deform, in the kind of the Bubs of
/// [Gruenschloss11].
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/moving_cage.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr int kBubbles = 170;
constexpr int kCells = 4;
constexpr double kBubblesShadingRate = 3.5;   ///< 940,000 micropolygons at 1280x720
constexpr double kBubblesShutter = 1.0 / 24;  ///< seconds that it is open, at motion 1
constexpr double kBottom = -5.5, kSurface = 5.5;

struct Bubble {
    V3d start, stretch[3];
    double radius, rise, sway, phase, hue;
    double wobble[3], beat[3];

    explicit Bubble(uint32_t index) {
        Chance chance(43, index);
        const double depth = chance.between(5, 17);
        start = V3d(depth * chance.between(-.6, .6), chance.between(kBottom, kSurface), depth);
        radius = .16 + .75 * std::pow(chance.unit(), 2.4);
        rise = chance.between(.6, 1.6) / std::sqrt(radius), sway = chance.between(.05, .2);
        phase = chance.between(0, 2 * kPi), hue = chance.unit();
        for (int k = 0; k < 3; ++k) {
            stretch[k] = chance.direction();
            wobble[k] = chance.between(.04, .12), beat[k] = chance.between(5, 14);
        }
    }

    V3d middle(double time) const {
        const double span = kSurface - kBottom, risen = start.y - kBottom + rise * time;
        return {start.x + sway * std::sin(phase + 3 * time), kBottom + std::fmod(risen, span),
                start.z + sway * std::cos(phase + 2.3 * time)};
    }

    /// Longer along some directions, by turns shorter: waves of one, two and three periods around it.
    V3d skin(const V3d& direction, double time) const {
        double out = 1;
        for (int k = 0; k < 3; ++k) {
            const double along = direction.dot(stretch[k]), at = phase + beat[k] * time;
            out += wobble[k] * std::sin(at) *
                   (k == 0 ? along * along - 1. / 3 : std::cos((k + 1) * kPi * along));
        }
        return radius * out * direction;
    }

    /// As a thin film has them: bands of hues around a direction.
    V3d film(const V3d& direction) const {
        const double at =
            hue + .35 * direction.dot(stretch[0]) + .12 * std::sin(5 * direction.dot(stretch[1]));
        const auto wave = [&](double shift) { return .62 + .36 * std::sin(2 * kPi * (at + shift)); };
        return {wave(0), wave(.33), wave(.62)};
    }
};

void write_bubbles(RibWriter& rib, const SceneParameters& p) {
    for (uint32_t i = 0; i < kBubbles; ++i) {
        const Bubble bubble(i);
        // Where it is when it is seen: the way back to the bottom is no motion.
        const V3d middle = bubble.middle(p.time);
        const auto at = [&](double time) {
            Cage cage;
            const V3d moved(middle.x, middle.y + bubble.rise * (time - p.time), middle.z);
            add_ball(
                cage, kCells, [&](const V3d& d) { return moved + bubble.skin(d, time); },
                [&](const V3d& d) { return bubble.film(d); });
            return cage;
        };
        write_moving_cage(rib, at, kBubblesShutter, p);
    }
}

void write_bubbles_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.35}, "lightcolor",
                Numbers{.75, .88, 1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.8}, "lightcolor", Numbers{1, .97, .9},
                "from", Numbers{-.6, 1, -.7}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.35}, "lightcolor", Numbers{.4, .6, 1},
                "from", Numbers{1, -.3, .2}, "to", Numbers{0, 0, 0});
    {
        const auto water = rib.block("Attribute");
        rib.request("Surface", "constant");
        const V3d deep(.01, .05, .11), light(.16, .42, .52);
        rib.request(
            "Patch", "bilinear", "P",
            flattened(std::array{V3d(-20, -12, 22), V3d(20, -12, 22), V3d(-20, 12, 22), V3d(20, 12, 22)}),
            "varying color Cs", flattened(std::array{deep, deep, light, light}));
    }
    rib.request("Surface", "plastic", "Ka", Numbers{1}, "Kd", Numbers{.55}, "Ks", Numbers{.75}, "roughness",
                Numbers{.06});
    write_bubbles(rib, p);
}

}  // namespace

std::string bubbles_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "bubbles";
    shot.comments = {"Bubbles rise in water and wobble; their surfaces deform.",
                     "Right: small ones are faster; all are round, none has a corner or a seam."};
    shot.fov = 40;
    shot.f_stop = 2.8, shot.focal_length = .35, shot.focal_distance = 9;
    shot.shading_rate = kBubblesShadingRate / p.scale;
    return scene_of(shot, write_bubbles_world, p);
}

}  // namespace trapeze::scenes
