/// A field of flowers and grass under a lens of wide aperture: a few flowers are sharp, those before and
/// behind them are soft, and many layers of them overlap.
#include <array>
#include <cmath>

#include "pipeline/study/scenes/flower_model.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

/// Numbers of plants; where the field begins and ends along z.
constexpr double kFlowers = 520, kTufts = 1100;  ///< at scale 1
constexpr double kMeadowNear = 2.3, kMeadowFar = 34;
constexpr double kFlowerShadingRate = 5;
/// Soft from edge to edge, and as many at any scale.
constexpr double kBackgroundRate = 64;
const V3d kEye(0, 1.55, 0);

enum MeadowChances : uint32_t {
    kFlowerChance = 300,
    kMeadowTuftChance,
    kTreeChance,
    kCloudChance,
    kSeedChance
};

/// A plant of the group in focus.
struct Chosen {
    int object;
    double x, z, turn, size;
};

constexpr double kGroupX = .42, kGroupZ = 5;

std::array<Chosen, 8> chosen() {
    return {{{ladybug_daisy_object(), .30, 4.95, 0, 1.12},
             {flower_object(kPoppy, 1), 1.02, 5.25, -14, 1.0},
             {flower_object(kDaisy, 2), -.34, 5.10, 20, .95},
             {flower_object(kCornflower, 0), .74, 4.75, 10, .80},
             {flower_object(kPoppy, 3), -.12, 5.90, 25, 1.12},
             {flower_object(kCosmos, 1), .02, 4.80, -8, .62},
             {tuft_object(1), .35, 5.0, 0, .9},
             {tuft_object(3), .75, 5.05, 70, .8}}};
}

/// The field: level about the flowers in focus, rising behind.
double ground(double x, double z) {
    const double behind = std::max(0.0, z - 8);
    return .042 * behind + .006 * behind * std::sin(.35 * x + .8);
}

/// A wind from the left, in gusts. Degrees.
double sway(double x, double z) {
    return -.95 - .5 * std::sin(.9 * x + .5 * z);
}

struct Place {
    double x, z;
};

/// Over what the camera sees of the field, in rows that thin out with the distance, as seen from above.
Place scattered(Chance& chance) {
    const double u = chance.unit(), z = kMeadowNear + (kMeadowFar - kMeadowNear) * u * (.6 + .4 * u);
    return {(.5 * z + .5) * chance.between(-1, 1), z};
}

/// A factor of a plant's height: less than 1 where it would hide the flowers in focus.
double fitting(const Place& place) {
    const double aside = std::abs(place.x / place.z - kGroupX / kGroupZ);
    return place.z < 5.7 && aside < .19 ? .5 : 1;
}

void write_plant(RibWriter& rib, const Chosen& plant, double lean, double sways, const SceneParameters& p) {
    const auto block = rib.block("Transform");
    rib.request("Translate", plant.x, ground(plant.x, plant.z), plant.z);
    write_moving(rib, "Rotate", {lean, 0, 0, 1}, {sways, 0, 0, 0}, p);
    rib.request("Rotate", plant.turn, 0, 1, 0);
    rib.request("Scale", plant.size, plant.size, plant.size);
    rib.request("ObjectInstance", plant.object);
}

/// Flowers of a kind grow in drifts.
uint32_t kind_at(const Place& place, Chance& chance) {
    const double drift = .5 + .32 * std::sin(.8 * place.x + .25 * place.z) +
                         .3 * std::sin(.55 * place.z - .3 * place.x + 2) + chance.between(-.16, .16);
    const double any = chance.unit(), where = chance.unit() < .7 ? drift - std::floor(drift) : any;
    return std::min(kFlowerKinds - 1, static_cast<uint32_t>(where * kFlowerKinds));
}

void write_field(RibWriter& rib, const SceneParameters& p) {
    const auto flowers = static_cast<uint32_t>(std::ceil(kFlowers * p.scale));
    for (uint32_t i = 0; i < flowers; ++i) {
        Chance chance(kFlowerChance, i);
        const Place place = scattered(chance);
        const auto variant = static_cast<uint32_t>(kFlowerVariants * chance.unit());
        const int object = flower_object(kind_at(place, chance), variant);
        const double size = chance.between(.75, 1.2) * fitting(place);
        const double swaying = chance.between(.7, 1.2) * sway(place.x, place.z);
        const double leaning = chance.between(-7, 7), turned = chance.between(-65, 65);
        write_plant(rib, {object, place.x, place.z, turned, size}, leaning, swaying, p);
    }
    const auto tufts = static_cast<uint32_t>(std::ceil(kTufts * p.scale));
    for (uint32_t i = 0; i < tufts; ++i) {
        Chance chance(kMeadowTuftChance, i);
        const Place place = scattered(chance);
        const int object = tuft_object(static_cast<uint32_t>(kTuftVariants * chance.unit()));
        const double size = chance.between(.7, 1.25) * fitting(place);
        const double swaying = chance.between(.7, 1.2) * sway(place.x, place.z);
        const double leaning = chance.between(-6, 6), turned = chance.between(0, 360);
        write_plant(rib, {object, place.x, place.z, turned, size}, leaning, swaying, p);
    }
    for (const Chosen& plant : chosen()) write_plant(rib, plant, 0, -.25, p);
}

void write_ground(RibWriter& rib) {
    constexpr int kColumns = 13, kRows = 21;
    std::vector<V3d> points, colors;
    for (int r = 0; r < kRows; ++r)
        for (int c = 0; c < kColumns; ++c) {
            const double z = 1.5 + (44 - 1.5) * r / (kRows - 1.0), x = (c - 6) * (1 + .8 * z) / 6;
            const double t = std::min(1.0, z / 30);
            points.emplace_back(x, ground(x, z), z);
            colors.push_back(V3d(.02, .045, .012) + t * V3d(.10, .16, .03));
        }
    rib.request("Surface", "matte");
    rib.request("PatchMesh", "bilinear", kColumns, "nonperiodic", kRows, "nonperiodic", "P",
                flattened(points), "varying color Cs", flattened(colors));
}

/// Trees at the field's end.
void write_trees(RibWriter& rib) {
    for (uint32_t i = 0; i < 90; ++i) {
        Chance chance(kTreeChance, i);
        const double z = chance.between(46, 70), x = z * chance.between(-.62, .62);
        const double size = chance.between(.5, 2.1);
        const auto block = rib.block("Attribute");
        rib.request("Color", Numbers{.07 * chance.between(.7, 1.6), .14 * chance.between(.8, 1.3), .06});
        rib.request("Translate", x, 1.6 + .4 * size, z);
        rib.request("Scale", 1.3 * size, size, size);
        rib.request("Sphere", 1, -1, 1, 360);
    }
}

void write_sky(RibWriter& rib) {
    rib.request("Surface", "constant");
    const V3d low(1.0, .80, .52), high(.09, .33, .80);
    const std::array<V3d, 4> corners = {V3d(-110, -5, 150), V3d(110, -5, 150), V3d(-110, 40, 150),
                                        V3d(110, 40, 150)};
    rib.request("Patch", "bilinear", "P", flattened(corners), "varying color Cs",
                flattened(std::array{low, low, high, high}));
}

/// Flat discs of light; the lens makes them soft.
void write_clouds(RibWriter& rib) {
    for (uint32_t i = 0; i < 26; ++i) {
        Chance chance(kCloudChance, i);
        const double bank = .9 * static_cast<double>(i % 5) - 1.8;
        const auto block = rib.block("Attribute");
        const double light = chance.between(.86, 1.02);
        rib.request("Color", Numbers{light, .92 * light, .84 * light});
        const double z = 140 + chance.unit(), up = chance.between(-1, 1), beside = chance.between(-13, 13);
        rib.request("Translate", 34 * bank + beside, 17 + 4.5 * std::sin(2.1 * bank) + up, z);
        const double high = chance.between(.6, 1.5), wide = chance.between(4, 10);
        rib.request("Scale", wide, high, 1);
        rib.request("Disk", 0, 1, 360);
    }
}

/// Seeds that float in the sun: bright and small, so that the lens makes polygons of them.
void write_seeds(RibWriter& rib) {
    constexpr uint32_t kSeeds = 45;
    rib.request("Surface", "constant");
    for (uint32_t i = 0; i < kSeeds; ++i) {
        Chance chance(kSeedChance, i);
        const double z = chance.between(9, 26), x = .45 * z * chance.between(-1, 1);
        const double light = chance.between(5, 13), size = .0025 * z;
        const auto block = rib.block("Attribute");
        rib.request("Color", Numbers{light, .8 * light, .45 * light});
        rib.request("Translate", x, ground(x, z) + 1 + .09 * z * chance.unit(), z);
        rib.request("Sphere", size, -size, size, 360);
    }
}

void write_background(RibWriter& rib) {
    const auto background = rib.block("Attribute");
    rib.request("ShadingRate", kBackgroundRate);
    write_ground(rib);
    write_trees(rib);
    write_sky(rib);
    write_clouds(rib);
    write_seeds(rib);
}

Shot flowers_shot() {
    Shot shot;
    shot.name = "flowers";
    shot.comments = {
        "A field of flowers and grass of bicubic patches, swayed by a mild wind.",
        "Right: a few flowers and the ladybug on one are sharp; what stands before and behind is soft,",
        "seeds in hexagons of the lens' blades, with a glow."};
    shot.eye = kEye, shot.pitch = 6;
    shot.f_stop = 2, shot.focal_length = .32, shot.focal_distance = 4.9;
    shot.shading_rate = kFlowerShadingRate;
    shot.blades = 6, shot.glow = .12;
    return shot;
}

void write_flowers_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.32}, "lightcolor",
                Numbers{.72, .86, 1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.85}, "lightcolor",
                Numbers{1, .90, .72}, "from", Numbers{-.7, .9, -.6}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.45}, "lightcolor", Numbers{1, .8, .5},
                "from", Numbers{.8, .5, .5}, "to", Numbers{0, 0, 0});
    write_background(rib);
    rib.request("Surface", "matte");
    write_plant_objects(rib);
    write_field(rib, p);
}

}  // namespace

std::string flowers_scene(const SceneParameters& p) {
    return scene_of(flowers_shot(), write_flowers_world, p);
}

}  // namespace trapeze::scenes
