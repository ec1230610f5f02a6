#include "pipeline/study/scenes/flower_model.h"

#include <array>
#include <cmath>

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

struct FlowerKind {
    int petals;
    double length;
    std::array<double, 4> widths;   ///< from the middle of the flower outwards
    double inner_rise, outer_rise;  ///< degrees above the flower's plane
    double cup;                     ///< how far a petal's sides are raised, in widths
    V3d root, tip, other_tip;       ///< colours; a variant's tip is between two
    double heart;                   ///< radius
    V3d heart_color;
    double height, tilt;  ///< of the stem; degrees towards the eye
    double leaf_width;
};

const std::array<FlowerKind, kFlowerKinds> kKinds = {{
    {6,
     .27,
     {.10, .40, .46, .34},
     48,
     12,
     .16,
     {.16, .01, .015},
     {.86, .05, .02},
     {.95, .20, .04},
     .050,
     {.03, .035, .03},
     .95,
     48,
     .05},
    {17,
     .25,
     {.035, .085, .088, .045},
     14,
     -8,
     -.10,
     {.62, .62, .50},
     {.92, .91, .86},
     {.98, .94, .92},
     .095,
     {.93, .58, .03},
     .92,
     52,
     .06},
    {11,
     .19,
     {.015, .05, .13, .15},
     46,
     20,
     .25,
     {.10, .06, .30},
     {.10, .18, .80},
     {.32, .20, .85},
     .055,
     {.16, .04, .30},
     .84,
     38,
     .03},
    {6,
     .30,
     {.10, .24, .24, .07},
     78,
     74,
     .45,
     {.75, .55, .06},
     {.98, .70, .05},
     {.98, .42, .16},
     .030,
     {.30, .35, .05},
     .88,
     14,
     .09},
    {8,
     .27,
     {.04, .15, .20, .15},
     16,
     2,
     .06,
     {.42, .03, .22},
     {.88, .22, .52},
     {.96, .55, .74},
     .060,
     {.88, .60, .08},
     1.05,
     50,
     .025},
}};

const V3d kStem(.10, .22, .045), kLeaf(.13, .34, .06);

enum FlowerChances : uint32_t { kPlantChance = 200, kTuftChance };

V3d mix(const V3d& a, const V3d& b, double t) {
    return a + t * (b - a);
}

/// A patch along a curve.
struct Strip {
    std::array<V3d, 4> line;
    std::array<double, 4> width;
    V3d across;
    V3d lift{0, 0, 0};   ///< of the sides, per width
    V3d root, tip;       ///< colours
    V3d round{0, 0, 0};  ///< by how much the tip stands out in its middle
};

void write_strip(RibWriter& rib, const Strip& strip) {
    std::array<V3d, 16> points;
    for (size_t v = 0; v < 4; ++v)
        for (size_t u = 0; u < 4; ++u) {
            const double s = 2 * static_cast<double>(u) / 3 - 1, width = strip.width[v];
            points[4 * v + u] = strip.line[v] + .5 * s * width * strip.across + s * s * width * strip.lift;
            if (v == 3 && (u == 1 || u == 2)) points[4 * v + u] += strip.round;
        }
    rib.request("Patch", "bicubic", "P", flattened(points), "varying color Cs",
                flattened(std::array{strip.root, strip.root, strip.tip, strip.tip}));
}

/// The flower's plane is that of x and z here, its middle the origin.
void write_petal(RibWriter& rib, const FlowerKind& kind, double azimuth, const V3d& tip, Chance& chance) {
    const V3d out(std::sin(azimuth), 0, -std::cos(azimuth)), up(0, 1, 0);
    const double length = kind.length * chance.between(.88, 1.08);
    const double bent = chance.between(-9, 9), twist = chance.between(-.22, .22);
    Strip petal;
    petal.line[0] = .55 * kind.heart * out;
    for (size_t i = 1; i < 4; ++i) {
        const double rise =
            (kind.inner_rise + (kind.outer_rise - kind.inner_rise) * static_cast<double>(i - 1) / 2 + bent) *
            kPi / 180;
        petal.line[i] = petal.line[i - 1] + length / 3 * (std::cos(rise) * out + std::sin(rise) * up);
    }
    petal.width = kind.widths;
    petal.across = (out.cross(up) + twist * up).normalized();
    const V3d along = (petal.line[3] - petal.line[0]).normalized();
    petal.lift = kind.cup * petal.across.cross(along) * (petal.across.cross(along).y < 0 ? -1 : 1);
    petal.round = .55 * kind.widths[3] * along;
    petal.root = kind.root * chance.between(.8, 1.1);
    petal.tip = tip * chance.between(.86, 1.04);
    write_strip(rib, petal);
}

void write_ball(RibWriter& rib, const V3d& place, const V3d& radii) {
    const auto block = rib.block("Transform");
    rib.request("Translate", place.x, place.y, place.z);
    rib.request("Scale", radii.x, radii.y, radii.z);
    rib.request("Sphere", 1, -1, 1, 360);
}

/// One unit long along x, on the plane of x and z.
void write_ladybug(RibWriter& rib) {
    const V3d radii(.5, .38, .42);
    rib.request("Surface", "plastic", "Kd", Numbers{.9}, "Ks", Numbers{.7}, "roughness", Numbers{.48});
    rib.request("Color", Numbers{.80, .03, .01});
    write_ball(rib, {0, .1, 0}, radii);
    rib.request("Color", Numbers{.012, .012, .015});
    write_ball(rib, {0, .1, 0}, {.505, .388, .022});
    write_ball(rib, {-.44, .12, 0}, {.17, .20, .25});
    write_ball(rib, {-.58, .10, 0}, {.11, .12, .14});
    // On a ball of radius 1, from the head to the tail and from the middle to the side.
    constexpr std::array<std::array<double, 2>, 4> kSpots = {
        {{-.62, .0}, {-.22, .58}, {.28, .36}, {.55, .66}}};
    for (const auto& [along, aside] : kSpots)
        for (const double side : {-1., 1.}) {
            const double above = std::sqrt(1 - along * along - aside * aside);
            write_ball(rib, {radii.x * along, .1 + radii.y * above, side * radii.z * aside},
                       {.085, .05, .075});
        }
    for (const double side : {-1., 1.})
        for (const double x : {-.25, .02, .28})
            write_strip(rib, {{V3d(x, .08, .3 * side), V3d(x, .16, .45 * side), V3d(1.2 * x, .1, .56 * side),
                               V3d(1.3 * x, -.08, .62 * side)},
                              {.06, .05, .04, .03},
                              {1, 0, 0},
                              {0, 0, 0},
                              V3d(.012),
                              V3d(.012)});
    rib.request("Color", Numbers{.95, .95, .9});
    for (const double side : {-1., 1.}) write_ball(rib, {-.52, .2, .12 * side}, {.06, .05, .05});
}

void write_head(RibWriter& rib, const FlowerKind& kind, const V3d& tip, bool ladybug, Chance& chance) {
    const double first = chance.between(0, 2 * kPi);
    for (int i = 0; i < kind.petals; ++i)
        write_petal(rib, kind, first + 2 * kPi * (i + chance.between(-.12, .12)) / kind.petals, tip, chance);
    rib.request("Color", flattened(std::array{kind.heart_color}));
    write_ball(rib, {0, .012, 0}, {kind.heart, .62 * kind.heart, kind.heart});
    if (!ladybug) return;
    const auto block = rib.block("Attribute");
    rib.request("Translate", .09, .07, -.07);
    rib.request("Rotate", 28, 0, 1, 0);
    rib.request("Scale", .19, .19, .19);
    write_ladybug(rib);
}

void write_leaf(RibWriter& rib, const FlowerKind& kind, const V3d& root, Chance& chance) {
    const double angle = chance.between(0, 2 * kPi), length = chance.between(.22, .42);
    const V3d out(std::cos(angle), 0, std::sin(angle)), up(0, 1, 0);
    const double width = kind.leaf_width * chance.between(.8, 1.3);
    Strip leaf;
    leaf.line = {root, root + length * (.25 * out + .35 * up), root + length * (.7 * out + .5 * up),
                 root + length * (1.05 * out + .25 * up)};
    leaf.width = {.3 * width, 1.2 * width, width, .05 * width};
    leaf.across = out.cross(up);
    leaf.lift = .25 * up;
    leaf.root = kLeaf * .45, leaf.tip = kLeaf * chance.between(.8, 1.3);
    write_strip(rib, leaf);
}

void write_flower(RibWriter& rib, const FlowerKind& kind, uint32_t number, bool ladybug) {
    Chance chance(kPlantChance, number);
    const double bend = chance.between(-.14, .14), height = kind.height * chance.between(.86, 1.1);
    Strip stem;
    stem.line = {V3d(0), V3d(.2 * bend, .36 * height, 0), V3d(bend, .7 * height, .04), V3d(bend, height, 0)};
    stem.width = {.034, .028, .024, .022};
    stem.across = V3d(1, 0, 0);
    stem.lift = V3d(0, 0, .3);
    stem.root = kStem * .3, stem.tip = kStem * 1.5;
    write_strip(rib, stem);
    for (int i = 0; i < 4; ++i) write_leaf(rib, kind, mix(stem.line[0], stem.line[2], .12 + .2 * i), chance);

    const auto head = rib.block("Transform");
    rib.request("Translate", bend, height, 0);
    rib.request("Rotate", chance.between(-16, 16), 0, 0, 1);
    rib.request("Rotate", -kind.tilt + chance.between(-14, 14), 1, 0, 0);
    write_head(rib, kind, mix(kind.tip, kind.other_tip, chance.unit()), ladybug, chance);
}

/// Blades from one place, bent away from it.
void write_tuft(RibWriter& rib, uint32_t number) {
    constexpr int kBlades = 14;
    Chance chance(kTuftChance, number);
    const V3d green = mix(V3d(.10, .30, .035), V3d(.30, .42, .07), chance.unit());
    for (int i = 0; i < kBlades; ++i) {
        const double angle = chance.between(0, 2 * kPi), spread = chance.between(0, .16);
        const double height = chance.between(.34, .82), bend = height * chance.between(.05, .5);
        const V3d out(std::cos(angle), 0, std::sin(angle));
        const V3d root = spread * out, up(0, 1, 0);
        const double width = chance.between(.016, .030);
        Strip blade;
        blade.line = {root, root + .36 * height * up + .1 * bend * out,
                      root + .74 * height * up + .45 * bend * out, root + height * up + bend * out};
        blade.width = {width, width, .8 * width, .1 * width};
        const double turn = chance.between(0, kPi);
        blade.across = V3d(std::cos(turn), 0, std::sin(turn));
        blade.root = green * .12, blade.tip = green * chance.between(.75, 1.35);
        write_strip(rib, blade);
    }
}

}  // namespace

int flower_object(uint32_t kind, uint32_t variant) {
    return static_cast<int>(kind * kFlowerVariants + variant);
}

int tuft_object(uint32_t variant) {
    return flower_object(kFlowerKinds, variant);
}

int ladybug_daisy_object() {
    return tuft_object(kTuftVariants);
}

void write_plant_objects(RibWriter& rib) {
    const auto object = [&](int handle, const auto& write) {
        rib.request("ObjectBegin", handle);
        write();
        rib.request("ObjectEnd");
    };
    for (uint32_t k = 0; k < kFlowerKinds; ++k)
        for (uint32_t v = 0; v < kFlowerVariants; ++v)
            object(flower_object(k, v),
                   [&] { write_flower(rib, kKinds[k], k * kFlowerVariants + v, false); });
    for (uint32_t v = 0; v < kTuftVariants; ++v) object(tuft_object(v), [&] { write_tuft(rib, v); });
    object(ladybug_daisy_object(), [&] { write_flower(rib, kKinds[kDaisy], 90, true); });
}

}  // namespace trapeze::scenes
