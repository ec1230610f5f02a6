/// A nave between two rows of columns, under a barrel vault, of long and thin quadrilaterals, seen askew by a
/// camera that turns: in the kind of the rotated Sponza of [Gruenschloss11] and [Yang17], whose edges are
/// along no axis. A quadrilateral is one micropolygon.
#include <algorithm>

#include "pipeline/study/scenes/quad_mesh.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr double kNaveFloor = -1.6, kSpring = 1.7, kVaultRadius = 2.6;  ///< where arches begin; of the vault
constexpr double kNear = 2.5, kFar = 27, kAisle = 4.6;                  ///< along z; half of the width
constexpr int kBays = 14;
constexpr double kTurn = 1;  ///< degrees that the camera turns, at motion 1

/// Parts of the building in numbers of strips at scale 1: 76,000 in all.
constexpr int kStripsOfColumn = 520, kStripsOfArch = 360, kStripsOfVault = 5200, kPiecesOfVault = 3,
              kBoards = 3600, kPiecesOfBoard = 2, kStripsOfWall = 5200;

class Building {
  public:
    explicit Building(double scale) : scale_(scale) {}

    void write(RibWriter& rib) {
        for (const int side : {-1, 1}) {
            for (int bay = 0; bay <= kBays; ++bay) add_column(side * kVaultRadius, z_of(bay));
            for (int bay = 0; bay < kBays; ++bay) add_arch(side, z_of(bay), z_of(bay + 1));
            add_wall(side * kAisle);
        }
        add_vault();
        add_floor();
        mesh_.write(rib);
    }

  private:
    static double z_of(int bay) { return kNear + (kFar - kNear) * bay / kBays; }
    int count(int strips) const { return std::max(4, static_cast<int>(std::lround(strips * scale_))); }

    /// Adds a strip with a shade of its own, darker by `dark`.
    void add(const Corners& places, const V3d& color, double dark = 0) {
        Chance chance(41, strips_++);
        mesh_.add(places, color * (chance.between(.86, 1.06) * (1 - dark)));
    }

    /// A fluted shaft: upright strips around it, with a foot and a head.
    void add_column(double x, double z) {
        const int strips = count(kStripsOfColumn);
        const auto at = [&](int i, double y, double wider) {
            const double angle = 2 * kPi * i / strips, flute = std::abs(std::sin(10 * angle));
            const double radius = (.25 + .03 * flute) * wider;
            return V3d(x + radius * std::cos(angle), y, z + radius * std::sin(angle));
        };
        for (int i = 0; i < strips; ++i) {
            const double dark = .35 * (1 - std::abs(std::sin(10 * 2 * kPi * (i + .5) / strips)));
            add({at(i, kNaveFloor, 1), at(i + 1, kNaveFloor, 1), at(i + 1, kSpring, 1), at(i, kSpring, 1)},
                V3d(.86, .80, .70), dark);
        }
    }

    /// A half circle over two columns, of strips as deep as the wall that it carries.
    void add_arch(int side, double z0, double z1) {
        const int strips = count(kStripsOfArch);
        const double middle = .5 * (z0 + z1), radius = .5 * (z1 - z0) - .22, depth = .32;
        const auto at = [&](int i, double x) {
            const double angle = kPi * i / strips;
            return V3d(side * (kVaultRadius + x), kSpring + radius * std::sin(angle),
                       middle + radius * std::cos(angle));
        };
        for (int i = 0; i < strips; ++i) {
            // The lining, then what is above it, up to the vault's foot.
            add({at(i, -depth), at(i + 1, -depth), at(i + 1, depth), at(i, depth)}, V3d(.80, .62, .46));
            V3d a = at(i, -depth), b = at(i + 1, -depth), up_a = a, up_b = b;
            up_a.y = up_b.y = kSpring + 1.1;
            add({a, b, up_b, up_a}, V3d(.84, .76, .66));
        }
    }

    /// Planks along the nave, bent across it into half a circle.
    void add_vault() {
        const int strips = count(kStripsOfVault);
        for (int i = 0; i < strips; ++i)
            for (int piece = 0; piece < kPiecesOfVault; ++piece) {
                const auto at = [&](int n, int end) {
                    const double angle = kPi * n / strips;
                    return V3d((kVaultRadius - .3) * std::cos(angle),
                               kSpring + 1.1 + .75 * (kVaultRadius - .3) * std::sin(angle),
                               kNear + (kFar - kNear) * end / kPiecesOfVault);
                };
                add({at(i, piece), at(i + 1, piece), at(i + 1, piece + 1), at(i, piece + 1)},
                    V3d(.52, .60, .66), i * 24 / strips % 2 == 0 ? .25 : 0);
            }
    }

    void add_floor() {
        const int boards = count(kBoards);
        for (int i = 0; i < boards; ++i)
            for (int piece = 0; piece < kPiecesOfBoard; ++piece) {
                const auto at = [&](int n, int end) {
                    return V3d(-kAisle + 2 * kAisle * n / boards, kNaveFloor,
                               kNear + (kFar - kNear) * end / kPiecesOfBoard);
                };
                add({at(i, piece), at(i + 1, piece), at(i + 1, piece + 1), at(i, piece + 1)},
                    V3d(.50, .36, .26), i * 40 / boards % 2 == 0 ? .3 : 0);
            }
    }

    /// Upright boards behind the columns, with a lighter one now and then.
    void add_wall(double x) {
        const int strips = count(kStripsOfWall);
        const auto at = [&](int n, double y) { return V3d(x, y, kNear + (kFar - kNear) * n / strips); };
        for (int i = 0; i < strips; ++i)
            for (const double y : {kNaveFloor, .8})
                add({at(i, y), at(i + 1, y), at(i + 1, y + 2.4), at(i, y + 2.4)},
                    y < 0 ? V3d(.42, .20, .16) : V3d(.78, .70, .56), i * 90 / strips % 6 == 0 ? .45 : 0);
    }

    double scale_;
    QuadMesh mesh_;
    uint32_t strips_ = 0;
};

void write_arcade_world(RibWriter& rib, const SceneParameters& p) {
    write_moving(rib, "Rotate", {11, 0, 0, 1}, {0, 0, 0, 0}, p);
    write_moving(rib, "Rotate", {15, 0, 1, 0}, {kTurn, 0, 0, 0}, p);
    write_moving(rib, "Rotate", {7, 1, 0, 0}, {0, 0, 0, 0}, p);
    rib.request("Translate", .9, 0, 0);
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.12}, "lightcolor",
                Numbers{.7, .8, 1});
    rib.request("LightSource", "pointlight", 2, "intensity", Numbers{9}, "lightcolor", Numbers{1, .85, .62},
                "from", Numbers{0, 1.2, 8});
    rib.request("LightSource", "pointlight", 3, "intensity", Numbers{9}, "lightcolor", Numbers{1, .80, .55},
                "from", Numbers{0, 1.2, 17});
    rib.request("LightSource", "distantlight", 4, "intensity", Numbers{.4}, "lightcolor",
                Numbers{.75, .85, 1}, "from", Numbers{-.7, .6, -1}, "to", Numbers{0, 0, 0});
    {
        const auto sky = rib.block("Attribute");
        rib.request("Surface", "constant");
        rib.request("Color", Numbers{.42, .56, .74});
        write_bilinear(rib, {{-200, -120, 45}, {200, -120, 45}, {-200, 120, 45}, {200, 120, 45}});
    }
    rib.request("Surface", "matte");
    Building(p.scale).write(rib);
}

}  // namespace

std::string arcade_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "arcade";
    shot.comments = {"A nave between two rows of columns under a barrel vault, of long, thin quadrilaterals.",
                     "Right: it is seen askew, columns are fluted; all of it turns, what is near more widely",
                     "blurred than what is in the middle."};
    shot.fov = 58;
    shot.f_stop = 4, shot.focal_length = .05, shot.focal_distance = 7;
    shot.shading_rate = 1e6;  // larger than any quadrilateral
    return scene_of(shot, write_arcade_world, p);
}

}  // namespace trapeze::scenes
