#include "pipeline/rays/ray_level.h"

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

/// A segment in the form in which grids are asked.
RangedRay ranged(const RaySegment& ray) {
    const float scale = depth_scale(ray.direction);
    return {{ray.origin, ray.direction, ray.time}, {ray.min * scale, ray.max * scale}, ray.left.most * scale};
}

/// The share of the memory that is for grids; the rest is for trees over them.
constexpr double kGridShare = 0.8;

}  // namespace

RayLevel::RayLevel(const RenderContext& context, const Shading& shading, size_t most_bytes)
    : dicer_(context, shading, most_bytes) {}

RayLevel::RayLevel(const RayLevel& finest, int level, size_t most_bytes)
    : level_(static_cast<uint8_t>(level)), dicer_(finest.dicer_, level_side(level), most_bytes) {}

/// Sorts what all rays may meet by the kinds of rays that see it.
void RayLevel::make_grids(size_t most_bytes) {
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
        const double share = kBrickShare * static_cast<double>(bytes[mask]) / static_cast<double>(all_bytes);
        auto bricks = std::make_unique<RayBricks>(
            dicer_, extents[mask], static_cast<size_t>(share * static_cast<double>(most_bytes)));
        group.bricks = bricks.get();
        group.grids = std::move(bricks);
    }
}

bool RayLevel::has(RayKind kind) const {
    for (unsigned mask = 0; mask < kMasks; ++mask)
        if (sees(kind, mask) && groups_[mask].grids) return true;
    return false;
}

bool RayLevel::is_seen(uint32_t primitive, RayKind kind) const {
    return sees(kind, mask_of(dicer_.attributes(primitive).rays));
}

bool RayLevel::makes_bricks() const {
    return std::ranges::any_of(groups_, [](const Group& group) { return group.bricks != nullptr; });
}

size_t RayLevel::bytes() const {
    size_t bytes = 0;
    for (const GridArena& arena : arenas_) bytes += arena.bytes();
    for (const Group& group : groups_) bytes += group.grids ? group.grids->bytes() : 0;
    return bytes;
}

uint64_t RayLevel::micropolygons_made() const {
    uint64_t count = micropolygon_count();
    for (const Group& group : groups_) count += group.bricks ? group.bricks->micropolygons_made() : 0;
    return count;
}

std::optional<RaySurfaceHit> RayLevel::closest(const RaySegment& ray, RayKind kind) const {
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

std::optional<RaySurfaceHit> RayLevel::closest_in(const RayGrids& grids, const RaySegment& ray) const {
    const float scale = depth_scale(ray.direction);
    auto [space, range, near] = ranged(ray);
    while (range.min <= range.max) {
        const std::optional<RayGridHit> found = grids.closest(space, range);
        if (!found) return {};
        if (counts(ray, *found)) return hit_of(ray, found->hit.depth / scale, *found);
        range.min = std::nextafter(found->hit.depth, kInfinity);
    }
    return {};
}

/// Rays whose nearest hit does not count go on behind it, all together.
void RayLevel::closest_in(const RayBricks& bricks, std::span<const RaySegment> rays,
                          std::span<std::optional<RaySurfaceHit>> hits) const {
    std::vector<RangedRay> asked;
    for (const RaySegment& ray : rays) asked.push_back(ranged(ray));
    std::vector<uint32_t> going(rays.size());  // asked[r] is ray going[r]
    std::iota(going.begin(), going.end(), 0u);
    while (!going.empty()) {
        std::vector<bool> counted(going.size(), true);  // the last hit, if there is one
        std::vector<float> behind(going.size());
        bricks.closest(asked, [&](size_t r, const RayGridHit& found) {
            const uint32_t i = going[r];
            counted[r] = counts(rays[i], found);
            behind[r] = std::nextafter(found.hit.depth, kInfinity);
            if (counted[r])
                hits[i] = hit_of(rays[i], found.hit.depth / depth_scale(rays[i].direction), found);
            else
                hits[i].reset();
        });
        size_t left = 0;
        for (size_t r = 0; r < going.size(); ++r) {
            if (counted[r] || behind[r] > asked[r].range.max) continue;
            going[left] = going[r], asked[left] = asked[r];
            asked[left++].range.min = behind[r];
        }
        going.resize(left), asked.resize(left);
    }
}

void RayLevel::closest(std::span<const RaySegment> rays, RayKind kind,
                       std::span<std::optional<RaySurfaceHit>> hits) const {
    std::ranges::fill(hits, std::nullopt);
    std::vector<RaySegment> rest(rays.begin(), rays.end());
    std::vector<std::optional<RaySurfaceHit>> found(rays.size());
    for (unsigned mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.grids) continue;
        std::ranges::fill(found, std::nullopt);
        if (group.bricks) closest_in(*group.bricks, rest, found);
        for (size_t i = 0; i < rays.size(); ++i) {
            if (!group.bricks) found[i] = closest_in(*group.grids, rest[i]);
            if (!found[i] || (hits[i] && found[i]->distance >= hits[i]->distance)) continue;
            hits[i] = found[i];
            rest[i].max = found[i]->distance;
        }
    }
}

void RayLevel::blocked(std::span<const RaySegment> rays, RayKind kind,
                       std::span<std::optional<bool>> blocked) const {
    std::vector<RangedRay> asked;
    std::vector<uint32_t> open;
    std::vector<InTheWay> met;
    std::ranges::fill(blocked, std::optional(false));
    for (unsigned mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.grids) continue;
        asked.clear(), open.clear();
        for (uint32_t i = 0; i < rays.size(); ++i)
            if (blocked[i] != true) asked.push_back(ranged(rays[i])), open.push_back(i);
        met.resize(asked.size());
        if (group.bricks) group.bricks->in_the_way(asked, met);
        for (size_t r = 0; r < asked.size(); ++r) {
            if (!group.bricks) met[r] = group.grids->in_the_way(asked[r]);
            if (met[r] == InTheWay::Opaque && !rays[open[r]].only)
                blocked[open[r]] = true;
            else if (met[r] != InTheWay::Nothing)
                blocked[open[r]].reset();
        }
    }
}

/// Whether a ray comes to a micropolygon from the outside of its surface.
bool RayLevel::from_outside(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const {
    const Attributes& attributes = dicer_.attributes(grid.primitive);
    const auto corner = [&](int i, int j) { return grid.vertex(id.u + i, id.v + j, ray.time); };
    const V3f p00 = corner(0, 0), p11 = corner(1, 1), p10 = corner(1, 0), p01 = corner(0, 1);
    const V3f normal = (p11 - p00).cross(p01 - p10) * (attributes.reverse_orientation ? -1.0f : 1.0f);
    return normal.dot(ray.direction) <= 0;
}

/// Whether a micropolygon's hit counts: one-sided surfaces have no inside, and a ray may want groups or sides
/// of its own choice.
bool RayLevel::shows(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const {
    using Sides = RayFilter::Sides;
    const Primitive& primitive = dicer_.context().scene->primitives[grid.primitive];
    if (primitive.solid >= 0) return true;  // the whole solid has sides
    const Attributes& attributes = dicer_.attributes(grid.primitive);
    if (ray.only && !ray.only->admits(attributes.rays.groups)) return false;
    Sides sides = ray.only ? ray.only->sides : Sides::OfAttributes;
    if (sides == Sides::OfAttributes) sides = attributes.sides == 1 ? Sides::Front : Sides::Both;
    if (sides == Sides::Both) return true;
    return from_outside(grid, id, ray) == (sides == Sides::Front);
}

/// Whether a hit counts: not where it may be the surface that the ray leaves.
bool RayLevel::counts(const RaySegment& ray, const RayGridHit& found) const {
    const MicropolygonId id = MicropolygonId::unpack(found.hit.id);
    if (found.hit.depth < ray.left.most * depth_scale(ray.direction)) {
        const auto is_left = [&](int i, int j) {
            const V3f corner = found.grid->vertex(id.u + i, id.v + j, ray.time);
            return ray.left.is_left(corner - ray.origin, ray.direction);
        };
        if (!is_left(0, 0) && !is_left(1, 0) && !is_left(0, 1) && !is_left(1, 1)) return false;
    }
    return shows(*found.grid, id, ray);
}

RaySurfaceHit RayLevel::hit_of(const RaySegment& ray, float distance, const RayGridHit& found) const {
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
    hit.level = level_;
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

std::optional<bool> RayLevel::blocked(const RaySegment& ray, RayKind kind) const {
    const RangedRay asked = ranged(ray);
    bool sure = true;
    for (uint32_t mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.grids) continue;
        const InTheWay met = group.grids->in_the_way(asked);
        if (met == InTheWay::Opaque && !ray.only) return true;
        sure &= met == InTheWay::Nothing;
    }
    return sure ? std::optional(false) : std::nullopt;
}

int RayLevel::dice(const RaySurfaceHit& hit, ShadingGrid& grid) const {
    const MicropolygonId id = MicropolygonId::unpack(hit.id);
    const GridShape shape = dicer_.tessellation().subpatches()[id.grid].shape;
    const V2f at((static_cast<float>(id.u) + hit.at.x) / static_cast<float>(shape.nu),
                 (static_cast<float>(id.v) + hit.at.y) / static_cast<float>(shape.nv));
    return dicer_.make_point({id.grid, at}, grid);
}

}  // namespace trapeze
