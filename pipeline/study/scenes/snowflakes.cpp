/// Snow crystals that turn: six arms with needles, and needles on these, long and thin, sixty degrees apart,
/// along no axis. In the kind of the Flake of [Yang17]. A face of a needle is one micropolygon.
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/quad_mesh.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr int kCrystals = 7;            ///< at scale 1
constexpr int kNeedleSides = 6;         ///< of a needle
constexpr double kMostCrystalTurn = 9;  ///< degrees while the shutter is open, at motion 1

class Crystal {
  public:
    explicit Crystal(uint32_t index) : chance_(47, index) {
        for (double& length : lengths_) length = chance_.between(.45, 1);
        plate_ = chance_.between(.1, .22);
        for (int arm = 0; arm < 6; ++arm) add_branch(V3d(0), arm * kPi / 3, 1, .026, 0);
        for (int arm = 0; arm < 6; ++arm) {  // the plate in the middle, of rings
            for (int ring = 1; ring <= 5; ++ring) {
                const V3d from = plate_ * ring / 5 * along(arm * kPi / 3);
                add_needle(from, plate_ * ring / 5 * along((arm + 1) * kPi / 3), .012);
            }
        }
    }

    void write(RibWriter& rib) const { mesh_.write(rib); }

  private:
    static V3d along(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

    /// A prism between two points, pointed at its end, brighter there.
    void add_needle(const V3d& from, const V3d& to, double width) {
        const V3d way = (to - from).normalized(), side = V3d(0, 0, 1).cross(way), up(0, 0, 1);
        const auto at = [&](const V3d& middle, double radius, int i) {
            const double angle = 2 * kPi * i / kNeedleSides;
            return middle + radius * (std::cos(angle) * side + .6 * std::sin(angle) * up);
        };
        const double bright = std::min(1.0, .55 + .45 * from.length());
        const V3d low = bright * V3d(.62, .78, .95), high = V3d(.95, .98, 1);
        for (int i = 0; i < kNeedleSides; ++i)
            mesh_.add({at(from, width, i), at(from, width, i + 1), at(to, .35 * width, i + 1),
                       at(to, .35 * width, i)},
                      {low, low, high, high});
    }

    /// A needle with pairs of smaller ones, which grow from it sixty degrees aside.
    void add_branch(const V3d& from, double angle, double length, double width, size_t level) {
        add_needle(from, from + length * along(angle), width);
        if (level == 2) return;
        const int pairs = level == 0 ? 7 : 3;
        for (int pair = 0; pair < pairs; ++pair) {
            const double at = (pair + 1.0) / (pairs + 1.5);
            // Longest in the middle of an arm; which are long is the same on all arms.
            const double part =
                .62 * std::sin(kPi * (.15 + .8 * at)) * lengths_[level * 7 + static_cast<size_t>(pair)];
            for (const int side : {-1, 1})
                add_branch(from + at * length * along(angle), angle + side * kPi / 3, .8 * part * length,
                           .55 * width, level + 1);
        }
    }

    Chance chance_;
    std::array<double, 10> lengths_{};
    double plate_ = 0;
    QuadMesh mesh_;
};

void write_crystal(RibWriter& rib, uint32_t index, double size, const SceneParameters& p) {
    const auto block = rib.block("Attribute");
    Chance chance(53, index);
    const double depth = index == 0 ? 7 : chance.between(6, 13);
    const double x = index == 0 ? -.5 : depth * chance.between(-.55, .55);
    const double y = index == 0 ? 0 : depth * chance.between(-.3, .3);
    rib.request("Translate", x, y, depth);
    const V3d axis = chance.direction(), across = (V3d(0, 0, 1) + .6 * chance.direction()).normalized();
    write_moving(rib, "Rotate", {chance.between(0, 50), axis.x, axis.y, axis.z}, {0, 0, 0, 0}, p);
    write_moving(rib, "Rotate", {chance.between(0, 60), across.x, across.y, across.z},
                 {kMostCrystalTurn * chance.between(.3, 1) * (index % 2 == 0 ? 1 : -1), 0, 0, 0}, p);
    const double radius = size * (index == 0 ? 1.9 : chance.between(.8, 1.6));
    rib.request("Scale", radius, radius, radius);
    Crystal(index).write(rib);
}

void write_snowflakes_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.3}, "lightcolor",
                Numbers{.7, .82, 1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.9}, "lightcolor",
                Numbers{1, .96, .88}, "from", Numbers{-.5, .8, -1}, "to", Numbers{0, 0, 0});
    {
        const auto night = rib.block("Attribute");
        rib.request("Surface", "constant");
        const V3d low(.16, .22, .36), high(.02, .03, .08);
        rib.request(
            "Patch", "bilinear", "P",
            flattened(std::array{V3d(-20, -12, 18), V3d(20, -12, 18), V3d(-20, 12, 18), V3d(20, 12, 18)}),
            "varying color Cs", flattened(std::array{low, low, high, high}));
    }
    rib.request("Surface", "plastic", "Kd", Numbers{.7}, "Ks", Numbers{.6}, "roughness", Numbers{.1});
    const auto crystals = static_cast<uint32_t>(std::max(1.0, std::round(kCrystals * p.scale)));
    for (uint32_t i = 0; i < crystals; ++i) write_crystal(rib, i, 1 / std::sqrt(std::max(1.0, p.scale)), p);
}

}  // namespace

std::string snowflakes_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "snowflakes";
    shot.comments = {
        "Snow crystals turn before a night sky, of needles that grow sixty degrees aside from others.",
        "Right: each has six like arms; middles are nearly sharp, ends of arms are blurred."};
    shot.fov = 40;
    shot.f_stop = 4, shot.focal_length = .3, shot.focal_distance = 7;
    shot.shading_rate = 1e6;  // larger than any face
    return scene_of(shot, write_snowflakes_world, p);
}

}  // namespace trapeze::scenes
