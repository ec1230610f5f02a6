/// One ball of fur before a plain ground: every hair is a cubic curve, a thousand of them in a request. For
/// measuring what hairs cost from RIB to picture; the hairs of `hair` are patches, as the paper's are.
#include <algorithm>

#include "pipeline/study/scenes/fur.h"

namespace trapeze::scenes {
namespace {

constexpr int kHairs = 100000;   ///< at scale 1
constexpr double kWidth = .006;  ///< at the root, scale 1; the ball's radius is 1

void write_furball_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.15});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.9}, "lightcolor",
                Numbers{1, .93, .82}, "from", Numbers{-1, 1.5, -1.8}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.3}, "lightcolor", Numbers{.6, .75, 1},
                "from", Numbers{1.5, .3, -.4}, "to", Numbers{0, 0, 0});
    {
        const auto ground = rib.block("Attribute");
        rib.request("Surface", "matte");
        rib.request("Color", Numbers{.45, .48, .52});
        write_bilinear(rib, {{-12, -1.35, 1}, {12, -1.35, 1}, {-12, -1.35, 14}, {12, -1.35, 14}});
        write_bilinear(rib, {{-12, -1.35, 14}, {12, -1.35, 14}, {-12, 8, 14}, {12, 8, 14}});
    }
    const auto ball = rib.block("Attribute");
    write_moving(rib, "Translate", {0, .05, 7}, {.12, .05, 0}, p);
    write_moving(rib, "Rotate", {0, 0, 1, 0}, {8, 0, 0, 0}, p);
    {
        const auto skin = rib.block("Attribute");
        rib.request("Surface", "matte");
        rib.request("Color", Numbers{.16, .1, .06});
        rib.request("Sphere", .98, -.98, .98, 360);
    }
    rib.request("Surface", "plastic", "Kd", Numbers{.8}, "Ks", Numbers{.25}, "roughness", Numbers{1.2});
    rib.request("Basis", "bezier", 3, "bezier", 3);
    const int hairs = std::max(1, static_cast<int>(std::lround(kHairs * p.scale)));
    write_fur(rib, 0, hairs, kWidth / std::sqrt(p.scale), {.85, .55, .3});
}

}  // namespace

std::string furball_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "furball";
    shot.comments = {"A ball of fur that turns and drifts: every hair is a cubic curve, thick at its root."};
    shot.f_stop = 8, shot.focal_length = .3, shot.focal_distance = 6;
    shot.shading_rate = 4;
    return scene_of(shot, write_furball_world, p);
}

}  // namespace trapeze::scenes
