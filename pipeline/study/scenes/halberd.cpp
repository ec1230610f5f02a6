/// A halberd swung before a plain wall, for the controlled study: few surfaces, most of the picture either
/// one moving, blurred thing or flat background.
#include <array>

#include "pipeline/study/scenes/halberd_model.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

/// Micropolygons of two pixels or so at scale 1; the scale multiplies their number.
constexpr double kShadingRate = 2;

/// Where the grip is, and how the weapon leans: to the right, its head towards the eye.
const V3d kGrip(-2.2, -1.3, 11.0);
constexpr double kSlant = -57, kTilt = -24, kRoll = 28;

/// A floor that bends up into the wall, without a corner.
void write_backdrop(RibWriter& rib) {
    const auto backdrop = rib.block("Attribute");
    rib.request("Surface", "matte");
    constexpr std::array<std::array<double, 2>, 4> kProfile = {
        {{-3.6, 8}, {-3.6, 17}, {-3, 18.5}, {9, 18.5}}};
    std::vector<V3d> points;
    for (const auto& [y, z] : kProfile)
        for (int i = 0; i < 4; ++i) points.emplace_back(-14 + 28 * i / 3.0, y, z);
    const V3d low(.24, .16, .12), high(.07, .125, .17);
    rib.request("Patch", "bicubic", "P", flattened(points), "varying color Cs",
                flattened(std::array{low, low, high, high}));
}

void write_stage_lights(RibWriter& rib) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.16}, "lightcolor",
                Numbers{.75, .85, 1});
    rib.request("LightSource", "spotlight", 2, "intensity", Numbers{95}, "lightcolor", Numbers{1, .9, .76},
                "from", Numbers{-5.5, 7, 4.5}, "to", Numbers{.8, -.6, 14}, "coneangle", Numbers{.62},
                "conedeltaangle", Numbers{.5}, "beamdistribution", Numbers{2});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.42}, "lightcolor",
                Numbers{1, .95, .9}, "from", Numbers{-.75, .75, -.6}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 4, "intensity", Numbers{.35}, "lightcolor",
                Numbers{.45, .65, 1}, "from", Numbers{1, -.2, .25}, "to", Numbers{0, 0, 0});
    // A pool of light on the wall, from behind the weapon.
    rib.request("LightSource", "spotlight", 5, "intensity", Numbers{85}, "lightcolor", Numbers{.8, .9, 1},
                "from", Numbers{1, 3, 12.9}, "to", Numbers{.6, .4, 18.5}, "coneangle", Numbers{1.1},
                "conedeltaangle", Numbers{1}, "beamdistribution", Numbers{3});
}

Shot halberd_shot() {
    Shot shot;
    shot.name = "halberd";
    shot.comments = {
        "A halberd swung before a plain wall, of subdivision surfaces with creases.",
        "Right: the grip's upper end is sharp, head and butt are soft; the head is the fastest."};
    shot.f_stop = 2, shot.focal_length = 1.1, shot.focal_distance = 9.9;
    return shot;
}

void write_halberd_world(RibWriter& rib, const SceneParameters& p) {
    write_stage_lights(rib);
    write_backdrop(rib);
    const auto weapon = rib.block("Attribute");
    write_moving(rib, "Translate", {kGrip.x, kGrip.y, kGrip.z}, {-.04, .05, 0}, p);
    write_moving(rib, "Rotate", {0, 0, 0, 1}, {2.85, 0, 0, 0}, p);
    rib.request("Rotate", kSlant, 0, 0, 1);
    rib.request("Rotate", kTilt, 1, 0, 0);
    rib.request("Rotate", kRoll, 0, 1, 0);
    write_halberd(rib);
}

}  // namespace

std::string halberd_scene(const SceneParameters& p) {
    Shot shot = halberd_shot();
    shot.shading_rate = kShadingRate / p.scale;
    return scene_of(shot, write_halberd_world, p);
}

}  // namespace trapeze::scenes
