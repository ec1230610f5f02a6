#include "shade/rays/ray_walk.h"

#include <algorithm>

namespace trapeze {
namespace {

/// Rays that go on together, and the most surfaces that one looks through.
constexpr size_t kTogether = 256;
constexpr int kMostLayers = 64;
/// Less light than this is none: half of the smallest step of eight bits.
constexpr float kNothing = 1.0f / 512;

uint64_t& count_of(RayKind kind, RayStats& stats) {
    return kind == RayKind::Diffuse    ? stats.diffuse
           : kind == RayKind::Specular ? stats.specular
                                       : stats.transmission;
}

float largest(const V3f& v) {
    return std::max({v.x, v.y, v.z});
}

/// Behind a surface, but not so far that the next one is missed.
float behind(const RaySurfaceHit& hit, float spacing) {
    return hit.distance + std::max(hit.distance * 1e-6f, spacing * 1e-4f);
}

/// Puts the grid of a hit where the ray has met it: on a micropolygon, which passes beside the limit surface.
/// Not where shaders are to displace it first.
void move_to_hit(const RaySegment& ray, const RaySurfaceHit& hit, int vertex, ShadingGrid& grid) {
    const Attributes& attributes = *grid.primitive->attributes;
    if (attributes.rays.displaced && (attributes.displacement || attributes.displacement_bound > 0)) return;
    Triples& P = grid.P.front();
    const V3f way = ray.origin + ray.direction * hit.distance - P.at(static_cast<size_t>(vertex));
    for (size_t i = 0; i < P.size(); ++i) P.set(i, P.at(i) + way);
    P.set(static_cast<size_t>(vertex), ray.origin + ray.direction * hit.distance);
}

}  // namespace

void RayWalk::radiance(std::span<WalkedRay> rays, RayKind kind) {
    std::vector<WalkedRay*> together;
    for (size_t i = 0; i < rays.size(); i += kTogether) {
        together.clear();
        for (WalkedRay& ray : rays.subspan(i, std::min(kTogether, rays.size() - i))) together.push_back(&ray);
        walk(together, kind, Wants::Color);
    }
    count_of(kind, stats_) += rays.size();
}

void RayWalk::transmission(std::span<WalkedRay> rays, RayKind kind, bool with_distance) {
    std::vector<WalkedRay*> open;  // it is not known at once whether they are blocked
    for (WalkedRay& ray : rays) {
        const std::optional<bool> blocked = with_distance ? std::nullopt : scene_.blocked(ray.segment, kind);
        if (!blocked) open.push_back(&ray);
        if (blocked.value_or(false)) ray.through = V3f(0, 0, 0);
    }
    count_of(kind, stats_) += rays.size();
    const std::span<WalkedRay*> all(open);
    for (size_t i = 0; i < all.size(); i += kTogether)
        walk(all.subspan(i, std::min(kTogether, all.size() - i)), kind, Wants::Opacity);
}

void RayWalk::distance(std::span<WalkedRay> rays, RayKind kind) {
    for (WalkedRay& ray : rays)
        if (const std::optional<RaySurfaceHit> hit = scene_.closest(ray.segment, kind))
            ray.distance = hit->distance;
    count_of(kind, stats_) += rays.size();
}

/// All go on together, a surface farther each time.
void RayWalk::walk(std::span<WalkedRay* const> rays, RayKind kind, Wants wants) {
    std::vector<WalkedRay*> going(rays.begin(), rays.end());
    for (int layer = 0; layer < kMostLayers && !going.empty(); ++layer) {
        met_.clear();
        for (WalkedRay* ray : going)
            if (const std::optional<RaySurfaceHit> hit = scene_.closest(ray->segment, kind)) {
                ray->distance = std::min(ray->distance, hit->distance);
                met_.push_back({ray, *hit});
            }
        shade_hits(wants);
        going.clear();
        for (const Met& met : met_) {
            WalkedRay& ray = *met.ray;
            const bool own = met.vertex < 0;
            const V3f opacity = own ? met.hit.opacity : met.grid->Oi.at(static_cast<size_t>(met.vertex));
            const V3f color =
                own ? met.hit.color * opacity : met.grid->Ci.at(static_cast<size_t>(met.vertex));
            ray.seen += ray.through * color;
            for (int k = 0; k < 3; ++k) ray.through[k] *= 1 - std::clamp(opacity[k], 0.0f, 1.0f);
            if (!(largest(ray.through) > kNothing)) {
                ray.through = V3f(0, 0, 0);
                continue;
            }
            const V3f P = ray.segment.origin + ray.segment.direction * met.hit.distance;
            ray.segment.min = behind(met.hit, scene_.spacing(P));
            going.push_back(&ray);
        }
    }
}

/// Hits of one primitive are shaded side by side; in which order changes nothing but the time.
void RayWalk::shade_hits(Wants wants) {
    if (!shade_) return;
    std::vector<ShadingGrid*> grids;
    for (Met& met : met_) {
        if (wants == Wants::Opacity && met.hit.keeps_opacity) continue;
        if (scratch_.grids.size() <= grids.size()) scratch_.grids.emplace_back();
        met.grid = &scratch_.grids[grids.size()];
        met.vertex = scene_.dice(met.hit, *met.grid);
        move_to_hit(met.ray->segment, met.hit, met.vertex, *met.grid);
        const size_t vertices = met.grid->vertex_count();
        met.grid->I.resize(vertices);
        for (size_t i = 0; i < vertices; ++i)
            met.grid->I.set(i, met.grid->P.front().at(i) - met.ray->segment.origin);
        met.grid->hit_vertex = met.vertex;
        met.grid->ordinal = met.ray->seed;
        grids.push_back(met.grid);
    }
    stats_.shaded_hits += grids.size();
    std::ranges::stable_sort(grids, {}, &ShadingGrid::primitive_index);
    if (!grids.empty()) shade_(grids);
}

}  // namespace trapeze
