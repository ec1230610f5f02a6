/// A hand that closes: one small, smooth skin over joints that bend while the shutter is open. In the kind of
/// the Hand of [Yang17].
#include <algorithm>
#include <array>

#include "pipeline/study/scenes/moving_cage.h"
#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {
namespace {

constexpr double kHandShadingRate = 110;   ///< 16,000 micropolygons at 1280x720
constexpr double kHandShutter = 1.0 / 24;  ///< seconds that it is open, at motion 1
constexpr double kBeat = 2.4;              ///< of closing and opening, radians a second
constexpr double kWristSwing = 5;          ///< degrees that the wrist turns, at motion 1

const V3d kSkin(.78, .50, .38), kTip(.90, .50, .44), kCuff(.14, .22, .40);

/// A finger is a square tube through joints that bend in one plane.
struct Finger {
    std::array<double, 3> lengths;  ///< of its bones
    double width, depth;            ///< half of them, at the root
    double lag;                     ///< radians of the beat behind the first finger
    double most_bend;               ///< radians, of each joint
};
constexpr std::array<Finger, 4> kFingers = {{{{.46, .28, .22}, .105, .13, .9, 1.05},
                                             {{.55, .34, .25}, .112, .14, .6, 1.1},
                                             {{.60, .37, .26}, .112, .14, .3, 1.1},
                                             {{.52, .31, .25}, .112, .14, 0, 1.05}}};
constexpr Finger kThumb = {{.40, .34, .26}, .16, .15, .5, .5};

class Hand {
  public:
    explicit Hand(double time) : time_(time) {
        add_palm();
        for (int i = 0; i < 4; ++i) {
            const V3d root = .25 * (at(i, 3, 0) + at(i + 1, 3, 0) + at(i + 1, 3, 1) + at(i, 3, 1));
            const double aside = (i - 1.5) * .10;
            add_finger(kFingers[static_cast<size_t>(i)], root, V3d(std::sin(aside), std::cos(aside), 0),
                       V3d(0, 0, -1),
                       {number(i, 3, 0), number(i + 1, 3, 0), number(i + 1, 3, 1), number(i, 3, 1)});
        }
        const V3d root = .25 * (at(4, 0, 0) + at(4, 1, 0) + at(4, 1, 1) + at(4, 0, 1));
        add_finger(kThumb, root, V3d(.80, .52, -.30).normalized(), V3d(-.55, .25, -.8).normalized(),
                   {number(4, 1, 0), number(4, 0, 0), number(4, 0, 1), number(4, 1, 1)});
    }
    Cage take() { return std::move(cage_); }

  private:
    static constexpr int kColumns = 5, kRows = 4;

    static int number(int column, int row, int back) { return (row * kColumns + column) * 2 + back; }
    V3d at(int column, int row, int back) const {
        return cage_.points[static_cast<size_t>(number(column, row, back))];
    }

    /// A flat box of 4 x 3 cells, narrower at the wrist, on a cuff; open where fingers grow.
    void add_palm() {
        static constexpr std::array<double, kRows> kHeights = {-.15, .3, .7, 1.05},
                                                   kWidths = {.78, 1.12, 1.24, 1.26},
                                                   kDepths = {.19, .19, .17, .13};
        for (int r = 0; r < kRows; ++r)
            for (int c = 0; c < kColumns; ++c)
                for (const double z : {-1, 1}) {
                    const auto row = static_cast<size_t>(r);
                    const double x = .25 * (c - 2), bulge = 1 - .15 * std::abs(c - 2);
                    const double knuckles = r == 3 ? .06 * (1 - std::abs(c - 2.4)) : 0;
                    cage_.add(V3d(x * kWidths[row], kHeights[row] + knuckles, z * kDepths[row] * bulge),
                              kSkin);
                }
        for (int r = 0; r + 1 < kRows; ++r) {
            for (int c = 0; c + 1 < kColumns; ++c) {
                cage_.face(
                    {number(c, r, 0), number(c, r + 1, 0), number(c + 1, r + 1, 0), number(c + 1, r, 0)});
                cage_.face(
                    {number(c, r, 1), number(c + 1, r, 1), number(c + 1, r + 1, 1), number(c, r + 1, 1)});
            }
            cage_.face({number(0, r, 0), number(0, r, 1), number(0, r + 1, 1), number(0, r + 1, 0)});
            if (r > 0)
                cage_.face({number(4, r, 0), number(4, r + 1, 0), number(4, r + 1, 1), number(4, r, 1)});
        }
        // The wrist, down to a cuff that is out of the picture.
        std::array<int, 10> rim{}, cuff{}, end{};
        for (int c = 0; c < kColumns; ++c)
            rim[static_cast<size_t>(c)] = number(c, 0, 0), rim[static_cast<size_t>(9 - c)] = number(c, 0, 1);
        for (size_t i = 0; i < rim.size(); ++i) {
            const V3d p = cage_.points[static_cast<size_t>(rim[i])];
            cuff[i] = cage_.add(V3d(.72 * p.x, -.55, 1.05 * p.z), kSkin);
            end[i] = cage_.add(V3d(.9 * p.x, -2.2, 1.5 * p.z), kCuff);
        }
        for (size_t i = 0; i < rim.size(); ++i) {
            const size_t j = (i + 1) % rim.size();
            cage_.face({rim[i], rim[j], cuff[j], cuff[i]});
            cage_.face({cuff[i], cuff[j], end[j], end[i]});
        }
        cage_.face({end.begin(), end.end()});
    }

    /// Grows from the four points of `base`, around its edge; bends towards `inwards`.
    void add_finger(const Finger& finger, const V3d& root, V3d along, const V3d& inwards,
                    std::array<int, 4> base) {
        const V3d aside = inwards.cross(along).normalized();
        V3d in = along.cross(aside).normalized();
        const double closed = .5 - .5 * std::cos(kBeat * time_ + 1.1 - finger.lag);
        V3d joint = root;
        std::array<int, 4> ring = base;
        const auto grow = [&](const V3d& middle, double size, const V3d& color) {
            std::array<int, 4> next{};
            static constexpr std::array<std::array<int, 2>, 4> kCorners = {
                {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
            for (size_t i = 0; i < 4; ++i)
                next[i] = cage_.add(middle + kCorners[i][0] * size * finger.width * aside +
                                        kCorners[i][1] * size * finger.depth * in,
                                    color);
            for (size_t i = 0; i < 4; ++i) {
                const size_t j = (i + 1) % 4;
                cage_.face({ring[j], ring[i], next[i], next[j]});
            }
            ring = next;
        };
        for (size_t bone = 0; bone < 3; ++bone) {
            const double bend = finger.most_bend * closed * (bone == 0 ? .8 : 1) + .06,
                         size = 1.18 - .1 * static_cast<double>(bone);
            const V3d bent = std::cos(bend) * along + std::sin(bend) * in;
            in = std::cos(bend) * in - std::sin(bend) * along, along = bent;
            const V3d color = kSkin + (kTip - kSkin) * (.34 * static_cast<double>(bone + 1));
            // Thicker at joints than between them.
            for (const auto& [part, wide] : {std::pair(.2, 1.0), {.5, .94}, {.86, 1.0}})
                grow(joint + part * finger.lengths[bone] * along, size * wide, color);
            joint += finger.lengths[bone] * along;
        }
        grow(joint, .8, kTip);
        grow(joint + .05 * along, .4, kTip);
        cage_.face({ring[3], ring[2], ring[1], ring[0]});
    }

    double time_;
    Cage cage_;
};

void write_hand_world(RibWriter& rib, const SceneParameters& p) {
    rib.request("LightSource", "ambientlight", 1, "intensity", Numbers{.22}, "lightcolor",
                Numbers{.75, .85, 1});
    rib.request("LightSource", "distantlight", 2, "intensity", Numbers{.85}, "lightcolor",
                Numbers{1, .94, .86}, "from", Numbers{-.8, .7, -.8}, "to", Numbers{0, 0, 0});
    rib.request("LightSource", "distantlight", 3, "intensity", Numbers{.4}, "lightcolor", Numbers{.5, .7, 1},
                "from", Numbers{1, .1, .1}, "to", Numbers{0, 0, 0});
    {
        const auto wall = rib.block("Attribute");
        rib.request("Surface", "constant");
        const V3d low(.10, .12, .14), high(.26, .30, .33);
        rib.request("Patch", "bilinear", "P",
                    flattened(std::array{V3d(-12, -8, 14), V3d(12, -8, 14), V3d(-12, 8, 14), V3d(12, 8, 14)}),
                    "varying color Cs", flattened(std::array{low, low, high, high}));
    }
    rib.request("Surface", "plastic", "Kd", Numbers{.8}, "Ks", Numbers{.18}, "roughness", Numbers{.2});
    rib.request("Translate", -.2, -1.45, 7);
    write_moving(rib, "Rotate", {-8, 0, 0, 1}, {kWristSwing, 0, 0, 0}, p);
    write_moving(rib, "Rotate", {-28, 0, 1, 0}, {0, 0, 0, 0}, p);
    rib.request("Scale", 1.5, 1.5, 1.5);
    write_moving_cage(
        rib, [](double time) { return Hand(time).take(); }, kHandShutter, p);
}

}  // namespace

std::string hand_scene(const SceneParameters& p) {
    Shot shot;
    shot.name = "hand";
    shot.comments = {"A hand closes and opens: one skin over bending joints.",
                     "Right: palm and wrist are nearly sharp, finger tips are blurred; it has no seam."};
    shot.fov = 40;
    shot.f_stop = 2.8, shot.focal_length = .2, shot.focal_distance = 7;
    shot.shading_rate = kHandShadingRate / p.scale;
    return scene_of(shot, write_hand_world, p);
}

}  // namespace trapeze::scenes
