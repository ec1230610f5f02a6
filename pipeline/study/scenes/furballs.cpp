/// Two balls of half transparent fur on a floor that mirrors them, after figure 7a of Hou et al. 2010: out of
/// focus, at most five layers a sample. The paper's stand still.
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/fur.h"

namespace trapeze::scenes {
namespace {

constexpr int kHairsOfBoth = 99000;  ///< at scale 1; the paper's are 495,000
constexpr double kFurWidth = .009;   ///< at the root, scale 1; balls have the radius 1
constexpr int kMostLayers = 5;       ///< as the paper's

struct FurBall {
    V3d place, hair, skin;
    double size;
};

const std::array<FurBall, 2> kFurBalls = {{{{-.95, 0, 7}, {.86, .50, .24}, {.14, .08, .05}, 1},
                                           {{1.3, -.22, 8.2}, {.40, .56, .72}, {.06, .08, .12}, .85}}};
constexpr double kFloor = -1.3;

void write_mirror_room(RibWriter& rib) {
    {
        const auto floor = rib.block("Attribute");
        rib.request("Surface", "mirror", "Kd", Numbers{.35}, "Kr", Numbers{.45}, "Ks", Numbers{.1});
        rib.request("Color", Numbers{.50, .47, .44});
        write_bilinear(rib, {{-14, kFloor, 1}, {14, kFloor, 1}, {-14, kFloor, 16}, {14, kFloor, 16}});
    }
    const auto wall = rib.block("Attribute");
    rib.request("Surface", "matte");
    rib.request("Color", Numbers{.34, .38, .44});
    write_bilinear(rib, {{-14, kFloor, 16}, {14, kFloor, 16}, {-14, 9, 16}, {14, 9, 16}});
}

void write_furballs_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.95}, "lightcolor",
                Numbers{1, .93, .82}, "from", Numbers{-1, 1.6, -1.6}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.35}, "lightcolor",
                Numbers{.6, .75, 1}, "from", Numbers{1.5, .4, -.3}, "to", Numbers{0, 0, 0});
    rib.request("Attribute", "visibility", "int specular", Integers{1});
    write_mirror_room(rib);
    const int hairs = std::max(2, static_cast<int>(std::lround(kHairsOfBoth * p.scale)));
    int first = 0;
    for (size_t i = 0; i < kFurBalls.size(); ++i) {
        const FurBall& ball = kFurBalls[i];
        const auto attributes = rib.block("Attribute");
        write_moving(rib, "Translate", {ball.place.x, ball.place.y, ball.place.z}, {.06, .03, 0}, p);
        rib.request("Scale", ball.size, ball.size, ball.size);
        {
            const auto skin = rib.block("Attribute");
            rib.request("Surface", "matte");
            rib.request("Color", Numbers{ball.skin.x, ball.skin.y, ball.skin.z});
            rib.request("Sphere", .98, -.98, .98, 360);
        }
        rib.request("Surface", "plastic", "Kd", Numbers{.6}, "Ks", Numbers{.12}, "roughness", Numbers{1.2});
        rib.request("Opacity", Numbers{.5, .5, .5});
        rib.request("Basis", "bezier", 3, "bezier", 3);
        const int end = i == 0 ? hairs / 2 : hairs;
        write_fur(rib, first, end - first, kFurWidth / std::sqrt(p.scale), ball.hair);
        first = end;
    }
}

}  // namespace

std::string furballs_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "furballs";
    shot.comments = {"Two balls of half transparent fur on a mirror, of which at most five layers count."};
    shot.eye = {0, .35, 0}, shot.pitch = 4;
    shot.f_stop = 5, shot.focal_length = .3, shot.focal_distance = 6.1;
    shot.most_layers = kMostLayers;
    shot.shading_rate = 4;
    return scene_of(shot, write_furballs_world, p);
}

}  // namespace trapeze::scenes
