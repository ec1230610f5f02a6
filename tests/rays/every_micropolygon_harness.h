/// What rays of shaders find in a scene where every micropolygon is tested against every ray: the same grids
/// as a RayWorld's, without its trees, bricks and order.
#pragma once

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "core/hit_micropolygon.h"
#include "pipeline/rays/level_spans.h"
#include "pipeline/rays/make_all_grids.h"
#include "pipeline/rays/placed_ray.h"
#include "pipeline/rays/ray_dicer.h"
#include "tests/rays/ray_world_harness.h"

namespace trapeze::testing {

/// A hit, ordered as rays find them: equally near ones by the primitive that comes first.
struct FoundHit {
    float distance = 0;
    uint32_t primitive = 0;
    uint64_t id = 0;
    uint8_t level = 0;
};

/// Of scenes without solids, where no shader changes opacities.
class EveryMicropolygon {
  public:
    explicit EveryMicropolygon(const RayWorldScene& scene) : rule_(scene.context().camera, {0}) {
        levels_.push_back(std::make_unique<Level>(0, scene));
        std::vector<int> numbers{0};
        for (int number = 1; number < scene.scene().options.ray_levels; ++number) {
            auto level = std::make_unique<Level>(number, levels_.front()->dicer);
            if (2 * level->count() > levels_.back()->count()) continue;  // it is not worth while
            numbers.push_back(number);
            levels_.push_back(std::move(level));
        }
        rule_ = LevelRule(scene.context().camera, numbers);
    }

    struct Answer {
        std::optional<FoundHit> closest;
        /// Nothing: what is in the way may let some light through, or not count.
        std::optional<bool> blocked;
    };

    Answer answer(const RaySegment& ray, RayKind kind) const {
        Answer answer;
        bool is_opaque = false, is_met = false;
        for_each_part(ray, [&](const Level& level, const RaySegment& part) {
            std::optional<FoundHit> nearest;
            for_each_space(level, part, [&](const PlacedRay& placed) {
                Hit first{kInfinity, MicropolygonId::kNone};  // of the space
                uint32_t primitive = 0;
                for_each_hit(level, part, placed, kind, [&](const Hit& hit, const Met& met) {
                    is_met = true;
                    is_opaque |= met.attributes->opacity == V3f(1, 1, 1) && met.attributes->sides == 2 &&
                                 hit.depth >= part.left.most * placed.scale;
                    if (in_front(hit, first) && counts(part, placed, hit, met))
                        first = hit, primitive = met.primitive;
                });
                const float distance = first.depth / placed.scale;
                if (first.depth < kInfinity &&
                    (!nearest ||
                     std::tuple(distance, primitive) < std::tuple(nearest->distance, nearest->primitive)))
                    nearest = {distance, primitive, first.id, static_cast<uint8_t>(level.number)};
            });
            // Parts overlap: of hits that are equally near the finer level's is found.
            if (nearest && (!answer.closest || nearest->distance < answer.closest->distance))
                answer.closest = nearest;
        });
        if (is_opaque)
            answer.blocked = true;
        else if (!is_met)
            answer.blocked = false;
        return answer;
    }

    size_t places() const { return levels_.front()->dicer.shared().places.size(); }
    uint64_t micropolygons() const {
        uint64_t count = 0;
        for (const auto& level : levels_) count += level->count();
        return count;
    }
    /// A vertex of some grid of camera space.
    V3f some_vertex(RayNumbers& number, float time) const {
        const Grid& grid = some_grid(number);
        return grid.vertex(below(grid.shape.vertices_u(), number), below(grid.shape.vertices_v(), number),
                           time);
    }
    /// A point of a side of some grid: a vertex, or between two.
    V3f some_border(RayNumbers& number, float time) const {
        const Grid& grid = some_grid(number);
        const int nu = grid.shape.nu, nv = grid.shape.nv;
        const bool along_u = below(2, number) == 0;
        const int i = along_u ? below(nu, number) : nu * below(2, number),
                  j = along_u ? nv * below(2, number) : below(nv, number);
        const V3f from = grid.vertex(i, j, time), to = grid.vertex(i + along_u, j + !along_u, time);
        return from + (to - from) * (below(3, number) == 0 ? 0.0f : number(0, 1));
    }

  private:
    struct Level {
        int number;
        RayDicer dicer;
        AllRayGrids all;

        Level(int n, const RayWorldScene& scene)
            : number(n),
              dicer(scene.context(), scene.shading(), kBytes),
              all(make_all_grids(dicer, kBytes)) {}
        Level(int n, const RayDicer& finest)
            : number(n), dicer(finest, RaySides{level_side(n)}, kBytes), all(make_all_grids(dicer, kBytes)) {}
        uint64_t count() const { return dicer.tessellation().stats().micropolygons; }
        int object_of(size_t grid) const {
            return dicer.shared().object_of(dicer.tessellation().subpatches()[grid].primitive);
        }
    };
    /// What a ray meets.
    struct Met {
        const Grid& grid;
        int u, v;
        uint32_t primitive;
        const Attributes* attributes;
    };

    static constexpr size_t kBytes = size_t{1} << 30;

    static int below(int count, RayNumbers& number) {
        return std::min(static_cast<int>(number(0, 1) * static_cast<float>(count)), count - 1);
    }
    const Grid& some_grid(RayNumbers& number) const {
        for (;;) {
            const Level& level =
                *levels_[static_cast<size_t>(below(static_cast<int>(levels_.size()), number))];
            const auto i = static_cast<size_t>(below(static_cast<int>(level.all.grids.size()), number));
            if (level.object_of(i) < 0) return level.all.grids[i];
        }
    }

    static bool sees(RayKind kind, const RayAttributes& rays) {
        return kind == RayKind::Diffuse    ? rays.diffuse
               : kind == RayKind::Specular ? rays.specular
                                           : rays.transmission;
    }

    template <class See>
    void for_each_part(const RaySegment& ray, const See& see) const {
        RaySegment part = ray;
        for (const LevelSpan& span : rule_.of(ray)) {
            part.min = span.min, part.max = span.max;
            for (const auto& level : levels_)
                if (level->number == span.level) see(*level, part);
        }
    }
    /// Camera space, and that of each instance of a shared object.
    template <class See>
    static void for_each_space(const Level& level, const RaySegment& ray, const See& see) {
        see(PlacedRay(ray));
        for (const ObjectPlace& place : level.dicer.shared().places) see(PlacedRay(ray, place));
    }

    template <class See>
    static void for_each_hit(const Level& level, const RaySegment& ray, const PlacedRay& placed, RayKind kind,
                             const See& see) {
        const int object = placed.place ? static_cast<int>(placed.place->object) : -1;
        const DepthRange range = placed.ranged(ray).range;
        const TurnedRay turned = axis_ray(placed.space);
        for (size_t i = 0; i < level.all.grids.size(); ++i) {
            if (level.object_of(i) != object) continue;
            const Grid& grid = level.all.grids[i];
            const uint32_t primitive = placed.place
                                           ? level.dicer.shared().primitive_at(*placed.place, grid.primitive)
                                           : grid.primitive;
            const Attributes& attributes = level.dicer.attributes(primitive);
            if (!sees(kind, attributes.rays)) continue;
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u) {
                    const Quad quad =
                        grid.quad(u, v, placed.space.time, turned.x_plane, turned.y_plane, turned.z_plane);
                    float z;
                    if (!hit_micropolygon(turned.ray, quad, Facing::Both, &z)) continue;
                    const float depth = (z - turned.ray.oz) * turned.depth_sign;
                    if (!(depth >= range.min && depth <= range.max)) continue;
                    const MicropolygonId id{static_cast<uint32_t>(i), static_cast<uint8_t>(u),
                                            static_cast<uint8_t>(v)};
                    see(Hit{depth, id.packed()}, Met{grid, u, v, primitive, &attributes});
                }
        }
    }

    /// Not what the ray leaves, nor the inside of what has one side.
    static bool counts(const RaySegment& ray, const PlacedRay& placed, const Hit& hit, const Met& met) {
        V3d at[4];
        bool is_left = hit.depth >= ray.left.most * placed.scale;
        for (int k = 0; k < 4; ++k) {
            const float time = placed.space.time;
            const V3f P = placed.to_camera(met.grid.vertex(met.u + (k & 1), met.v + (k >> 1), time), time);
            is_left |= ray.left.is_left(P - ray.origin, ray.direction);
            at[k] = V3d(P);
        }
        if (!is_left || met.attributes->sides == 2) return is_left;
        const double along = (at[3] - at[0]).cross(at[2] - at[1]).dot(V3d(ray.direction));
        return (met.attributes->reverse_orientation ? -along : along) <= 0;
    }

    std::vector<std::unique_ptr<Level>> levels_;
    LevelRule rule_;
};

}  // namespace trapeze::testing
