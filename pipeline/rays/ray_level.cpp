#include "pipeline/rays/ray_level.h"

#include <algorithm>
#include <tuple>

#include "pipeline/rays/make_all_grids.h"
#include "pipeline/rays/whole_ray_grids.h"

namespace trapeze {
namespace {

/// The share of the memory that is for grids; the rest is for trees over them.
constexpr double kGridShare = 0.8;

/// What some kinds of rays meet of one space, on its way into a GroupedRayGrids.
struct Gathered {
    Grids grids;
    std::vector<RunExtent> extents;  ///< of grids that are not kept
    size_t bytes = 0;                ///< of these
};

/// By kinds of rays.
using GatheredGroups = std::array<Gathered, GroupedRayGrids::kMasks>;

void unite(std::optional<GridExtent>& all, const GridExtent& one) {
    all = all ? united(*all, one) : one;
}

/// Hits as near as the nearest are wanted, too.
RaySegment to_beyond(const RaySegment& rest) {
    RaySegment ray = rest;
    ray.max = beyond(rest.max);
    return ray;
}

std::optional<bool> is_blocked(InTheWay met) {
    if (met == InTheWay::Layers) return {};
    return met == InTheWay::Opaque;
}

}  // namespace

RayLevel::RayLevel(const RenderContext& context, const Shading& shading, size_t most_bytes)
    : dicer_(context, shading, most_bytes), hits_(dicer_, level_) {}

RayLevel::RayLevel(const RayLevel& finest, int level, size_t most_bytes)
    : level_(static_cast<uint8_t>(level)),
      dicer_(finest.dicer_, RaySides{level_side(level)}, most_bytes),
      hits_(dicer_, level_) {}

/// Sorts what all rays may meet by its space and by the kinds of rays that see it.
void RayLevel::make_grids(size_t most_bytes) {
    const auto most_of_grids = static_cast<size_t>(kGridShare * static_cast<double>(most_bytes));
    AllRayGrids all = make_all_grids(dicer_, most_of_grids);
    if (dicer_.context().is_cancelled()) return;
    arenas_ = std::move(all.arenas);
    const SharedObjects& shared = dicer_.shared();
    std::vector<GatheredGroups> gathered(1 + shared.objects.size());  // that of camera space first
    std::vector<std::optional<GridExtent>> extents(shared.objects.size());
    size_t all_bytes = 0;
    const auto group_of = [&](size_t subpatch, const auto& extent) -> Gathered& {
        const uint32_t primitive = dicer_.tessellation().primitive_of(subpatch);
        const int object = shared.object_of(primitive);
        if (object >= 0) unite(extents[static_cast<size_t>(object)], extent());
        return gathered[static_cast<size_t>(object + 1)]
                       [GroupedRayGrids::mask_of(dicer_.attributes(primitive).rays)];
    };
    for (size_t i = 0; i < all.grids.size(); ++i)
        group_of(i, [&] { return extent_of(all.grids[i]); }).grids.grids.push_back(all.grids[i]);
    for (const RunExtent& known : all.extents) {
        Gathered& group = group_of(known.run.first, [&] { return known.extent; });
        group.extents.push_back(known), group.bytes += known.bytes;
        all_bytes += known.bytes;
    }
    all.extents = {};
    objects_.resize(shared.objects.size());
    for (size_t space = 0; space < gathered.size(); ++space) {
        GroupedRayGrids& grids = space == 0 ? own_ : objects_[space - 1];
        for (unsigned mask = 0; mask < GroupedRayGrids::kMasks; ++mask) {
            Gathered& group = gathered[space][mask];
            if (!group.grids.grids.empty())
                grids.set(mask, std::make_unique<WholeRayGrids>(std::move(group.grids)));
            if (group.extents.empty()) continue;
            const double share =
                kBrickShare * static_cast<double>(group.bytes) / static_cast<double>(all_bytes);
            grids.set(mask, std::make_unique<RayBricks>(
                                dicer_, group.extents,
                                static_cast<size_t>(share * static_cast<double>(most_bytes))));
            group.extents = {};
        }
    }
    if (!shared.places.empty()) places_.emplace(shared.places, extents);
}

bool RayLevel::has(RayKind kind) const {
    return own_.has(kind) ||
           std::ranges::any_of(objects_, [&](const GroupedRayGrids& object) { return object.has(kind); });
}

bool RayLevel::is_seen(uint32_t primitive, RayKind kind) const {
    const unsigned mask = GroupedRayGrids::mask_of(dicer_.attributes(primitive).rays);
    return (mask >> static_cast<unsigned>(kind) & 1) != 0;
}

bool RayLevel::makes_bricks() const {
    return own_.makes_bricks() || std::ranges::any_of(objects_, &GroupedRayGrids::makes_bricks);
}

size_t RayLevel::bytes() const {
    size_t bytes = own_.bytes() + (places_ ? places_->bytes() : 0);
    for (const GridArena& arena : arenas_) bytes += arena.bytes();
    for (const GroupedRayGrids& object : objects_) bytes += object.bytes();
    return bytes;
}

uint64_t RayLevel::micropolygons_made() const {
    uint64_t count = micropolygon_count() + own_.micropolygons_made();
    for (const GroupedRayGrids& object : objects_) count += object.micropolygons_made();
    return count;
}

std::optional<RaySurfaceHit> RayLevel::closest(const RaySegment& ray, RayKind kind) const {
    std::optional<RaySurfaceHit> nearest = own_.closest(hits_, ray, PlacedRay(ray), kind);
    if (!places_) return nearest;
    RaySegment rest = ray;
    if (nearest) rest.max = nearest->distance;
    places_->visit(rest, [&](uint32_t, float, const PlacedRay& placed) {
        const GroupedRayGrids& object = objects_[placed.place->object];
        const std::optional<RaySurfaceHit> hit = object.closest(hits_, to_beyond(rest), placed, kind);
        if (hit && hit->distance <= ray.max && is_in_front(*hit, nearest)) {
            nearest = hit;
            rest.max = hit->distance;
        }
        return rest.max;
    });
    return nearest;
}

/// A ray that comes to a place, nothing of which is nearer than a distance.
struct RayLevel::Meeting {
    uint32_t place, ray;
    float distance;
};

/// All meetings of places and rays, but those that nobody wants: place by place, and so object by object.
template <class Wants>
std::vector<RayLevel::Meeting> RayLevel::meetings(std::span<const RaySegment> rays,
                                                  const Wants& wants) const {
    std::vector<Meeting> meetings;
    for (uint32_t i = 0; i < rays.size(); ++i) {
        if (!wants({.place = 0, .ray = i, .distance = rays[i].min})) continue;
        places_->visit(rays[i], [&](uint32_t number, float distance, const PlacedRay&) {
            meetings.push_back({number, i, distance});
            return rays[i].max;
        });
    }
    std::ranges::sort(meetings, {},
                      [](const Meeting& meeting) { return std::tuple(meeting.place, meeting.ray); });
    return meetings;
}

/// Calls meet(object, meetings, placed rays) for meetings with one object, as many at a time as there are
/// rays, which bounds the memory. Leaves out those that nobody wants any more: wants(meeting).
template <class Wants, class Meet>
void RayLevel::for_each_object(std::span<const RaySegment> rays, const Wants& wants, const Meet& meet) const {
    const std::vector<ObjectPlace>& places = dicer_.shared().places;
    std::vector<Meeting> wanted;
    std::vector<PlacedRay> placed;
    const auto ask = [&] {
        if (!wanted.empty()) meet(objects_[places[wanted.front().place].object], wanted, placed);
        wanted.clear(), placed.clear();
    };
    for (const Meeting& meeting : meetings(rays, wants)) {
        const ObjectPlace& place = places[meeting.place];
        if (wanted.size() >= rays.size() ||
            (!wanted.empty() && places[wanted.front().place].object != place.object))
            ask();
        if (!wants(meeting)) continue;
        wanted.push_back(meeting), placed.emplace_back(rays[meeting.ray], place);
    }
    ask();
}

void RayLevel::closest(std::span<const RaySegment> rays, RayKind kind,
                       std::span<std::optional<RaySurfaceHit>> hits) const {
    {
        std::vector<PlacedRay> placed;
        for (const RaySegment& ray : rays) placed.emplace_back(ray);
        own_.closest(hits_, rays, placed, kind, hits);
    }
    if (!places_) return;
    std::vector<RaySegment> rest(rays.begin(), rays.end());
    for (size_t i = 0; i < rays.size(); ++i)
        if (hits[i]) rest[i].max = hits[i]->distance;
    std::vector<RaySegment> asked;
    std::vector<std::optional<RaySurfaceHit>> found;
    for_each_object(
        rest, [&](const Meeting& meeting) { return meeting.distance <= to_beyond(rest[meeting.ray]).max; },
        [&](const GroupedRayGrids& object, std::span<const Meeting> meetings,
            std::span<const PlacedRay> placed) {
            asked.clear(), found.assign(meetings.size(), std::nullopt);
            for (const Meeting& meeting : meetings) asked.push_back(to_beyond(rest[meeting.ray]));
            object.closest(hits_, asked, placed, kind, found);
            for (size_t k = 0; k < meetings.size(); ++k) {
                const uint32_t i = meetings[k].ray;
                if (!found[k] || found[k]->distance > rays[i].max || !is_in_front(*found[k], hits[i]))
                    continue;
                hits[i] = found[k];
                rest[i].max = found[k]->distance;
            }
        });
}

void RayLevel::blocked(std::span<const RaySegment> rays, RayKind kind,
                       std::span<std::optional<bool>> blocked) const {
    std::vector<InTheWay> most(rays.size());
    {
        std::vector<PlacedRay> placed;
        for (const RaySegment& ray : rays) placed.emplace_back(ray);
        own_.in_the_way(rays, placed, kind, most);
    }
    std::vector<RaySegment> asked;
    std::vector<InTheWay> met;
    if (places_)
        for_each_object(
            rays, [&](const Meeting& meeting) { return most[meeting.ray] != InTheWay::Opaque; },
            [&](const GroupedRayGrids& object, std::span<const Meeting> meetings,
                std::span<const PlacedRay> placed) {
                asked.clear(), met.resize(meetings.size());
                for (const Meeting& meeting : meetings) asked.push_back(rays[meeting.ray]);
                object.in_the_way(asked, placed, kind, met);
                for (size_t k = 0; k < meetings.size(); ++k)
                    most[meetings[k].ray] = std::max(most[meetings[k].ray], met[k]);
            });
    std::ranges::transform(most, blocked.begin(), is_blocked);
}

int RayLevel::dice(const RaySurfaceHit& hit, ShadingGrid& grid) const {
    const MicropolygonId id = MicropolygonId::unpack(hit.place.id);
    const GridShape shape = dicer_.tessellation().shape_of(id.grid);
    const V2f at((static_cast<float>(id.u) + hit.at.x) / static_cast<float>(shape.nu),
                 (static_cast<float>(id.v) + hit.at.y) / static_cast<float>(shape.nv));
    return dicer_.make_point({id.grid, at, hit.primitive}, grid);
}

}  // namespace trapeze
