#include "pipeline/rays/ray_world.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "pipeline/rays/hits_ahead.h"
#include "pipeline/rays/make_surfels.h"

namespace trapeze {
namespace {

/// The share of a render's memory that what rays meet may take, besides the lists of subpatches.
constexpr double kRayShare = 0.5;
/// About what a ray takes that waits for geometry, and what it does where it passes through instances'
/// spaces; the most that wait.
constexpr size_t kBytesOfRay = 512, kBytesOfPlacedRay = 1280, kMostAtOnce = size_t{1} << 18;

/// Scenes of fewer micropolygons have one level: time is not gained by more where all is in memory.
constexpr uint64_t kManyMicropolygons = uint64_t{1} << 25;
/// A level that has more than this share of the finer one's micropolygons is not worth while.
constexpr double kLevelShare = 0.5;

}  // namespace

RayWorld::RayWorld(const RenderContext& context, const Shading& shading, size_t most_bytes)
    : rule_(context.camera, {0}), most_bytes_(most_bytes) {
    levels_[0] = std::make_unique<RayLevel>(context, shading, most_bytes);
    const Scene& scene = *this->context().scene;
    if (!scene.solids.empty()) solids_.emplace(scene);
    rule_ = LevelRule(context.camera, make_levels(most_bytes));
    const auto threads = static_cast<size_t>(tbb::this_task_arena::max_concurrency());
    rays_at_once_ = static_cast<size_t>(kRayShare * (1 - kBrickShare) * static_cast<double>(most_bytes)) /
                    threads / (levels_[0]->dicer().shared().places.empty() ? kBytesOfRay : kBytesOfPlacedRay);
    // From the coarsest one on: what most rays meet is the last to be made again and again.
    size_t rest = static_cast<size_t>(kRayShare * static_cast<double>(most_bytes));
    for (int number = kMostRayLevels - 1; number >= 0 && !context.is_cancelled(); --number) {
        RayLevel* const level = levels_[static_cast<size_t>(number)].get();
        if (!level) continue;
        const size_t share = number > 0 ? rest / 2 : rest;
        level->make_grids(share);
        makes_bricks_ |= level->makes_bricks();
        rest -= level->makes_bricks() ? share : std::min(rest, level->bytes());
    }
}

RayWorld::~RayWorld() = default;

/// Splits for the coarser levels that are worth while; the numbers of all. What a solid is made of is counted
/// by its crossings, which have to be those of one level.
std::vector<int> RayWorld::make_levels(size_t most_bytes) {
    const int asked = context().scene->options.ray_levels;
    uint64_t finer = levels_[0]->micropolygon_count();
    const int wanted = asked > 0                     ? std::min(asked, kMostRayLevels)
                       : finer >= kManyMicropolygons ? kMostRayLevels
                                                     : 1;
    std::vector<int> numbers{0};
    for (int number = 1; number < wanted && !solids_ && !context().is_cancelled(); ++number) {
        auto level = std::make_unique<RayLevel>(*levels_[0], number, most_bytes);
        const uint64_t count = level->micropolygon_count();
        if (static_cast<double>(count) > kLevelShare * static_cast<double>(finer)) continue;
        finer = count;
        levels_[static_cast<size_t>(number)] = std::move(level);
        numbers.push_back(number);
    }
    return numbers;
}

size_t RayWorld::rays_at_once() const {
    return makes_bricks_ ? std::min(rays_at_once_, kMostAtOnce) : 0;
}

bool RayWorld::has(RayKind kind) const {
    return levels_[0]->has(kind);
}

size_t RayWorld::bytes() const {
    return sum_of([](const RayLevel& level) { return level.bytes(); });
}

size_t RayWorld::list_bytes() const {
    // Asked for when no shader runs any more.
    const size_t of_surfels = surfel_dicer_ ? surfel_dicer_->tessellation().bytes() : 0;
    return of_surfels + sum_of([](const RayLevel& level) { return level.dicer().tessellation().bytes(); });
}

uint64_t RayWorld::micropolygon_count() const {
    return sum_of([](const RayLevel& level) { return level.micropolygon_count(); });
}

uint64_t RayWorld::micropolygons_made() const {
    return sum_of([](const RayLevel& level) { return level.micropolygons_made(); });
}

std::optional<RaySurfaceHit> RayWorld::closest(const RaySegment& ray, RayKind kind) const {
    std::optional<RaySurfaceHit> hit = closest_of_all(ray, kind);
    if (!hit || !solids_ || !solids_->has(hit->primitive)) return hit;
    return solids_->nearest(ray, [&](const RaySegment& rest) { return closest_of_all(rest, kind); });
}

std::optional<RaySurfaceHit> RayWorld::closest_of_all(const RaySegment& ray, RayKind kind) const {
    if (rule_.is_simple()) return levels_[0]->closest(ray, kind);
    std::optional<RaySurfaceHit> nearest;
    RaySegment part = ray;
    for (const LevelSpan& span : rule_.of(ray)) {
        if (nearest && nearest->distance <= span.min) break;
        part.min = span.min, part.max = nearest ? nearest->distance : span.max;
        const std::optional<RaySurfaceHit> hit =
            levels_[static_cast<size_t>(span.level)]->closest(part, kind);
        if (hit && !(nearest && nearest->distance <= hit->distance)) nearest = hit;
    }
    return nearest;
}

std::optional<bool> RayWorld::blocked(const RaySegment& ray, RayKind kind) const {
    std::optional<bool> is_blocked;
    blocked(std::array{&ray}, kind, std::span(&is_blocked, 1));
    return is_blocked;
}

/// Calls ask(level, numbers, parts) for the rays that want a level, level by level; ends(number) is where a
/// ray ends by then.
template <class Ends, class Ask>
void RayWorld::for_each_level(std::span<const RaySegment* const> rays, const Ends& ends,
                              const Ask& ask) const {
    std::vector<uint32_t> numbers;
    std::vector<RaySegment> parts;
    for (int number = 0; number < kMostRayLevels; ++number) {
        if (!levels_[static_cast<size_t>(number)]) continue;
        numbers.clear(), parts.clear();
        parts.reserve(rays.size());
        for (uint32_t i = 0; i < rays.size(); ++i)
            for (const LevelSpan& span : rule_.of(*rays[i])) {
                const float end = ends(i);
                if (span.level != number || end <= span.min) continue;
                numbers.push_back(i), parts.push_back(*rays[i]);
                parts.back().min = span.min, parts.back().max = std::min(end, span.max);
            }
        if (!parts.empty()) ask(*levels_[static_cast<size_t>(number)], numbers, parts);
    }
}

void RayWorld::closest(std::span<const RaySegment* const> rays, RayKind kind,
                       std::span<std::optional<RaySurfaceHit>> hits) const {
    if (solids_ || !makes_bricks_) {
        for (size_t i = 0; i < rays.size(); ++i) hits[i] = closest(*rays[i], kind);
        return;
    }
    std::ranges::fill(hits, std::nullopt);
    std::vector<std::optional<RaySurfaceHit>> found;
    for_each_level(
        rays, [&](uint32_t i) { return hits[i] ? hits[i]->distance : kInfinity; },
        [&](const RayLevel& level, std::span<const uint32_t> numbers, std::span<const RaySegment> parts) {
            found.resize(parts.size());
            level.closest(parts, kind, found);
            for (size_t k = 0; k < parts.size(); ++k) {
                std::optional<RaySurfaceHit>& nearest = hits[numbers[k]];
                if (found[k] && !(nearest && nearest->distance <= found[k]->distance)) nearest = found[k];
            }
        });
}

void RayWorld::blocked(std::span<const RaySegment* const> rays, RayKind kind,
                       std::span<std::optional<bool>> blocked) const {
    std::ranges::fill(blocked, std::optional(false));
    std::vector<std::optional<bool>> found;
    for_each_level(
        rays, [&](uint32_t i) { return blocked[i] == true ? -kInfinity : kInfinity; },
        [&](const RayLevel& level, std::span<const uint32_t> numbers, std::span<const RaySegment> parts) {
            found.resize(parts.size());
            level.blocked(parts, kind, found);
            for (size_t k = 0; k < parts.size(); ++k)
                if (found[k] != false && blocked[numbers[k]] != true) blocked[numbers[k]] = found[k];
        });
}

/// Of grids that are made when rays come by hits are found one by one.
std::unique_ptr<RayAhead> RayWorld::look_ahead() const {
    return makes_bricks_ ? nullptr : std::make_unique<HitsAhead>();
}

int RayWorld::dice(const RaySurfaceHit& hit, ShadingGrid& grid) const {
    return levels_[hit.level]->dice(hit, grid);
}

float RayWorld::spacing(const V3f& P) const {
    return rule_.pixel(P);
}

std::optional<Surfels> RayWorld::surfels(RayKind kind, size_t most_bytes) const {
    const RayLevel& finest = *levels_[0];
    std::call_once(surfels_wanted_, [&] {
        // Who waits for it may hold what other tasks of the frame want.
        if (finest.dicer().tessellation().has_larger_flats())
            tbb::this_task_arena::isolate([&] {
                surfel_dicer_ = std::make_unique<RayDicer>(finest.dicer(), RaySides{0, false}, most_bytes_);
            });
    });
    return make_surfels(
        dicer_of_surfels(), [&](uint32_t primitive) { return finest.is_seen(primitive, kind); }, most_bytes);
}

int RayWorld::dice_surfel(uint64_t id, ShadingGrid& grid) const {
    return trapeze::dice_surfel(dicer_of_surfels(), id, grid);
}

/// Who waits for it may hold what other tasks of the frame want.
void RayWorld::in_parallel(const std::function<void()>& work) const {
    tbb::this_task_arena::isolate(
        [&] { tbb::parallel_for(0, tbb::this_task_arena::max_concurrency(), [&](int) { work(); }); });
}

std::unique_ptr<RayWorld> make_ray_world(const RenderContext& context, const Shading& shading,
                                         size_t most_bytes) {
    if (!shading.asks_rays()) return {};
    auto world = std::make_unique<RayWorld>(context, shading, most_bytes);
    const bool empty =
        !world->has(RayKind::Diffuse) && !world->has(RayKind::Specular) && !world->has(RayKind::Transmission);
    if (empty && context.diagnostics && !context.is_cancelled() && !shading.asks_clouds_alone())
        context.diagnostics->warning(
            {},
            "shaders trace rays, but no primitive is seen by rays; Attribute \"visibility\" \"int diffuse\" 1, "
            "\"int specular\" 1 and \"int transmission\" 1 let them be seen",
            "nothing-for-rays");
    return world;
}

}  // namespace trapeze
