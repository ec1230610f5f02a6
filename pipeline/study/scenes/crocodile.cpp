/// A crocodile that walks and snaps: scaly skin, animated by hand. In the kind of the Croc of
/// [Gruenschloss11].
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/moving_cage.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr double kCrocodileShadingRate = 5;  ///< 620,000 micropolygons at 1280x720
constexpr double kWalkShutter = 1.0 / 24;    ///< seconds that it is open, at motion 1
constexpr double kStep = 7;                  ///< of its walk, radians a second
constexpr double kBodyLength = 6.4;

/// Where along the body (0: snout, 1: tip of the tail) it is so wide and high, halves of both.
struct Girth {
    double at, width, height;
};
constexpr std::array<Girth, 15> kGirths = {{{0, .06, .05},
                                            {.03, .15, .09},
                                            {.08, .17, .10},
                                            {.13, .20, .12},
                                            {.17, .30, .19},
                                            {.21, .30, .20},
                                            {.25, .33, .24},
                                            {.32, .46, .32},
                                            {.40, .52, .36},
                                            {.48, .48, .34},
                                            {.55, .36, .28},
                                            {.62, .26, .24},
                                            {.75, .17, .18},
                                            {.90, .07, .11},
                                            {1, .01, .03}}};

Girth girth(double at) {
    size_t i = 1;
    while (i + 1 < kGirths.size() && kGirths[i].at < at) ++i;
    const Girth &a = kGirths[i - 1], &b = kGirths[i];
    const double part = std::clamp((at - a.at) / (b.at - a.at), 0.0, 1.0),
                 smooth = part * part * (3 - 2 * part);
    return {at, a.width + (b.width - a.width) * smooth, a.height + (b.height - a.height) * smooth};
}

/// How it is bent at a time: along x the snout first, y is up, and the ground at 0.
struct Pose {
    double time;

    double jaw() const { return .16 + .13 * std::sin(1.3 * kStep * time); }
    /// The middle of the body; it winds, more towards the tail.
    V3d spine(double at) const {
        const double wide = .05 + .75 * at * at, wind = wide * std::sin(5.5 * at - kStep * time + .8);
        const double tail = std::clamp((at - .55) / .45, 0.0, 1.0);
        const double head = std::clamp((.25 - at) / .25, 0.0, 1.0);
        return {kBodyLength * (.42 - at), .62 - .50 * tail * (1 - .15 * tail) + .10 * head, wind};
    }
    V3d forwards(double at) const { return (spine(at - .004) - spine(at + .004)).normalized(); }
    V3d aside(double at) const { return V3d(0, 1, 0).cross(forwards(at)).normalized(); }
};

V3d hide(const V3d& color, uint32_t kind, double u, double angle) {
    Chance chance(kind, static_cast<uint32_t>(std::lround(u * 4000)) * 64 +
                            static_cast<uint32_t>(std::lround(angle * 9)));
    return color * chance.between(.72, 1.12);
}

/// Back, flanks with bands, and a light belly; `up` is the sine of the angle around.
V3d body_color(double u, double angle) {
    const double up = std::sin(angle), band = .5 + .5 * std::sin(46 * u);
    const V3d back = V3d(.17, .20, .10) * (.65 + .5 * band), belly(.66, .62, .42);
    const double low = std::clamp(-1.4 * up - .1, 0.0, 1.0);
    return hide(back + (belly - back) * low, 61, u, angle);
}

/// The body with its upper jaw. Every second point of every second ring stands out: scales, and on the back
/// two rows of them that grow towards the tail.
void add_body(Cage& cage, const Pose& pose) {
    Tube body;
    body.rings = 150, body.around = 28;
    body.place = [&](double u, double angle) {
        const Girth g = girth(u);
        const double up = std::sin(angle), side = std::cos(angle);
        const auto ring = std::lround(u * (body.rings + 1)),
                   point = std::lround(angle / (2 * kPi) * body.around);
        const bool scale = ring % 2 == 0 && point % 2 == 0;
        double out = scale ? 1 + .16 * std::clamp(up + .5, 0.0, 1.0) : 1;
        const bool crest = scale && (point == 6 || point == 8);
        if (crest && u > .24) out += .16 + .5 * std::clamp((u - .45) / .4, 0.0, 1.0);
        // The mouth's roof is flat, the eyes' mounds are on top of the head.
        const double flat = u < .17 && up < 0 ? .25 : 1;
        const double mound =
            std::exp(-std::pow((u - .175) / .014, 2)) * std::exp(-std::pow((std::abs(side) - .62) / .25, 2));
        const V3d lift = V3d(0, 1, 0) * ((up > 0 ? .16 * mound : 0) + g.height * up * flat * out);
        return pose.spine(u) + pose.aside(u) * (g.width * side * out) + lift;
    };
    body.color = body_color;
    add_tube(cage, body);
}

/// Below the snout, turned open around the joint of the jaws.
V3d jaw_point(const Pose& pose, double u, double side, double down) {
    const V3d joint = pose.spine(.19);
    const V3d closed = pose.spine(u) + side * pose.aside(u) - V3d(0, down, 0) - joint;
    const double along = closed.dot(pose.forwards(.19)), c = std::cos(pose.jaw()), s = std::sin(pose.jaw());
    return joint + closed + pose.forwards(.19) * (along * (c - 1) + closed.y * s) +
           V3d(0, closed.y * (c - 1) - along * s, 0);
}

void add_lower_jaw(Cage& cage, const Pose& pose) {
    Tube jaw;
    jaw.rings = 40, jaw.around = 12;
    jaw.place = [&](double u, double angle) {
        const double at = .004 + .21 * u;
        const Girth g = girth(at);
        const double side = .93 * g.width * std::cos(angle), up = std::sin(angle);
        return jaw_point(pose, at, side, .045 + (up < 0 ? -.8 * up * g.height : -.02 * up));
    };
    jaw.color = [](double u, double angle) {
        return hide(std::sin(angle) > .3 ? V3d(.62, .30, .24) : V3d(.60, .56, .38), 67, u, angle);
    };
    add_tube(cage, jaw);
}

void add_cone(Cage& cage, const V3d& from, const V3d& to, double radius, const V3d& color) {
    const V3d way = (to - from).normalized();
    const V3d x = way.cross(std::abs(way.y) < .8 ? V3d(0, 1, 0) : V3d(1, 0, 0)).normalized(),
              y = way.cross(x);
    Tube cone;
    cone.rings = 2, cone.around = 5;
    cone.place = [&](double u, double angle) {
        const double r = u == 0 || u == 1 ? 0 : radius * (1.1 - u);
        return from + u * (to - from) + r * (std::cos(angle) * x + std::sin(angle) * y);
    };
    cone.color = [&](double, double) { return color; };
    add_tube(cage, cone);
}

void add_teeth(Cage& cage, const Pose& pose) {
    const V3d ivory(.90, .86, .70);
    for (int i = 0; i < 13; ++i)
        for (const int side : {-1, 1}) {
            const double at = .012 + .0115 * i, long_one = i % 3 == 1 ? 1.5 : 1;
            const double out = side * .88 * girth(at).width;
            const V3d root = pose.spine(at) + out * pose.aside(at);
            add_cone(cage, root, root - V3d(0, .11 * long_one, 0), .028, ivory);
            const double next = at + .006, inner = side * .82 * girth(next).width;
            add_cone(cage, jaw_point(pose, next, inner, .06),
                     jaw_point(pose, next, inner, .06 - .1 * long_one), .026, ivory);
        }
}

void add_eyes(Cage& cage, const Pose& pose) {
    for (const int side : {-1, 1}) {
        const V3d middle = pose.spine(.172) + (.225 * side) * pose.aside(.172) + V3d(0, .24, 0);
        add_ball(
            cage, 3, [&](const V3d& d) { return middle + .062 * d; },
            [&](const V3d& d) {  // a slit that looks aside
                const bool slit = d.dot(pose.aside(.172)) * side > .6;
                return slit ? V3d(.03, .03, .02) : V3d(.85, .66, .10);
            });
    }
}

/// A leg from the body to the ground, by hip, knee and ankle; opposite ones step together.
void add_leg(Cage& cage, const Pose& pose, double at, int side, double phase) {
    const double swing = std::sin(kStep * pose.time + phase),
                 lift = std::max(0.0, std::cos(kStep * pose.time + phase));
    const V3d out = static_cast<double>(side) * pose.aside(at), on = pose.forwards(at);
    const V3d hip = pose.spine(at) + .62 * girth(at).width * out - V3d(0, .05, 0);
    const V3d knee = hip + .42 * out + .16 * swing * on - V3d(0, .10, 0);
    const V3d foot(knee.x + .12 * out.x + .30 * swing * on.x, .06 + .16 * lift,
                   knee.z + .12 * out.z + .30 * swing * on.z);
    const V3d toe = foot + .30 * on + .10 * out - V3d(0, .02, 0);
    const std::array<V3d, 4> joints = {hip, knee, foot, toe};
    static constexpr std::array<double, 4> kThick = {.21, .13, .085, .05};
    Tube leg;
    leg.rings = 24, leg.around = 12;
    leg.place = [&](double u, double angle) {
        const double along = std::min(2.999, 3 * u), part = along - std::floor(along);
        const auto bone = static_cast<size_t>(along);
        const double smooth = part * part * (3 - 2 * part);
        const V3d middle = joints[bone] + (joints[bone + 1] - joints[bone]) * part;
        const V3d way = (joints[bone + 1] - joints[bone]).normalized();
        const V3d x = way.cross(on + V3d(0, .3, 0)).normalized(), y = way.cross(x);
        const auto ring = std::lround(u * 25), point = std::lround(angle / (2 * kPi) * 12);
        const double scale = ring % 2 == 0 && point % 2 == 0 ? 1.14 : 1;
        const double thick =
            u == 0 || u == 1 ? 0 : (kThick[bone] + (kThick[bone + 1] - kThick[bone]) * smooth) * scale;
        return middle + thick * (std::cos(angle) * x + std::sin(angle) * y);
    };
    leg.color = [&](double u, double angle) { return hide(V3d(.20, .22, .11), 71, u, angle); };
    add_tube(cage, leg);
    for (const double aside : {-.5, 0.0, .5}) {
        const V3d way = (on + .5 * out + aside * out).normalized();
        add_cone(cage, foot + .02 * way, foot + .36 * way - V3d(0, .05, 0), .07, V3d(.19, .20, .11));
    }
}

Cage crocodile(double time) {
    const Pose pose{time};
    Cage cage;
    add_body(cage, pose);
    add_lower_jaw(cage, pose);
    add_teeth(cage, pose);
    add_eyes(cage, pose);
    for (const int side : {-1, 1}) {
        add_leg(cage, pose, .30, side, side > 0 ? 0 : kPi);
        add_leg(cage, pose, .55, side, side > 0 ? kPi : 0);
    }
    return cage;
}

void write_crocodile_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.25}, "lightcolor",
                Numbers{.7, .82, 1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{1.0}, "lightcolor",
                Numbers{1, .92, .76}, "from", Numbers{-.6, .9, -.7}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.3}, "lightcolor", Numbers{.5, .7, 1},
                "from", Numbers{1, .3, .6}, "to", Numbers{0, 0, 0});
    {
        const auto bank = rib.block("Attribute");
        rib.request("Surface", "constant");
        const V3d low(.56, .50, .36), high(.42, .58, .66);
        rib.request(
            "Patch", "bilinear", "P",
            flattened(std::array{V3d(-60, -10, 45), V3d(60, -10, 45), V3d(-60, 20, 45), V3d(60, 20, 45)}),
            "varying color Cs", flattened(std::array{low, low, high, high}));
    }
    rib.request("Translate", .1, -.62, 6.1);
    {
        const auto sand = rib.block("Attribute");
        rib.request("Surface", "matte");
        rib.request("Color", Numbers{.60, .50, .34});
        write_bilinear(rib, {{-60, 0, -6}, {60, 0, -6}, {-60, 0, 60}, {60, 0, 60}});
    }
    rib.request("Surface", "plastic", "Kd", Numbers{.85}, "Ks", Numbers{.22}, "roughness", Numbers{.16});
    rib.request("Rotate", 142, 0, 1, 0);
    write_moving_cage(rib, crocodile, kWalkShutter, p);
}

}  // namespace

std::string crocodile_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "crocodile";
    shot.comments = {
        "A crocodile walks on sand and opens its mouth: one scaly skin, with jaws, teeth and legs.",
        "Right: feet that stand are sharp; those that step, jaw and tail are blurred."};
    shot.pitch = 9;
    shot.eye = V3d(0, .9, 0);
    shot.fov = 34;
    shot.f_stop = 5.6, shot.focal_length = .25, shot.focal_distance = 6.4;
    shot.shading_rate = kCrocodileShadingRate / p.scale;
    return scene_of(shot, write_crocodile_world, p);
}

}  // namespace trapeze::scenes
