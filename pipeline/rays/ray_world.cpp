#include "pipeline/rays/ray_world.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// Bits of the kinds of rays that see a primitive.
unsigned mask_of(const RayAttributes& rays) {
    const auto bit = [](RayKind kind) { return 1u << static_cast<unsigned>(kind); };
    return (rays.diffuse ? bit(RayKind::Diffuse) : 0) | (rays.specular ? bit(RayKind::Specular) : 0) |
           (rays.transmission ? bit(RayKind::Transmission) : 0);
}

bool sees(RayKind kind, unsigned mask) {
    return (mask >> static_cast<unsigned>(kind) & 1) != 0;
}

RenderContext at_shutter_open(const RenderContext& context) {
    RenderContext still = context;
    still.motion = false;
    return still;
}

/// Distances along a ray of unit length become depths along its largest axis.
float depth_scale(const V3f& direction) {
    return std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
}

/// What a thread needs to make grids.
struct Maker {
    ShadingGrid shading_grid;
    DiceScratch dice;
    ShadeScratch shade;
    GridArena arena;
};

constexpr size_t kGrain = 16;

}  // namespace

struct RayWorld::DiceScratches {
    tbb::enumerable_thread_specific<DiceScratch> of_thread;
};

RayWorld::RayWorld(const RenderContext& context, const Shading& shading, size_t most_bytes)
    : context_(at_shutter_open(context)),
      tessellation_(context_, shading.depth_heights(), most_bytes, shading.displacing_surfaces(),
                    SeenBy::Rays),
      scratches_(std::make_unique<DiceScratches>()) {
    make_grids(shading);
    for (Group& group : groups_)
        if (!group.grids.grids.empty()) group.tree = std::make_unique<WideTree>(group.grids, RayReach());
}

RayWorld::~RayWorld() = default;

/// Dices, displaces and packs all subpatches; grids stay in their order.
void RayWorld::make_grids(const Shading& shading) {
    const std::vector<SubpatchInfo>& subpatches = tessellation_.subpatches();
    const Scene& scene = *context_.scene;
    for (uint32_t i = 0; i < scene.primitives.size(); ++i) keeps_opacity_.push_back(shading.keeps_opacity(i));
    std::vector<Grid> grids(subpatches.size());
    tbb::enumerable_thread_specific<Maker> makers;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, subpatches.size(), kGrain),
                      [&](const tbb::blocked_range<size_t>& range) {
                          Maker& maker = makers.local();
                          for (size_t i = range.begin(); i < range.end() && !context_.is_cancelled(); ++i) {
                              ShadingGrid* const grid = &maker.shading_grid;
                              tessellation_.dice(i, *grid, maker.dice);
                              grid->aovs.clear();
                              shading.displace({&grid, 1}, maker.shade);
                              PackOptions options;
                              options.both_sides = true;
                              options.float_colors = context_.float_colors;
                              options.keep_hits_behind = !keeps_opacity_[grid->primitive_index];
                              int64_t not_finite = 0;
                              grids[i] = pack_grid(*grid, maker.arena, &not_finite, options);
                          }
                      });
    if (context_.is_cancelled()) return;
    for (const Grid& grid : grids) {
        const Attributes& attributes = *scene.primitives[grid.primitive].attributes;
        Group& group = groups_[mask_of(attributes.rays)];
        group.grids.grids.push_back(grid);
        group.hides &= grid.opaque && attributes.sides == 2;
    }
    // Each group keeps its grids' memory by way of the first.
    for (Maker& maker : makers) groups_[0].grids.arenas.push_back(std::move(maker.arena));
}

bool RayWorld::has(RayKind kind) const {
    for (unsigned mask = 0; mask < kMasks; ++mask)
        if (sees(kind, mask) && groups_[mask].tree) return true;
    return false;
}

size_t RayWorld::bytes() const {
    size_t bytes = tessellation_.bytes();
    for (const Group& group : groups_) {
        for (const GridArena& arena : group.grids.arenas) bytes += arena.bytes();
        if (group.tree) bytes += group.tree->stats().tree_bytes;
    }
    return bytes;
}

uint64_t RayWorld::micropolygon_count() const {
    uint64_t count = 0;
    for (const Group& group : groups_) count += group.grids.micropolygon_count();
    return count;
}

std::optional<RaySurfaceHit> RayWorld::closest(const RaySegment& ray, RayKind kind) const {
    std::optional<RaySurfaceHit> nearest;
    RaySegment rest = ray;
    for (uint32_t mask = 0; mask < kMasks; ++mask) {
        if (!sees(kind, mask) || !groups_[mask].tree) continue;
        const std::optional<RaySurfaceHit> hit = closest_in(mask, rest);
        if (!hit || (nearest && hit->distance >= nearest->distance)) continue;
        nearest = hit;
        rest.max = hit->distance;
    }
    return nearest;
}

std::optional<RaySurfaceHit> RayWorld::closest_in(uint32_t group, const RaySegment& ray) const {
    const float scale = depth_scale(ray.direction);
    const SpaceRay space{ray.origin, ray.direction, 0};
    DepthRange range{ray.min * scale, ray.max * scale};
    while (range.min <= range.max) {
        const std::optional<Hit> hit = groups_[group].tree->closest(space, range);
        if (!hit) return {};
        const MicropolygonId id = MicropolygonId::unpack(hit->id);
        if (shows(groups_[group].grids.grids[id.grid], id, ray.direction))
            return hit_of(group, ray, hit->depth / scale, hit->id);
        range.min = std::nextafter(hit->depth, kInfinity);
    }
    return {};
}

/// Whether a micropolygon can be hit from this side: one-sided surfaces have no inside.
bool RayWorld::shows(const Grid& grid, const MicropolygonId& id, const V3f& direction) const {
    const Attributes& attributes = *context_.scene->primitives[grid.primitive].attributes;
    if (attributes.sides != 1) return true;
    const V3f p00 = grid.vertex(id.u, id.v, 0), p11 = grid.vertex(id.u + 1, id.v + 1, 0);
    const V3f p10 = grid.vertex(id.u + 1, id.v, 0), p01 = grid.vertex(id.u, id.v + 1, 0);
    const V3f normal = (p11 - p00).cross(p01 - p10) * (attributes.reverse_orientation ? -1.0f : 1.0f);
    return normal.dot(direction) <= 0;
}

RaySurfaceHit RayWorld::hit_of(uint32_t group, const RaySegment& ray, float distance, uint64_t packed) const {
    const MicropolygonId id = MicropolygonId::unpack(packed);
    const Grid& grid = groups_[group].grids.grids[id.grid];
    const TurnedRay turned = axis_ray({ray.origin, ray.direction, 0});
    const QuadWeights weights =
        hit_weights(turned.ray, grid.quad(id.u, id.v, 0, turned.x_plane, turned.y_plane, turned.z_plane));
    RaySurfaceHit hit;
    hit.distance = distance;
    hit.primitive = grid.primitive;
    hit.keeps_opacity = keeps_opacity_[grid.primitive];
    hit.color = hit.opacity = V3f(0, 0, 0);
    for (int corner = 0; corner < 4; ++corner) {
        const int i = id.u + (corner & 1), j = id.v + (corner >> 1);
        hit.color += weights.w[corner] * grid.color(i, j);
        hit.opacity += weights.w[corner] * grid.opacity(i, j);
    }
    hit.group = group, hit.id = packed;
    hit.at = {weights.w[k10] + weights.w[k11], weights.w[k01] + weights.w[k11]};
    return hit;
}

std::optional<bool> RayWorld::blocked(const RaySegment& ray, RayKind kind) const {
    const float scale = depth_scale(ray.direction);
    const DepthRange range{ray.min * scale, ray.max * scale};
    bool sure = true;
    for (uint32_t mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.tree) continue;
        if (!group.tree->any({ray.origin, ray.direction, 0}, range)) continue;
        if (group.hides) return true;
        sure = false;
    }
    return sure ? std::optional(false) : std::nullopt;
}

int RayWorld::dice(const RaySurfaceHit& hit, ShadingGrid& grid) const {
    const MicropolygonId id = MicropolygonId::unpack(hit.id);
    const Grid& packed = groups_[hit.group].grids.grids[id.grid];
    const V2f at((static_cast<float>(id.u) + hit.at.x) / static_cast<float>(packed.shape.nu),
                 (static_cast<float>(id.v) + hit.at.y) / static_cast<float>(packed.shape.nv));
    return tessellation_.dice_point({packed.ordinal, at}, grid, scratches_->of_thread.local());
}

/// A pixel's side at the point's distance from the eye.
float RayWorld::spacing(const V3f& P) const {
    const float pixel =
        std::max(std::abs(context_.camera.plane_scale_x), std::abs(context_.camera.plane_scale_y));
    return context_.camera.perspective ? P.length() * pixel : pixel;
}

std::unique_ptr<RayWorld> make_ray_world(const RenderContext& context, const Shading& shading,
                                         size_t most_bytes) {
    if (!shading.asks_rays()) return {};
    auto world = std::make_unique<RayWorld>(context, shading, most_bytes);
    const bool empty =
        !world->has(RayKind::Diffuse) && !world->has(RayKind::Specular) && !world->has(RayKind::Transmission);
    if (empty && context.diagnostics && !context.is_cancelled())
        context.diagnostics->warning(
            {},
            "shaders trace rays, but no primitive is seen by rays; Attribute \"visibility\" \"int diffuse\" 1, "
            "\"int specular\" 1 and \"int transmission\" 1 let them be seen",
            "nothing-for-rays");
    if (world->bytes() > most_bytes && context.diagnostics)
        context.diagnostics->warning({},
                                     "what rays may meet takes " + std::to_string(world->bytes() >> 20) +
                                         " MiB, more than the budget of " + std::to_string(most_bytes >> 20) +
                                         " MiB",
                                     "memory-budget");
    return world;
}

}  // namespace trapeze
