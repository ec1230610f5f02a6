#include "sample/cut_hits.h"

#include <algorithm>

#include "core/motion_keys.h"
#include "core/scene/solid_state.h"
#include "sample/hit_lists.h"

namespace trapeze {
namespace {

/// Leaves of solids, each of which holds a point or does not. There are a few at most. A vector is enough, as
/// a ray is within few solids at a time.
class Leaves {
  public:
    /// Enters the set a leaf that is not in it, takes out one that is: two crossings cancel. The order of the
    /// leaves means nothing.
    void cross(int leaf) {
        const auto at = std::find(all_.begin(), all_.end(), leaf);
        if (at == all_.end()) return all_.push_back(leaf);
        *at = all_.back();
        all_.pop_back();
    }
    void clear() { all_.clear(); }
    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }

  private:
    std::vector<int> all_;
};

/// What is known of a sample's list, of which a part is asked for. One is used for sample after sample, so
/// that its vectors keep their memory.
struct CutList {
    Leaves before, after;  ///< crossed an odd number of times in front of that part, and from there on
    bool ends_opaque = false;
    uint32_t kept = 0;
    Hit last;             ///< that was kept
    bool is_cut = false;  ///< more would have been kept

    void begin() {
        before.clear(), after.clear();
        ends_opaque = is_cut = false;
        kept = 0;
    }
    /// The leaves that hold the point where the part begins. A ray that crosses a closed surface an odd
    /// number of times starts inside it. Only where an opaque hit ends the list is the number not known; such
    /// rays start outside.
    Leaves& holding() { return ends_opaque ? before : after; }
};

/// A tile that a method is asked for. References are the caller's, for one call of resolve().
struct AskedTile {
    const SampleTile& samples;
    LayerWindow window;
    HitBuffer& hits;
    SampleScratch& scratch;
    SampleStats& stats;

    /// Whether a hit is in the part of its sample's list that this pass is to give.
    bool wants(size_t s, const Hit& hit) const {
        return window.behind.empty() || in_front(window.behind[s], hit);
    }
};

/// A thread's. It lasts from tile to tile: `group` remembers how many lists fitted the room together, and is
/// doubled for the next tile.
struct CutScratch {
    std::vector<uint32_t> wanted;  ///< samples
    std::vector<Hit> behind;       ///< of the method's own passes
    std::vector<CutList> lists;
    std::vector<LooseHits::Entry> kept;  ///< in each sample's order
    size_t group = ~size_t{0};           ///< samples whose lists had room together

    void begin(const AskedTile& asked) {
        wanted.clear(), kept.clear();
        for (uint32_t s = 0; s < asked.samples.size(); ++s)
            if (asked.window.wants(s)) wanted.push_back(s);
        lists.resize(std::max(lists.size(), asked.samples.size()));
        for (CutList& list : lists) list.begin();
    }
    /// Has hits of these samples alone looked for, behind where `from` says (by sample), or all.
    void look_at(std::span<const uint32_t> some, size_t count, std::span<const Hit> from) {
        behind.assign(count, kBehindAll);
        for (const uint32_t s : some) behind[s] = from.empty() ? kInFrontOfAll : from[s];
    }
};

/// Mixed between keys as vertices are: a polygon that moves with the plane ends on it.
float height_above(const ClippingPlane& moving, const V3f& at, float time01) {
    const MotionSegment segment = segment_at(time01, static_cast<int>(moving.keys.size()));
    const auto height = [&](size_t key) {
        return moving.keys[key].normal.dot(at) - moving.keys[key].distance;
    };
    const auto first = static_cast<size_t>(segment.index);
    return height(first) * (1 - segment.local) + height(first + 1) * segment.local;
}

/// Another method's hits without those that clipping planes or solids take away.
///
/// Which solids hold the point where a list begins follows from all that the ray crosses, in front of it too.
/// Where that is too much to be held at once the method is asked in passes of their own, once to count what
/// is crossed and once more for what is kept [decision 0032].
class CutVisibility : public Visibility {
  public:
    CutVisibility(std::unique_ptr<Visibility> method, const Scene& scene, const Grids& grids)
        : method_(std::move(method)),
          scene_(scene),
          grids_(grids),
          all_opaque_(every_grid_is_opaque(grids)) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        if (scene_.solids.empty() || all_opaque_) {
            method_->resolve(samples, hits, scratch, stats);
            return cut_by_planes(samples, hits);
        }
        auto& own = scratch.own.of<CutScratch>();
        const AskedTile asked{samples, scratch.window, hits, scratch, stats};
        scratch.own_list_bytes = 0;
        own.begin(asked);
        SolidState state(scene_.solids);
        keep_by_groups(asked, state, own);
        scratch.window = asked.window;
        make_lists(asked, own);
    }
    BuildStats build_stats() const override { return method_->build_stats(); }
    bool walks_whole_lists() const override { return !scene_.solids.empty() || method_->walks_whole_lists(); }
    int tile_side() const override { return method_->tile_side(); }

  private:
    const Grid& grid_of(const Hit& hit) const { return grids_.grids[MicropolygonId::unpack(hit.id).grid]; }
    /// The leaf of the solid tree that a micropolygon borders; negative where its primitive is in none.
    int solid_of(const Hit& hit) const { return scene_.primitives[grid_of(hit).primitive].solid; }

    /// Planes are in camera space, where a hit's place follows from its ray and its depth.
    bool is_cut_away(const AxisRay& ray, const Hit& hit) const {
        const V3f at(ray.ox + ray.ux * hit.depth, ray.oy + ray.uy * hit.depth, hit.depth);
        return std::ranges::any_of(scene_.clipping_planes, [&](const ClippingPlane& plane) {
            return plane.keys.empty() ? plane.normal.dot(at) < plane.distance
                                      : height_above(plane, at, ray.time) < 0;
        });
    }

    /// Planes know no inside: each hit stands or falls by itself, in place, without a look at the rest of its
    /// list.
    void cut_by_planes(const SampleTile& samples, HitBuffer& hits) const {
        if (scene_.clipping_planes.empty()) return;
        uint32_t kept = 0;
        for (size_t s = 0; s < samples.size(); ++s) {
            const uint32_t first = hits.first[s], last = hits.first[s + 1];
            hits.first[s] = kept;
            for (uint32_t i = first; i < last; ++i)
                if (!is_cut_away(samples.rays[s], hits.hits[i])) hits.hits[kept++] = hits.hits[i];
        }
        hits.first[samples.size()] = kept;
        hits.hits.resize(kept);
    }

    /// Counts a hit of a list.
    void count(const AskedTile& asked, size_t s, const Hit& hit, CutList& list) const {
        list.ends_opaque = list.ends_opaque || grid_of(hit).opaque;
        if (const int solid = solid_of(hit); solid >= 0)
            (asked.wants(s, hit) ? list.after : list.before).cross(solid);
    }

    /// Keeps a hit of the part that is asked for, if it borders what is left; false when there are `most`
    /// already. `state` is where the ray is.
    bool keep(const AskedTile& asked, size_t s, const Hit& hit, uint32_t most, SolidState& state,
              CutScratch& own) const {
        CutList& list = own.lists[s];
        const int solid = solid_of(hit);
        if (solid >= 0) list.holding().cross(solid);
        if (solid >= 0 && !state.cross(solid)) return true;
        if (solid >= 0 && !sees_border(scene_.primitives[grid_of(hit).primitive], state.whole_holds(solid)))
            return true;
        if (is_cut_away(asked.samples.rays[s], hit)) return true;
        list.is_cut = list.kept == most;
        if (list.is_cut) return false;
        own.kept.push_back({hit.depth, static_cast<uint32_t>(s), hit.id});
        ++list.kept, list.last = hit;
        return true;
    }

    /// Sets the state to what holds the point where the part of the list begins.
    static void start(CutList& list, SolidState& state) {
        state.reset();
        for (const int leaf : list.holding()) state.cross(leaf);
    }

    /// Asks the method for whole lists of as many samples as fit the room together. A group that does not fit
    /// is halved and asked again; a single sample that does not is walked in passes.
    void keep_by_groups(const AskedTile& asked, SolidState& state, CutScratch& own) const {
        const std::span<const uint32_t> wanted(own.wanted);
        // Half of the room is for what is found too far behind.
        const auto most = static_cast<uint32_t>(std::clamp<size_t>(
            asked.window.room / 2 / std::max<size_t>(wanted.size(), 1), 1, asked.window.most));
        own.group = std::min(own.group, size_t{1} << 30) * 2;
        for (size_t first = 0; first < wanted.size();) {
            const auto group = wanted.subspan(first, std::min(own.group, wanted.size() - first));
            own.look_at(group, asked.samples.size(), {});
            asked.scratch.window = {own.behind, kAllLayers, asked.window.room};
            method_->resolve(asked.samples, asked.hits, asked.scratch, asked.stats);
            const bool fits = !asked.scratch.found.is_cut();
            if (!fits && group.size() > 1) {
                own.group = group.size() / 2;
                continue;
            }
            for (const uint32_t s : group)
                if (fits)
                    keep_of_whole(asked, s, most, state, own);
                else
                    keep_in_passes(asked, s, most, state, own);
            first += group.size();
        }
    }

    /// The sample's list that the method has found goes from front to end.
    void keep_of_whole(const AskedTile& asked, uint32_t s, uint32_t most, SolidState& state,
                       CutScratch& own) const {
        const std::span<const Hit> whole = asked.hits.of(s);
        for (const Hit& hit : whole) count(asked, s, hit, own.lists[s]);
        start(own.lists[s], state);
        for (const Hit& hit : whole)
            if (asked.wants(s, hit) && !keep(asked, s, hit, most, state, own)) break;
    }

    /// It does not: as many passes as it takes.
    void keep_in_passes(const AskedTile& asked, uint32_t s, uint32_t most, SolidState& state,
                        CutScratch& own) const {
        own.look_at({&s, 1}, asked.samples.size(), {});
        walk(asked, s, own.behind, [&](const Hit& hit) {
            count(asked, s, hit, own.lists[s]);
            return true;
        });
        own.look_at({&s, 1}, asked.samples.size(), asked.window.behind);
        start(own.lists[s], state);
        walk(asked, s, own.behind, [&](const Hit& hit) { return keep(asked, s, hit, most, state, own); });
    }

    /// Calls visit(hit) with a sample's hits behind `behind`, in their order, until it is false.
    template <class Visit>
    void walk(const AskedTile& asked, uint32_t s, std::vector<Hit>& behind, const Visit& visit) const {
        while (behind[s] != kBehindAll) {
            asked.scratch.window = {behind, kAllLayers, asked.window.room};
            method_->resolve(asked.samples, asked.hits, asked.scratch, asked.stats);
            const bool goes_on = std::ranges::all_of(asked.hits.of(s), visit);
            behind[s] = goes_on ? asked.scratch.found.cut_at(s) : kBehindAll;
        }
    }

    /// What was kept, by samples, and where lists end.
    static void make_lists(const AskedTile& asked, CutScratch& own) {
        const size_t count = asked.samples.size();
        HitBuffer& hits = asked.hits;
        hits.first.assign(count + 1, 0);
        for (size_t s = 0; s < count; ++s) hits.first[s + 1] = hits.first[s] + own.lists[s].kept;
        hits.hits.resize(own.kept.size());
        std::vector<uint32_t>& next = asked.scratch.next;
        next.assign(hits.first.begin(), hits.first.end());
        for (const LooseHits::Entry& entry : own.kept) hits.hits[next[entry.sample]++] = entry.hit();
        asked.scratch.found.begin(count, asked.window);
        for (size_t s = 0; s < count; ++s)
            if (own.lists[s].is_cut) asked.scratch.found.cut(static_cast<uint32_t>(s), own.lists[s].last);
        asked.scratch.own_list_bytes += own.kept.capacity() * sizeof(LooseHits::Entry);
    }

    const std::unique_ptr<Visibility> method_;
    const Scene& scene_;
    const Grids& grids_;
    const bool all_opaque_;
};

}  // namespace

/// Levels of detail are inside of this (Sampler::prepare): a level that a sample does not see must not open
/// or close a solid for it.
std::unique_ptr<Visibility> with_cuts(std::unique_ptr<Visibility> method, const RenderContext& context,
                                      const Grids& grids) {
    const Scene* scene = context.scene;
    if (!method || !scene || (scene->solids.empty() && scene->clipping_planes.empty())) return method;
    return std::make_unique<CutVisibility>(std::move(method), *scene, grids);
}

}  // namespace trapeze
