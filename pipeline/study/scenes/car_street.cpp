#include "pipeline/study/scenes/car_street.h"

#include <algorithm>
#include <array>

#include "pipeline/study/scenes/quad_mesh.h"

namespace trapeze::scenes {
namespace {

/// Where the street begins and ends along z, in metres.
constexpr double kStreetNear = .5, kStreetFar = 320;

const V3d kSodium(1, .46, .13), kWhite(1, .90, .74), kRedSignal(1, .07, .03), kGreenSignal(.08, 1, .55);

V3d mixed(const V3d& a, const V3d& b, double t) {
    return a + t * (b - a);
}

/// Asphalt in patches of many greys: what shows that a road moves.
void add_asphalt(QuadMesh& mesh) {
    uint32_t row = 0;
    for (double z = kStreetNear; z < kStreetFar; ++row) {
        Chance chance(20, row);
        const double next = z + std::max(.3, .04 * z) * chance.between(.7, 1.5);
        for (double x = -7; x < kFarWall;) {
            const double to = std::min(kFarWall, x + chance.between(.4, 2.2) * (1 + .03 * z));
            const double worn = 1 + .22 * std::cos(2 * kPi * (x - .4) / kLaneMark);
            mesh.add_ground({x, 0, z}, {to, 0, next}, kRoad.color * chance.between(.6, 1.45) * worn);
            x = to;
        }
        z = next;
    }
}

void add_marks(QuadMesh& mesh) {
    const V3d white(.80, .78, .72);
    for (const double edge : {kRoadEdge, kBarrier - .55, kBarrier + 1.2, kFarWall - 1.6})
        for (double z = kStreetNear; z < kStreetFar; z += 12)
            mesh.add_ground({edge - .07, .004, z}, {edge + .07, .004, z + 11.8}, white * .8);
    for (const double lane : {kLaneMark, kBarrier + 4.7})
        for (double z = 1; z < kStreetFar; z += 6)
            mesh.add_ground({lane - .075, .004, z}, {lane + .075, .004, z + 2.6}, white);
}

/// Concrete in pieces with gaps, darker at the foot, reflectors on top.
void add_barrier(QuadMesh& concrete, QuadMesh& lamps) {
    constexpr double kPiece = 2.4;
    constexpr std::array<std::array<double, 2>, 5> kOutline = {
        {{-.30, 0}, {-.26, .16}, {-.10, .34}, {-.08, .66}, {.08, .66}}};
    constexpr std::array<double, 5> kShade = {.25, .5, .8, 1, 1};
    for (int i = 0; i < 110; ++i) {
        Chance chance(21, static_cast<uint32_t>(i));
        const double from = kPiece * i, to = from + kPiece - .10;
        const V3d color = V3d(.36, .35, .34) * chance.between(.5, 1.1);
        const auto at = [&](size_t k, double z) { return V3d(kBarrier + kOutline[k][0], kOutline[k][1], z); };
        for (size_t k = 0; k + 1 < kOutline.size(); ++k) {
            const V3d low = color * kShade[k], high = color * kShade[k + 1];
            concrete.add({at(k, from), at(k, to), at(k + 1, to), at(k + 1, from)}, {low, low, high, high});
        }
        lamps.add_lamp({kBarrier, .73, from + 1.2}, .04, .05, i % 3 == 0 ? V3d(14, 3, .7) : V3d(7, 4.2, 1.6));
    }
}

/// Panels of a wall behind the other lanes, some of them lit like shop windows, posts between.
void add_far_wall(QuadMesh& wall, QuadMesh& lamps) {
    constexpr double kPanel = 3.2;
    for (int i = 0; i < 90; ++i) {
        Chance chance(22, static_cast<uint32_t>(i));
        const double from = kPanel * i, to = from + kPanel;
        const V3d a(kFarWall, 0, from), b(kFarWall, 0, to);
        const double bright = chance.between(.5, 1.2), tint = chance.unit();
        const V3d color = mixed({.10, .11, .15}, {.22, .15, .12}, tint) * bright;
        wall.add_wall(a, b, chance.between(2.6, 3.4), color * .3, color);
        wall.add_box({kFarWall - .2, 0, from - .15}, {kFarWall, 3.8, from + .15}, V3d(.05, .05, .06));
        if (chance.unit() < .4) {
            const double y = chance.between(.8, 1.6);
            const double shine = chance.between(.3, 1.6), hue = chance.unit();
            const V3d light = mixed(kSodium, {.35, .65, 1}, hue) * shine;
            lamps.add_wall({kFarWall - .05, y, from + .5}, {kFarWall - .05, y, to - .5}, .9, light * .7,
                           light);
        }
        if (i % 2 == 0)
            lamps.add_lamp({kFarWall - .3, 3.9, from}, .09, .09, kSodium * chance.between(12, 30));
    }
}

/// Posts with an arm and a bright head.
void add_street_lamps(QuadMesh& posts, QuadMesh& lamps) {
    const auto add = [&](double x, double arm, double z, const V3d& color) {
        const V3d grey(.10, .10, .11);
        posts.add_box({x - .08, 0, z - .08}, {x + .08, 7.4, z + .08}, grey);
        posts.add_box({std::min(x, x + arm), 7.32, z - .05}, {std::max(x, x + arm), 7.42, z + .05}, grey);
        lamps.add_lamp({x + arm, 7.24, z - .08}, .20, .09, color * (14 + .32 * z));
    };
    for (int i = 0; i < 12; ++i) {
        const double z = 16 + 21. * i;
        add(kBarrier, -2.2, z, kSodium);
        add(kBarrier, 2.2, z, kSodium);
        add(kFarWall - .6, -1.6, z + 9, kWhite * .8);
        add(-4.2, 1.6, z + 4, kSodium);
    }
}

/// Over the street: a beam with three heads a lane, one light of each lit.
void add_traffic_lights(QuadMesh& posts, QuadMesh& lamps) {
    for (const double z : {58., 112., 190.}) {
        const V3d dark(.03, .03, .035);
        posts.add_box({-3.4, 0, z}, {-3.15, 6.1, z + .2}, dark);
        posts.add_box({-3.4, 5.9, z}, {kBarrier, 6.1, z + .2}, dark);
        for (const double x : {-2.6, 0., 3.4}) {
            posts.add_box({x - .22, 4.7, z - .2}, {x + .22, 5.9, z}, dark);
            const bool go = z > 150 || (x > 0 && z < 100);
            lamps.add_lamp({x, go ? 4.95 : 5.65, z - .25}, .15, .15, (go ? kGreenSignal : kRedSignal) * 70);
        }
    }
}

/// Houses on both sides and at the street's end: dark, in rows of windows of which some are lit.
struct House {
    V3d low, high;
};

void add_house(QuadMesh& walls, QuadMesh& lamps, const House& house, uint32_t number) {
    Chance chance(23, number);
    const V3d color = mixed({.035, .04, .07}, {.09, .06, .06}, chance.unit());
    walls.add_box(house.low, house.high, color);
    const double step = 3.4, lit = chance.between(.15, .45);
    const bool side = house.low.x > 0;  // the wall towards the street
    const double x = side ? house.low.x - .1 : house.high.x + .1;
    for (double y = 4; y < house.high.y - 1; y += step) {
        for (double z = house.low.z + 2; z < house.high.z - 1; z += step) {
            const double bright = chance.between(1.5, 9), tint = chance.unit();
            const V3d light = mixed(kWhite, kSodium, tint) * bright;
            if (chance.unit() < lit) lamps.add_wall({x, y, z}, {x, y, z + .9}, .8, light, light);
        }
        for (double at = house.low.x + 2; at < house.high.x - 1; at += step) {
            const double bright = chance.between(1.5, 9), tint = chance.unit();
            const V3d light = mixed(kWhite, kSodium, tint) * bright;
            if (chance.unit() < lit) lamps.add_lamp({at, y + .4, house.low.z - .1}, .45, .4, light);
        }
    }
}

void add_houses(QuadMesh& walls, QuadMesh& lamps) {
    uint32_t number = 0;
    for (double z = 30; z < 260; ++number) {
        Chance chance(24, number);
        const double length = chance.between(12, 24), front = 19 + chance.between(0, 5);
        add_house(walls, lamps, {{front, 0, z}, {front + 14, chance.between(9, 26), z + length}}, 2 * number);
        const double left = -9 - chance.between(0, 4);
        add_house(walls, lamps, {{left - 12, 0, z}, {left, chance.between(8, 24), z + length}},
                  2 * number + 1);
        z += length + chance.between(1, 9);
    }
}

}  // namespace

void write_street(RibWriter& rib) {
    QuadMesh ground, built, lamps;
    add_asphalt(ground);
    add_marks(ground);
    add_barrier(built, lamps);
    add_far_wall(built, lamps);
    add_street_lamps(built, lamps);
    add_traffic_lights(built, lamps);
    add_houses(built, lamps);
    set_plastic(rib, kRoad);
    ground.write(rib);
    rib.request("Surface", "matte");
    built.write(rib);
    rib.request("Surface", "constant");
    lamps.write(rib);
}

void write_horizon(RibWriter& rib) {
    struct Layer {
        double y;
        V3d color;
    };
    const std::array<Layer, 6> sky = {{{-200, {.95, .42, .18}},
                                       {70, {.90, .40, .20}},
                                       {260, {.50, .25, .26}},
                                       {560, {.19, .14, .26}},
                                       {1100, {.06, .07, .17}},
                                       {2600, {.015, .02, .07}}}};
    rib.request("Surface", "constant");
    QuadMesh mesh;
    for (size_t i = 0; i + 1 < sky.size(); ++i) {
        const V3d a(-2600, sky[i].y, 3000), b(4200, sky[i].y, 3000), up(0, sky[i + 1].y - sky[i].y, 0);
        const V3d left = sky[i].color, top = sky[i + 1].color;
        mesh.add({a, b, b + up, a + up}, {left * .8, left * .45, top * .45, top * .8});
    }
    mesh.write(rib);
    QuadMesh walls, lamps;
    for (uint32_t i = 0; i < 40; ++i) {
        Chance chance(25, i);
        const double x = -140 + 16. * i + chance.between(-6, 6), z = chance.between(330, 520);
        const double height = chance.between(18, 60) + (chance.unit() < .2 ? 45 : 0);
        walls.add_lamp({x, height / 2, z}, chance.between(7, 12), height / 2, V3d(.05, .045, .075));
        for (int k = 0; k < 9; ++k) {
            const double light = chance.between(3, 16), tint = chance.unit();
            const double beside = chance.between(-7, 7), y = chance.between(3, height - 2);
            lamps.add_lamp({x + beside, y, z - 1}, .7, .7, mixed(kWhite, kSodium, tint) * light);
        }
    }
    walls.write(rib);
    lamps.write(rib);
}

}  // namespace trapeze::scenes
