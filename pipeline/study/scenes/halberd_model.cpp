#include "pipeline/study/scenes/halberd_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/study/scenes/cage.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

const V3d kSteel(.30, .325, .37), kDarkSteel(.06, .066, .082), kBrass(.62, .36, .09), kWood(.28, .115, .04),
    kLeather(.08, .035, .02), kRedCloth(.50, .015, .03);

constexpr double kShaftRadius = .125, kSocketLow = 3.95, kSocketHigh = 5.05;
constexpr double kSocketRadius = .19;

/// Down in the picture, as seen by the weapon in its place.
const V3d kDown(.80, -.55, .2);

enum MaterialChances : uint32_t { kWoodChance = 100, kBladeChance, kLeatherChance, kTasselChance };

void polish(RibWriter& rib, double diffuse, double specular, double roughness, const V3d& highlight) {
    rib.request("Surface", "plastic", "Kd", Numbers{diffuse}, "Ks", Numbers{specular}, "roughness",
                Numbers{roughness}, "specularcolor", flattened(std::array{highlight}));
}

/// A pole, its grain in streaks that run along it.
Cage shaft() {
    constexpr int kSides = 10;
    std::vector<Ring> rings;
    for (double y = -3.0; y < kSocketLow + .3; y += .24) rings.push_back({y, kShaftRadius, kWood});
    Cage cage;
    add_lathe(cage, {.sides = kSides}, rings);
    for (size_t i = 0; i < cage.colors.size(); ++i) {
        Chance streak(kWoodChance, static_cast<uint32_t>(i % kSides));
        Chance fleck(kWoodChance + 1000, static_cast<uint32_t>(i / 4));
        cage.colors[i] *= streak.between(.55, 1.35) * fleck.between(.85, 1.15);
    }
    return cage;
}

/// A leather strip wound round the grip, thick in its middle.
Cage wrap() {
    constexpr int kTurns = 9, kStepsOfTurn = 9;
    constexpr double kPitch = .2, kLow = -.85;
    constexpr std::array<double, 4> kAcross = {0, .25, .75, 1}, kLift = {0, .045, .045, 0};
    Cage cage;
    Integers before;
    for (int step = 0; step <= kTurns * kStepsOfTurn; ++step) {
        const double turns = static_cast<double>(step) / kStepsOfTurn, angle = 2 * kPi * turns;
        const V3d color = kLeather * Chance(kLeatherChance, static_cast<uint32_t>(step)).between(.75, 1.4);
        Integers now;
        for (size_t k = 0; k < kAcross.size(); ++k) {
            const double r = kShaftRadius + .004 + kLift[k];
            now.push_back(cage.add(
                {r * std::cos(angle), kLow + kPitch * (turns + 1.02 * kAcross[k]), r * std::sin(angle)},
                color * (kLift[k] > 0 ? 1 : .35)));
        }
        for (size_t k = 1; step > 0 && k < kAcross.size(); ++k)
            cage.face({before[k - 1], now[k - 1], now[k], before[k]});
        before = now;
    }
    return cage;
}

/// Turned rings: about the grip's ends, the socket's ends and under the spear; the ferrule with its spike.
Cage brasses() {
    Cage cage;
    for (const double y : {-.95, 1.08, kSocketLow, kSocketHigh, 3.35}) {
        const double r = y >= kSocketLow ? kSocketRadius : kShaftRadius;
        add_lathe(cage, {.sides = 9},
                  {{y - .10, r + .012, kBrass, 2},
                   {y - .07, r + .035, kBrass, 1.5},
                   {y - .045, r + .02, kBrass * .6, 1},
                   {y - .02, r + .075, kBrass},
                   {y + .02, r + .075, kBrass},
                   {y + .045, r + .02, kBrass * .6, 1},
                   {y + .07, r + .035, kBrass, 1.5},
                   {y + .10, r + .012, kBrass, 2}});
    }
    add_lathe(cage, {.sides = 9},
              {{kHalberdButt, 0, kBrass},
               {-3.22, .035, kBrass},
               {-3.08, .075, kBrass},
               {-3.02, .15, kBrass, 2},
               {-2.93, .17, kBrass, 1},
               {-2.88, .14, kBrass, 2},
               {-2.55, .145, kBrass, 2},
               {-2.52, .165, kBrass, 1.5},
               {-2.46, .165, kBrass, 1.5},
               {-2.44, .127, kBrass * .6, 3}});
    return cage;
}

/// Eight-sided, waisted.
Cage socket() {
    Cage cage;
    add_lathe(cage, {.sides = 8, .ridges = 2.5},
              {{kSocketLow - .05, kSocketRadius, kDarkSteel, 3},
               {kSocketLow + .25, kSocketRadius * .98, kDarkSteel},
               {.5 * (kSocketLow + kSocketHigh), kSocketRadius * .94, kDarkSteel * 1.2},
               {kSocketHigh - .25, kSocketRadius * .98, kDarkSteel},
               {kSocketHigh + .05, kSocketRadius, kDarkSteel, 3}});
    return cage;
}

/// Strips of steel down the shaft that hold the head, with their rivets.
Cage langets() {
    Cage cage;
    for (const double z : {-kShaftRadius, kShaftRadius}) {
        Plate strip{.rows = 12, .columns = 4};
        strip.z = z;
        strip.point = [](int row, int column) {
            const double t = row / 11.0, narrow = row == 0 ? .35 : row == 1 ? .8 : 1;
            return Plate::Point{(column / 3.0 - .5) * .15 * narrow, 2.25 + t * (kSocketLow - 2.25), .028,
                                kDarkSteel * (1.2 + .25 * std::sin(9 * t))};
        };
        add_plate(cage, strip);
        for (const double y : {2.42, 2.75, 3.08, 3.62})
            add_stud(cage, {0, y, z + (z > 0 ? .03 : -.03)}, .045, kBrass);
    }
    for (const double z : {-kSocketRadius, kSocketRadius})
        for (const double y : {4.2, 4.5, 4.8}) add_stud(cage, {0, y, z * .93}, .055, kBrass);
    return cage;
}

/// Grey of steel by its wear: `bright` towards the ground edges.
V3d steel(double bright, int row, int column) {
    Chance chance(kBladeChance, static_cast<uint32_t>(64 * row + column));
    return (kDarkSteel + bright * (kSteel * 1.5 - kDarkSteel)) * chance.between(.75, 1.25);
}

/// The axe: from the socket it widens to a curved edge between two horns; three holes pierce it.
Cage axe() {
    static constexpr std::array<double, 9> kAcross = {0, .12, .26, .40, .54, .68, .80, .84, 1};
    static constexpr std::array<double, 9> kThickness = {.115, .10, .085, .075, .068, .062, .056, .05, 0};
    Plate plate{.rows = 17, .columns = 9};
    plate.point = [](int row, int column) {
        const auto c = static_cast<size_t>(column);
        const double t = row / 8.0 - 1, u = kAcross[c];
        const double edge = 2.0 - .42 * t * t - .10 * t;
        const double height = .47 + .88 * std::pow(u, 2.4) - .05 * std::sin(kPi * u);
        const double bright = column >= 7 ? .9 : .08 + .35 * u * u;
        return Plate::Point{.14 + u * (edge - .14), 4.5 + t * height + .05 * u, kThickness[c],
                            steel(bright, row, column), column == 6 || column == 7 ? 2.5 : 0};
    };
    plate.hole = [](int row, int column) {
        return (column == 3 && (row == 7 || row == 8)) || (column == 2 && (row == 4 || row == 11)) ||
               (column == 4 && (row == 5 || row == 10));
    };
    Cage cage;
    add_plate(cage, plate);
    return cage;
}

/// The hook on the other side: a beak that bends down, of diamond section.
Cage beak() {
    Plate plate{.rows = 12, .columns = 5};
    plate.point = [](int row, int column) {
        const double s = row / 11.0, across = column / 2.0 - 1;
        const double width = .44 * std::pow(1 - .985 * s, .75) - .10 * std::sin(kPi * std::min(1.0, 2 * s));
        const double bend = -.62 * s * s + .1 * s;
        const double lean = .35 * s;  // rows turn with the bend
        const double thickness = column == 0 || column == 4 ? 0 : (column == 2 ? .13 : .085) * (1 - .9 * s);
        return Plate::Point{-.14 - 1.42 * s + lean * across * width, 4.55 + bend + across * width, thickness,
                            steel(thickness > 0 ? .25 : .9, row, column + 20), column == 2 ? 3.0 : 0};
    };
    Cage cage;
    add_plate(cage, plate);
    return cage;
}

/// A leaf-shaped point with a ridge on both sides.
Cage spear() {
    Cage cage;
    const V3d bright = kSteel * 1.35, dark = kDarkSteel * 1.3;
    add_lathe(cage, {.sides = 8},
              {{kSocketHigh, .15, dark, 3},
               {kSocketHigh + .22, .085, dark},
               {kSocketHigh + .30, .13, kBrass, .5},
               {kSocketHigh + .38, .085, dark},
               {kSocketHigh + .46, .09, dark, 2}});
    add_lathe(cage, {.sides = 4, .width = 1, .depth = .42, .ridges = 6},
              {{kSocketHigh + .40, .08, dark, 3},
               {kSocketHigh + .52, .19, bright},
               {kSocketHigh + .66, .235, bright},
               {kSocketHigh + .85, .225, bright * 1.1},
               {kSocketHigh + 1.1, .165, bright},
               {kSocketHigh + 1.4, .075, bright * 1.1},
               {kHalberdTip, 0, bright * 1.2}});
    return cage;
}

/// One strand: a thin square tube from the ring under the socket, falling.
void add_strand(Cage& cage, uint32_t number) {
    Chance chance(kTasselChance, number);
    const double angle = chance.between(0, 2 * kPi), length = chance.between(.75, 1.15);
    const V3d out(std::cos(angle), 0, std::sin(angle));
    const V3d color = kRedCloth * chance.between(.55, 1.5);
    const double wave = chance.between(0, 2 * kPi), swing = chance.between(.02, .05);
    V3d place = V3d(0, 3.33, 0) + (kShaftRadius + chance.between(.0, .03)) * out;
    V3d direction = .9 * out - V3d(0, .35, 0) + .2 * chance.direction();
    std::vector<V3d> line;
    for (int i = 0; i < 6; ++i) {
        line.push_back(place + swing * std::sin(wave + 1.3 * i) * out.cross(kDown));
        direction += .6 * kDown;
        place += length / 5 * direction.normalized();
    }
    constexpr double kThick = .019;
    Integers before;
    for (size_t i = 0; i < line.size(); ++i) {
        const V3d along = (line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0]).normalized();
        const V3d across = along.cross(V3d(.3, .2, 1)).normalized() * kThick, up = across.cross(along);
        Integers now;
        for (const V3d& corner : {across + up, up - across, -across - up, across - up})
            now.push_back(cage.add(line[i] + corner, color * (.55 + .12 * static_cast<double>(i))));
        for (size_t k = 0; i > 0 && k < 4; ++k)
            cage.face({before[k], before[(k + 1) % 4], now[(k + 1) % 4], now[k]});
        if (i == 0) cage.face({now.rbegin(), now.rend()});
        before = now;
    }
    cage.face(before);
}

Cage tassel() {
    Cage cage;
    for (uint32_t i = 0; i < 110; ++i) add_strand(cage, i);
    return cage;
}

}  // namespace

void write_halberd(RibWriter& rib) {
    polish(rib, .8, .25, .96, {1, .9, .8});
    shaft().write(rib);
    polish(rib, .8, .3, 2, {1, .85, .7});
    wrap().write(rib);
    polish(rib, .75, .25, 1.6, {1, .5, .5});
    tassel().write(rib);
    polish(rib, .55, 1.1, .72, {1, .82, .45});
    brasses().write(rib);
    polish(rib, .6, .6, .56, {1, 1, 1});
    for (const Cage& part : {socket(), langets()}) part.write(rib);
    // Wide planes, that a stronger highlight would cover.
    polish(rib, .9, .16, .32, {1, 1, 1});
    for (const Cage& part : {axe(), beak(), spear()}) part.write(rib);
}

}  // namespace trapeze::scenes
