/// Hit policies: what a ray keeps of the micropolygons that it hits. `consider` sees every hit in the ray's
/// range, in whatever order the tree finds them, and pulls the range in [decision 0018]. What a policy holds
/// in the end does not depend on that order: equal depths are settled by id, and t_max is inclusive.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "accel/trace_ray.h"
#include "core/hit_buffer.h"

namespace trapeze {

/// Behind every hit in the order of in_front().
inline constexpr Hit kNoHit{std::numeric_limits<float>::infinity(), MicropolygonId::kNone};

/// In front of every hit.
inline constexpr Hit kFirstHit{-std::numeric_limits<float>::infinity(), 0};

/// The nearest hit, opaque or not; of equal depths the one of the smaller id.
struct ClosestHit {
    Hit best = kNoHit;
    Hit from = kFirstHit;  ///< hits in front of it do not count

    bool found() const { return best.id != MicropolygonId::kNone; }
    void consider(const Hit& hit, bool, TraceRay& ray) {
        if (!in_front(hit, best) || in_front(hit, from)) return;
        best = hit;
        ray.t_max = hit.depth;
    }
};

/// The nearest few hits that are not in front of one, in their order, as far as the first opaque one, which
/// is included. What is cut off is behind the last of them.
struct NearestHits {
    static constexpr size_t kMost = 8;

    Hit from = kFirstHit;
    std::array<Hit, kMost> hits{};
    size_t count = 0;
    bool is_cut = false;  ///< else there are no others in the range

    void consider(const Hit& hit, bool opaque, TraceRay& ray) {
        if (in_front(hit, from) || (is_cut && !in_front(hit, hits[count - 1]))) return;
        size_t place = count < kMost ? count++ : kMost - 1;
        for (; place > 0 && in_front(hit, hits[place - 1]); --place) hits[place] = hits[place - 1];
        hits[place] = hit;
        if (opaque) count = place + 1;
        is_cut = is_cut || opaque || count == kMost;
        if (is_cut) ray.t_max = hits[count - 1].depth;
    }
};

/// Whether there is a hit at all, for RayQuery::any(). The range becomes empty at the first hit, which ends
/// the traversal.
struct AnyHit {
    bool found = false;

    void consider(const Hit&, bool, TraceRay& ray) {
        found = true;
        ray.t_max = -std::numeric_limits<float>::infinity();
    }
};

/// What is in the way, as far as grids can tell: ends at the first hit of an opaque one.
struct FirstOpaque {
    DepthRange sure = kAllDepths;         ///< hits outside of it count as others
    bool opaque = false, layers = false;  ///< hits of grids that are, and of others, seen so far

    void consider(const Hit& hit, bool of_opaque, TraceRay& ray) {
        const bool is_opaque = of_opaque && hit.depth >= sure.min && hit.depth <= sure.max;
        layers |= !is_opaque;
        if (!is_opaque) return;
        opaque = true;
        ray.t_max = -std::numeric_limits<float>::infinity();
    }
};

/// All hits as far as the first opaque one, which is included: what a camera sample's colour needs. Or, of
/// these, the nearest `most` behind a hit. One policy a ray.
struct HitsUntilOpaque {
    std::vector<Hit>& hits;  ///< empty at first; in no order, and some lie behind `last`
    Hit behind{-std::numeric_limits<float>::infinity(), 0};
    size_t most = std::numeric_limits<size_t>::max();
    Hit last = kNoHit;        ///< nothing behind this counts
    bool may_repeat = false;  ///< a tree may show a hit several times; it counts once
    bool is_cut = false;      ///< as there are `most` hits up to it; else it is opaque, or there is none

    void consider(const Hit& hit, bool opaque, TraceRay& ray) {
        if (!in_front(hit, last) || !in_front(behind, hit)) return;
        if (may_repeat && std::find(hits.begin(), hits.end(), hit) != hits.end()) return;
        hits.push_back(hit);
        if (opaque) last = hit, is_cut = false, ray.t_max = hit.depth;
        // Twice as many, so that dropping takes the same time for each hit however many they are.
        if (hits.size() / 2 >= most) drop_far(ray);
    }

  private:
    /// Leaves the nearest `most` hits, in linear time. The farthest of these becomes `last`, unless an opaque
    /// hit in front of it ends the ray already.
    void drop_far(TraceRay& ray) {
        const auto end = hits.begin() + static_cast<std::ptrdiff_t>(most);
        std::nth_element(hits.begin(), end - 1, hits.end(), in_front);
        hits.erase(end, hits.end());
        if (in_front(hits.back(), last)) last = hits.back(), is_cut = true, ray.t_max = last.depth;
    }
};

}  // namespace trapeze
