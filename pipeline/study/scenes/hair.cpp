/// Furry balls before a plain wall. A hair is one bicubic patch, narrow enough that it is diced into a single
/// row of micropolygons; hairs come in tufts that cover a whole ball thinly, and a tuft is instanced many
/// times, turned about the ball's upright axis so that all of its hairs go on hanging down. A second is one
/// shutter at motion 1.
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr int kHairsOfAll = 100000;  ///< at scale 1
constexpr int kHairsOfTuft = 200, kTuftsOfBall = 3;
constexpr double kHairWidth = .0048;  ///< at scale 1, at the root: about a pixel

struct Ball {
    V3d place;
    double radius;
    V3d color;
    double length;  ///< of hairs, in radii
    V3d moved;      ///< while the shutter is open
    double turned;  ///< degrees about the upright axis
};

const std::array<Ball, 5> kBalls = {{
    {{.1, -.33, 5.4}, .60, {.95, .45, .12}, .42, {.10, .03, 0}, 10},
    {{-1.45, -.52, 6.3}, .46, {.16, .62, .66}, .36, {.03, 0, 0}, -24},
    {{1.75, -.18, 7.4}, .78, {.92, .84, .68}, .44, {0, 0, 0}, 0},
    {{1.02, -.72, 4.1}, .22, {.92, .25, .42}, .40, {-.16, .05, .05}, 40},
    {{-.95, .66, 5.2}, .27, {.98, .80, .20}, .45, {.12, -.22, 0}, 20},
}};

/// Writes one hair as a ribbon. Lengths are in radii of the ball, which is at the origin.
void write_hair(RibWriter& rib, const Ball& ball, double width, Chance chance) {
    const V3d n = chance.direction(), up(0, 1, 0), down(0, -1, 0);
    V3d direction = n + .75 * up.cross(n) + .35 * chance.direction();
    direction.normalize();
    const double step = ball.length * chance.between(.7, 1.1) / 3;
    std::array<V3d, 4> curve;
    curve[0] = .96 * n;
    for (size_t i = 1; i < 4; ++i)
        curve[i] = curve[i - 1] + step * (direction + .35 * static_cast<double>(i) * down).normalized();

    const V3d across = (curve[3] - curve[0]).cross(chance.direction()).normalized();
    constexpr std::array<double, 4> kTaper = {1, .9, .65, .15};
    std::array<V3d, 16> points;
    for (size_t v = 0; v < 4; ++v)
        for (size_t u = 0; u < 4; ++u)
            points[4 * v + u] = curve[v] + (static_cast<double>(u) / 3 - .5) * width * kTaper[v] * across;

    // Lit like the coat as a whole, with a glitter of single hairs.
    const V3d normal = (n + .45 * chance.direction()).normalized();
    const V3d root = ball.color * chance.between(.18, .3), tip = ball.color * chance.between(.75, 1.1);
    rib.request("Patch", "bicubic", "P", flattened(points), "varying normal N",
                flattened(std::array{normal, normal, normal, normal}), "varying color Cs",
                flattened(std::array{root, root, tip, tip}));
}

void write_tufts(RibWriter& rib, double scale) {
    for (uint32_t b = 0; b < kBalls.size(); ++b)
        for (uint32_t t = 0; t < kTuftsOfBall; ++t) {
            const uint32_t tuft = b * kTuftsOfBall + t;
            rib.request("ObjectBegin", static_cast<int>(tuft));
            for (uint32_t i = 0; i < kHairsOfTuft; ++i)
                write_hair(rib, kBalls[b], kHairWidth / std::sqrt(scale) / kBalls[b].radius,
                           Chance(1, tuft * kHairsOfTuft + i));
            rib.request("ObjectEnd");
        }
}

void write_ball(RibWriter& rib, uint32_t number, int tufts, const SceneParameters& p) {
    const Ball& ball = kBalls[number];
    const auto whole = rib.block("Attribute");
    const V3d place = ball.place + p.time * ball.moved;
    write_moving(rib, "Translate", {place.x, place.y, place.z}, {ball.moved.x, ball.moved.y, ball.moved.z},
                 p);
    write_moving(rib, "Rotate", {p.time * ball.turned + 0.0, 0, 1, 0}, {ball.turned, 0, 0, 0}, p);
    rib.request("Scale", ball.radius, ball.radius, ball.radius);
    {
        const auto skin = rib.block("Attribute");
        rib.request("Surface", "matte");
        rib.request("Color", flattened(std::array{ball.color * .12}));
        rib.request("Sphere", .97, -.97, .97, 360);
    }
    for (int i = 0; i < tufts; ++i) {
        Chance chance(2 + number, static_cast<uint32_t>(i));
        const auto turn = rib.block("Transform");
        rib.request("Rotate", chance.between(-9, 9), 1, 0, 0);
        rib.request("Rotate", chance.between(0, 360), 0, 1, 0);
        rib.request("ObjectInstance", static_cast<int>(number) * kTuftsOfBall + i % kTuftsOfBall);
    }
}

/// How many tufts each ball gets: by its surface, all together as many as the scale asks for.
std::array<int, kBalls.size()> tufts_of_balls(double scale) {
    double surface = 0;
    for (const Ball& ball : kBalls) surface += ball.radius * ball.radius;
    const double tufts = kHairsOfAll * scale / kHairsOfTuft;
    std::array<int, kBalls.size()> count{};
    double sum = 0;
    int given = 0;
    for (size_t b = 0; b < kBalls.size(); ++b) {
        sum += kBalls[b].radius * kBalls[b].radius / surface;
        count[b] = std::max(1, static_cast<int>(std::lround(tufts * sum)) - given);
        given += count[b];
    }
    return count;
}

void write_plain_room(RibWriter& rib) {
    const auto room = rib.block("Attribute");
    rib.request("Surface", "matte");
    rib.request("Color", Numbers{.36, .42, .50});
    write_bilinear(rib, {{-9, -1, 10.5}, {9, -1, 10.5}, {-9, 7, 10.5}, {9, 7, 10.5}});
    rib.request("Color", Numbers{.42, .40, .38});
    write_bilinear(rib, {{-9, -1, 1}, {9, -1, 1}, {-9, -1, 10.5}, {9, -1, 10.5}});
}

Shot hair_shot() {
    Shot shot;
    shot.name = "hair";
    shot.comments = {
        "Furry balls before a plain wall: every hair is a ribbon of one bicubic patch.",
        "Right: the orange ball is sharp, the others are soft; the coats are dense, hang down and swirl;",
        "the small yellow and pink balls fly, the others turn."};
    shot.f_stop = 4, shot.focal_length = .35, shot.focal_distance = 5.0;
    // Segments of three pixels: about twenty along a hair.
    shot.shading_rate = 9;
    return shot;
}

void write_hair_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.10}, "lightcolor",
                Numbers{.75, .85, 1});
    rib.request("LightSource", "spotlight", 2, "intensity", Numbers{38}, "lightcolor", Numbers{1, .90, .76},
                "from", Numbers{-3.2, 4.2, 1.5}, "to", Numbers{.2, -.4, 6.2}, "coneangle", Numbers{.55},
                "conedeltaangle", Numbers{.3}, "beamdistribution", Numbers{1});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.28}, "lightcolor",
                Numbers{.55, .72, 1}, "from", Numbers{1, .5, -.6}, "to", Numbers{0, 0, 0});
    write_plain_room(rib);
    rib.request("Surface", "plastic", "Kd", Numbers{.85}, "Ks", Numbers{.22}, "roughness", Numbers{1.44});
    write_tufts(rib, p.scale);
    const auto tufts = tufts_of_balls(p.scale);
    for (uint32_t b = 0; b < kBalls.size(); ++b) write_ball(rib, b, tufts[b], p);
}

}  // namespace

std::string hair_scene(const SceneParameters& p) {
    return scene_of(hair_shot(), write_hair_world, p);
}

}  // namespace trapeze::scenes
