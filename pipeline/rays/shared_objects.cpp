#include "pipeline/rays/shared_objects.h"

#include <Imath/ImathBoxAlgo.h>
#include <Imath/ImathMatrixAlgo.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "core/scene/level_of_detail.h"
#include "pipeline/rays/level_spans.h"

namespace trapeze {
namespace {

/// Fewer instances have grids of their own: a ray that passes through a space costs more than one that does
/// not.
constexpr size_t kFewInstances = 4;
/// So do objects of fewer micropolygons.
constexpr double kFewMicropolygons = 64;
/// The most that a space may stretch one direction more than another: dicing is finer there by as much.
constexpr double kMostStretch = 3;
/// Nearer to the eye than so many radii, one side of an object is diced much more finely than the other.
constexpr double kRadiiAway = 3;

/// What of a primitive its grids for rays are made of. Numbers as bits, so that keys have an order.
struct PartKey {
    const Shape* shape;
    std::array<uint32_t, 5> numbers;
    std::array<int, 8> choices;

    auto operator<=>(const PartKey&) const = default;
};

/// Instances that may share grids: of one object, seen in much the same size.
struct ObjectKey {
    int size;  ///< a pixel's side there is between 2^size and 2^(size + 1) of the object's
    std::vector<PartKey> parts;

    auto operator<=>(const ObjectKey&) const = default;
};

/// A ball about all of an object, about.
struct Ball {
    V3d center{0, 0, 0};
    double radius = 0;
};

void extend(Imath::Box3d& box, const Quadric& quadric) {
    double most = 0;
    for (int i = 0; i + 1 < quadric.value_count; ++i)
        // Angles of a torus' tube are no lengths.
        if (quadric.kind != Quadric::Kind::Torus || i < 2)
            most = std::max(most, std::abs(double{quadric.values[static_cast<size_t>(i)]}));
    if (quadric.kind == Quadric::Kind::Torus)
        most = std::abs(quadric.values[0]) + std::abs(quadric.values[1]);
    box.extendBy(V3d(-most)), box.extendBy(V3d(most));
}

/// Around control points: near enough to where the surface is for what is asked of it.
Imath::Box3d box_around(const Shape& shape) {
    Imath::Box3d box;
    if (const auto* quadric = std::get_if<Quadric>(&shape.topology)) extend(box, *quadric);
    for (const Parameter& value : shape.variables.values) {
        const size_t size = value.name == "P" ? 3 : value.name == "Pw" ? 4 : 0;
        for (size_t i = 0; size > 0 && i + size <= value.floats.size(); i += size) {
            const float* const p = value.floats.data() + i;
            const double w = size == 4 && p[3] != 0 ? p[3] : 1;
            box.extendBy(V3d(p[0] / w, p[1] / w, p[2] / w));
        }
    }
    return box;
}

/// The farthest that a box reaches from the origin along an axis.
double farthest(const Imath::Box3d& box) {
    if (box.isEmpty()) return 0;
    double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max({most, std::abs(box.min[k]), std::abs(box.max[k])});
    return most;
}

/// Whether two spaces put what is within a radius around their origin in the same place but for rounding.
bool is_near(const M44d& a, const M44d& b, double radius) {
    constexpr double kSame = 0x1p-21;  // of the largest coordinate
    const auto reach = [&](const auto& element) {
        double most = 0;
        for (int j = 0; j < 3; ++j)
            most = std::max(
                most, std::abs(element(3, j)) + radius * (std::abs(element(0, j)) + std::abs(element(1, j)) +
                                                          std::abs(element(2, j))));
        return most;
    };
    return reach([&](int i, int j) { return a[i][j] - b[i][j]; }) <=
           kSame * reach([&](int i, int j) { return b[i][j]; });
}

/// How much longer a space makes things: at most (x) to at least (z).
V3d stretch_of(const M44f& space) {
    const Imath::M33d linear(space[0][0], space[0][1], space[0][2], space[1][0], space[1][1], space[1][2],
                             space[2][0], space[2][1], space[2][2]);
    Imath::M33d u, v;
    V3d stretch;
    Imath::jacobiSVD(linear, u, stretch, v);
    return stretch;
}

bool is_even(const V3d& stretch) {
    return stretch.z > 0 && stretch.x <= kMostStretch * stretch.z;
}

/// Surfaces are placed without a division.
bool is_affine(const M44f& m) {
    return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
}

class Sharing {
  public:
    Sharing(const Scene& scene, const Camera& camera, bool moves, const WhatRaysMeet& what)
        : scene_(scene), camera_(camera), rule_(camera, {0}), moves_(moves), what_(what) {}

    /// Keys are in no order that means anything: objects come in that of their first instances. Objects of
    /// the same shapes in other places have the same key.
    SharedObjects run() {
        result_.is_shared.resize(scene_.primitives.size());
        group_instances();
        std::map<uint32_t, Groups::value_type*> by_first;
        for (Groups::value_type& group : groups_) by_first[group.second.front()] = &group;
        for (auto& [first, group] : by_first) share_by_layout(group->first, group->second);
        return std::move(result_);
    }

  private:
    /// First primitives of instances.
    using Groups = std::map<ObjectKey, std::vector<uint32_t>>;

    /// Layouts of one key that are looked for; what is of others is not shared.
    static constexpr int kMostLayouts = 64;

    void share_by_layout(const ObjectKey& key, std::vector<uint32_t>& firsts) {
        for (int layout = 0; layout < kMostLayouts && firsts.size() >= kFewInstances; ++layout) {
            const auto others = std::stable_partition(firsts.begin(), firsts.end(), [&](uint32_t first) {
                return first == firsts.front() || is_laid_out_as(first, firsts.front(), key.parts.size());
            });
            if (static_cast<size_t>(others - firsts.begin()) >= kFewInstances)
                share(key, {firsts.begin(), others});
            firsts.erase(firsts.begin(), others);
        }
    }

    const Primitive& primitive(uint32_t number) const { return scene_.primitives[number]; }

    std::span<const M44f> poses(uint32_t number) const {
        const std::span<const M44f> all = primitive(number).camera_from_object;
        return moves_ ? all : all.first(1);
    }

    void group_instances() {
        const auto count = static_cast<uint32_t>(scene_.primitives.size());
        for (uint32_t first = 0, end; first < count; first = end) {
            end = first + 1;
            const int instance = primitive(first).instance;
            if (instance < 0) continue;
            while (end < count && primitive(end).instance == instance) ++end;
            if (const std::optional<ObjectKey> key = key_of(first, end)) groups_[*key].push_back(first);
        }
    }

    /// Nothing where an instance shares nothing.
    std::optional<ObjectKey> key_of(uint32_t first, uint32_t end) {
        ObjectKey key;
        bool is_seen = false;
        for (uint32_t i = first; i < end; ++i) {
            const std::optional<PartKey> part = part_of(i);
            if (!part || poses(i).size() != poses(first).size()) return {};
            key.parts.push_back(*part);
            is_seen |= primitive(i).attributes->rays.seen();
        }
        if (!is_seen || !is_laid_out_as(first, first, key.parts.size())) return {};
        const std::optional<int> size = size_of(first, end);
        if (!size) return {};
        key.size = *size;
        return key;
    }

    std::optional<PartKey> part_of(uint32_t number) const {
        const Primitive& p = primitive(number);
        const Attributes& a = *p.attributes;
        const bool bends = p.shape_keys.size() > 1 || depends_on_view(p.shape().topology);
        const bool is_displaced = a.rays.displaced && (a.displacement || what_.is_displaced(number));
        // The rate would depend on how the instance moves.
        const bool is_blurred = a.motion_factor != 0 || a.focus_factor != 0;
        if (bends || is_displaced || is_blurred || p.solid >= 0) return {};
        const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
        return PartKey{p.shape_keys.front().get(),
                       {bits(a.opacity.x), bits(a.opacity.y), bits(a.opacity.z), bits(a.shading_rate),
                        bits(a.dice.min_length)},
                       {a.sides, a.dice.binary, a.dice.raster_oriented, a.rays.diffuse, a.rays.specular,
                        a.rays.transmission, what_.keeps_opacity(number), seen_numbers(a).are_all()}};
    }

    /// Whether all primitives of an instance are beside its first one, at all times, where those of another
    /// one are at shutter open: nearer than what a ray's beginning makes up for.
    bool is_laid_out_as(uint32_t first, uint32_t other_first, size_t count) {
        const M44d other_from_camera = M44d(primitive(other_first).camera_from_object.front()).inverse();
        for (uint32_t i = 0; i < count; ++i) {
            const M44d beside =
                i == 0 ? M44d()
                       : M44d(primitive(other_first + i).camera_from_object.front()) * other_from_camera;
            const double radius = farthest(box_of(primitive(first + i).shape_keys.front()));
            for (size_t key = 0; key < poses(first).size() && i > 0; ++key)
                if (!is_near(beside * M44d(poses(first)[key]), M44d(poses(first + i)[key]), radius))
                    return false;
        }
        return true;
    }

    /// Around control points; shapes are shared by many instances.
    const Imath::Box3d& box_of(const std::shared_ptr<const Shape>& shape) {
        const auto [at, is_new] = boxes_.try_emplace(shape.get());
        if (is_new) at->second = box_around(*shape);
        return at->second;
    }

    /// In the space of the first primitive.
    Ball ball_of(uint32_t first, uint32_t end) {
        const M44d first_from_camera = M44d(primitive(first).camera_from_object.front()).inverse();
        Imath::Box3d box;
        for (uint32_t i = first; i < end; ++i) {
            const Imath::Box3d& own = box_of(primitive(i).shape_keys.front());
            const M44d first_from_own =
                i == first ? M44d() : M44d(primitive(i).camera_from_object.front()) * first_from_camera;
            if (!own.isEmpty()) box.extendBy(Imath::transform(own, first_from_own));
        }
        if (box.isEmpty()) return {};
        return {box.center(), box.size().length() / 2};
    }

    /// ObjectKey::size, by what is there at shutter open; nothing where the instance had better have grids of
    /// its own.
    std::optional<int> size_of(uint32_t first, uint32_t end) {
        const M44d space(primitive(first).camera_from_object.front());
        for (uint32_t i = first; i < end; ++i)
            if (!std::ranges::all_of(poses(i), is_affine)) return {};
        // What turns inside out on its way has no inverse then.
        for (const M44f& pose : poses(first))
            if (!is_even(stretch_of(pose)) || (M44d(pose).determinant() < 0) != (space.determinant() < 0))
                return {};
        const double stretch = stretch_of(primitive(first).camera_from_object.front()).x;
        const Ball ball = ball_of(first, end);
        const double pixel = pixel_at_least(ball.center * space, ball.radius * stretch) / stretch;
        if (!(pixel > 0) || !(ball.radius > 0) || !std::isfinite(ball.radius / pixel)) return {};
        const int size = std::ilogb(pixel);
        const double side = std::ldexp(1.0, size);
        if (!model_space(ball, side, 1) || micropolygons(first, end, ball.radius / side) < kFewMicropolygons)
            return {};
        return size;
    }

    /// A pixel's side where it is smallest within a ball of camera space.
    double pixel_at_least(const V3d& center, double radius) const {
        const double unit = rule_.pixel(rule_.middle());
        return camera_.perspective ? unit * (center.length() - radius) : unit;
    }

    /// About, and rather too few: those of a ball, or one a vertex of the meshes.
    double micropolygons(uint32_t first, uint32_t end, double radius_in_sides) const {
        double vertices = 0;
        for (uint32_t i = first; i < end; ++i)
            vertices += variable_counts(primitive(i).shape().topology).vertex;
        return std::max(vertices, 4 * 3.14 * radius_in_sides * radius_in_sides);
    }

    /// A space in which an object is diced with sides of at most so much of its own: far away on the view's
    /// axis, scaled as asked, or in the middle of an orthographic picture. Nothing where that is too near.
    std::optional<M44d> model_space(const Ball& ball, double side, double perspective_scale) const {
        const double unit = rule_.pixel(rule_.middle());
        M44d space;
        space.setTranslation(-ball.center);
        if (camera_.perspective) {
            const double distance = side / unit - ball.radius;
            if (!(distance >= kRadiiAway * ball.radius)) return {};
            return space * M44d().setScale(perspective_scale) *
                   M44d().setTranslation(V3d(0, 0, perspective_scale * distance));
        }
        const double scale = unit / side;
        const auto edge = static_cast<float>(scale * ball.radius);
        if (rule_.pixel(rule_.middle() + V3f(edge, 0, 0)) > rule_.pixel(rule_.middle())) return {};
        return space * M44d().setScale(scale) * M44d().setTranslation(V3d(rule_.middle()));
    }

    void share(const ObjectKey& key, const std::vector<uint32_t>& firsts) {
        const uint32_t stands_for = firsts.front();
        const auto count = static_cast<uint32_t>(key.parts.size());
        const M44d first_from_camera = M44d(primitive(stands_for).camera_from_object.front()).inverse();
        // Scaled about as the instance is, so that coordinates are those of a camera's space.
        const double scale =
            std::ldexp(1.0, std::ilogb(stretch_of(primitive(stands_for).camera_from_object.front()).x));
        const M44d model_from_first =  // there is one: size_of() has looked
            model_space(ball_of(stands_for, stands_for + count), std::ldexp(1.0, key.size), scale).value();
        const auto object = static_cast<uint32_t>(result_.objects.size());
        result_.objects.push_back({static_cast<uint32_t>(result_.models.size()), stands_for, count});
        for (uint32_t i = 0; i < count; ++i) {
            Primitive model = primitive(stands_for + i);
            model.camera_from_object = {
                M44f(M44d(model.camera_from_object.front()) * first_from_camera * model_from_first)};
            model.emitter.reset();
            result_.models.push_back(std::move(model));
            result_.object_of_model.push_back(object);
        }
        const M44d first_from_model = model_from_first.inverse();
        for (const uint32_t first : firsts) {
            ObjectPlace place{object, first, {}};
            for (const M44f& pose : poses(first))
                place.camera_from_shared.emplace_back(first_from_model * M44d(pose));
            place.shared_from_camera = ObjectPlace::inverse(place.camera_from_shared.front());
            result_.places.push_back(std::move(place));
            for (uint32_t i = 0; i < count; ++i) result_.is_shared[first + i] = true;
        }
    }

    const Scene& scene_;
    const Camera& camera_;
    const LevelRule rule_;
    const bool moves_;
    const WhatRaysMeet& what_;
    Groups groups_;
    std::map<const Shape*, Imath::Box3d> boxes_;
    SharedObjects result_;
};

}  // namespace

SharedObjects share_objects(const Scene& scene, const Camera& camera, bool moves, const WhatRaysMeet& what) {
    return Sharing(scene, camera, moves, what).run();
}

}  // namespace trapeze
