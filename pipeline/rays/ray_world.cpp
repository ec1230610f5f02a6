#include "pipeline/rays/ray_world.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/rays/make_all_grids.h"
#include "pipeline/rays/whole_ray_grids.h"

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

/// Distances along a ray of unit length become depths along its largest axis.
float depth_scale(const V3f& direction) {
    return std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
}

/// The share of a render's memory that what rays meet may take, besides the lists of subpatches.
constexpr double kRayShare = 0.5;
/// The share of that which is for grids; the rest is for trees over them.
constexpr double kGridShare = 0.8;

}  // namespace

RayWorld::RayWorld(const RenderContext& context, const Shading& shading, size_t most_bytes)
    : dicer_(context, shading, most_bytes) {
    if (const Scene& scene = *dicer_.context().scene; !scene.solids.empty()) solids_.emplace(scene);
    make_groups(static_cast<size_t>(kRayShare * static_cast<double>(most_bytes)));
}

RayWorld::~RayWorld() = default;

/// Sorts what all rays may meet by the kinds of rays that see it.
void RayWorld::make_groups(size_t most_bytes) {
    const auto most_of_grids = static_cast<size_t>(kGridShare * static_cast<double>(most_bytes));
    AllRayGrids all = make_all_grids(dicer_, most_of_grids);
    if (dicer_.context().is_cancelled()) return;
    arenas_ = std::move(all.arenas);
    std::array<Grids, kMasks> grids;
    std::array<std::vector<SubpatchExtent>, kMasks> extents;
    std::array<size_t, kMasks> bytes{};
    for (size_t i = 0; i < dicer_.tessellation().subpatches().size(); ++i) {
        const SubpatchInfo& info = dicer_.tessellation().subpatches()[i];
        const unsigned mask = mask_of(dicer_.attributes(info.primitive).rays);
        micropolygons_ += info.shape.micropolygon_count();
        if (all.are_kept)
            grids[mask].grids.push_back(all.grids[i]);
        else
            extents[mask].push_back(all.extents[i]), bytes[mask] += all.extents[i].bytes;
    }
    const size_t all_bytes = std::accumulate(bytes.begin(), bytes.end(), size_t{0});
    for (unsigned mask = 0; mask < kMasks; ++mask) {
        Group& group = groups_[mask];
        if (!grids[mask].grids.empty()) group.grids = std::make_unique<WholeRayGrids>(std::move(grids[mask]));
        if (extents[mask].empty()) continue;
        const double share = static_cast<double>(bytes[mask]) / static_cast<double>(all_bytes);
        auto bricks = std::make_unique<RayBricks>(
            dicer_, std::move(extents[mask]), static_cast<size_t>(share * static_cast<double>(most_bytes)));
        group.bricks = bricks.get();
        group.grids = std::move(bricks);
    }
}

bool RayWorld::has(RayKind kind) const {
    for (unsigned mask = 0; mask < kMasks; ++mask)
        if (sees(kind, mask) && groups_[mask].grids) return true;
    return false;
}

size_t RayWorld::bytes() const {
    size_t bytes = 0;
    for (const GridArena& arena : arenas_) bytes += arena.bytes();
    for (const Group& group : groups_) bytes += group.grids ? group.grids->bytes() : 0;
    return bytes;
}

uint64_t RayWorld::micropolygons_made() const {
    uint64_t count = micropolygons_;
    for (const Group& group : groups_) count += group.bricks ? group.bricks->micropolygons_made() : 0;
    return count;
}

std::optional<RaySurfaceHit> RayWorld::closest(const RaySegment& ray, RayKind kind) const {
    std::optional<RaySurfaceHit> hit = closest_of_all(ray, kind);
    if (!hit || !solids_ || !solids_->has(hit->primitive)) return hit;
    return solids_->nearest(ray, [&](const RaySegment& rest) { return closest_of_all(rest, kind); });
}

std::optional<RaySurfaceHit> RayWorld::closest_of_all(const RaySegment& ray, RayKind kind) const {
    std::optional<RaySurfaceHit> nearest;
    RaySegment rest = ray;
    for (uint32_t mask = 0; mask < kMasks; ++mask) {
        if (!sees(kind, mask) || !groups_[mask].grids) continue;
        const std::optional<RaySurfaceHit> hit = closest_in(*groups_[mask].grids, rest);
        if (!hit || (nearest && hit->distance >= nearest->distance)) continue;
        nearest = hit;
        rest.max = hit->distance;
    }
    return nearest;
}

std::optional<RaySurfaceHit> RayWorld::closest_in(const RayGrids& grids, const RaySegment& ray) const {
    const float scale = depth_scale(ray.direction);
    const SpaceRay space{ray.origin, ray.direction, ray.time};
    DepthRange range{ray.min * scale, ray.max * scale};
    while (range.min <= range.max) {
        const std::optional<RayGridHit> found = grids.closest(space, range);
        if (!found) return {};
        if (shows(*found->grid, MicropolygonId::unpack(found->hit.id), ray))
            return hit_of(ray, found->hit.depth / scale, *found);
        range.min = std::nextafter(found->hit.depth, kInfinity);
    }
    return {};
}

/// Whether a ray comes to a micropolygon from the outside of its surface.
bool RayWorld::from_outside(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const {
    const Attributes& attributes = dicer_.attributes(grid.primitive);
    const auto corner = [&](int i, int j) { return grid.vertex(id.u + i, id.v + j, ray.time); };
    const V3f p00 = corner(0, 0), p11 = corner(1, 1), p10 = corner(1, 0), p01 = corner(0, 1);
    const V3f normal = (p11 - p00).cross(p01 - p10) * (attributes.reverse_orientation ? -1.0f : 1.0f);
    return normal.dot(ray.direction) <= 0;
}

/// Whether a micropolygon's hit counts: one-sided surfaces have no inside, and a ray may want groups or sides
/// of its own choice.
bool RayWorld::shows(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const {
    using Sides = RayFilter::Sides;
    if (solids_ && solids_->has(grid.primitive)) return true;  // the whole solid has sides
    const Attributes& attributes = dicer_.attributes(grid.primitive);
    if (ray.only && !ray.only->subset.has(attributes.rays.groups)) return false;
    Sides sides = ray.only ? ray.only->sides : Sides::OfAttributes;
    if (sides == Sides::OfAttributes) sides = attributes.sides == 1 ? Sides::Front : Sides::Both;
    if (sides == Sides::Both) return true;
    return from_outside(grid, id, ray) == (sides == Sides::Front);
}

RaySurfaceHit RayWorld::hit_of(const RaySegment& ray, float distance, const RayGridHit& found) const {
    const MicropolygonId id = MicropolygonId::unpack(found.hit.id);
    const Grid& grid = *found.grid;
    const TurnedRay turned = axis_ray({ray.origin, ray.direction, ray.time});
    const QuadWeights weights = hit_weights(
        turned.ray, grid.quad(id.u, id.v, ray.time, turned.x_plane, turned.y_plane, turned.z_plane));
    RaySurfaceHit hit;
    hit.distance = distance;
    hit.primitive = grid.primitive;
    hit.attributes = &dicer_.attributes(grid.primitive).rays;
    hit.from_outside = from_outside(grid, id, ray);
    hit.keeps_opacity = dicer_.keeps_opacity(grid.primitive);
    hit.color = hit.opacity = V3f(0, 0, 0);
    for (int corner = 0; corner < 4; ++corner) {
        const int i = id.u + (corner & 1), j = id.v + (corner >> 1);
        hit.color += weights.w[corner] * grid.color(i, j);
        hit.opacity += weights.w[corner] * grid.opacity(i, j);
    }
    hit.id = found.hit.id;
    hit.at = {weights.w[k10] + weights.w[k11], weights.w[k01] + weights.w[k11]};
    return hit;
}

std::optional<bool> RayWorld::blocked(const RaySegment& ray, RayKind kind) const {
    const float scale = depth_scale(ray.direction);
    const DepthRange range{ray.min * scale, ray.max * scale};
    bool sure = true;
    for (uint32_t mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.grids) continue;
        const InTheWay met = group.grids->in_the_way({ray.origin, ray.direction, ray.time}, range);
        if (met == InTheWay::Opaque && !ray.only) return true;
        sure &= met == InTheWay::Nothing;
    }
    return sure ? std::optional(false) : std::nullopt;
}

int RayWorld::dice(const RaySurfaceHit& hit, ShadingGrid& grid) const {
    const MicropolygonId id = MicropolygonId::unpack(hit.id);
    const GridShape shape = dicer_.tessellation().subpatches()[id.grid].shape;
    const V2f at((static_cast<float>(id.u) + hit.at.x) / static_cast<float>(shape.nu),
                 (static_cast<float>(id.v) + hit.at.y) / static_cast<float>(shape.nv));
    return dicer_.make_point({id.grid, at}, grid);
}

/// A pixel's side at the point's distance from the eye.
float RayWorld::spacing(const V3f& P) const {
    const Camera& camera = dicer_.context().camera;
    const float pixel = std::max(std::abs(camera.plane_scale_x), std::abs(camera.plane_scale_y));
    return camera.perspective ? P.length() * pixel : pixel;
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
    return world;
}

}  // namespace trapeze
