/// Hit policies: what a ray keeps of the micropolygons that it hits. `consider` sees every hit in the ray's
/// range, in whatever order the tree finds them, and pulls the range in [decision 0018]. What a policy holds
/// in the end does not depend on that order: equal depths are settled by id, and t_max is inclusive.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "accel/trace_ray.h"
#include "core/hit_buffer.h"

namespace trapeze {

/// Behind every hit in the order of in_front().
inline constexpr Hit kNoHit{std::numeric_limits<float>::infinity(), MicropolygonId::kNone};

/// The nearest hit, opaque or not; of equal depths the one of the smaller id.
struct ClosestHit {
    Hit best = kNoHit;

    bool found() const { return best.id != MicropolygonId::kNone; }
    void consider(const Hit& hit, bool, TraceRay& ray) {
        if (!in_front(hit, best)) return;
        best = hit;
        ray.t_max = hit.depth;
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
    bool opaque = false, layers = false;  ///< hits of grids that are, and of others, seen so far

    void consider(const Hit&, bool is_opaque, TraceRay& ray) {
        layers |= !is_opaque;
        if (!is_opaque) return;
        opaque = true;
        ray.t_max = -std::numeric_limits<float>::infinity();
    }
};

/// All hits as far as the first opaque one, which is included: what a camera sample's colour needs. One
/// policy a ray; rays may share the vector.
struct HitsUntilOpaque {
    std::vector<Hit>& hits;  ///< in no order until finish()
    Hit first_opaque = kNoHit;

    void consider(const Hit& hit, bool opaque, TraceRay& ray) {
        if (!in_front(hit, first_opaque)) return;
        hits.push_back(hit);
        if (opaque) first_opaque = hit, ray.t_max = hit.depth;
    }
    /// Sorts the hits of this ray, which begin at hits[first], from front to back, and drops those behind the
    /// nearest opaque one: it was not known yet when they were found.
    void finish(size_t first) {
        const auto begin = hits.begin() + static_cast<std::ptrdiff_t>(first);
        hits.erase(
            std::remove_if(begin, hits.end(), [this](const Hit& hit) { return in_front(first_opaque, hit); }),
            hits.end());
        std::sort(hits.begin() + static_cast<std::ptrdiff_t>(first), hits.end(), in_front);
    }
};

}  // namespace trapeze
