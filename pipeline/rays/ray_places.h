/// Where the instances of shared objects are: a tree over them, which tells whose spaces a ray passes
/// through.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "accel/wide/extent_tree.h"
#include "pipeline/rays/placed_ray.h"

namespace trapeze {

/// Refers to the places, which outlive it.
class RayPlaces {
  public:
    /// `extents`: of what objects are made of, by object, in their own spaces, where nothing moves. Nothing:
    /// nobody sees it.
    RayPlaces(std::span<const ObjectPlace> places, std::span<const std::optional<GridExtent>> extents);

    /// Calls see(number, distance, placed) for each place within which the ray may meet something, and
    /// nothing nearer than that distance, about the nearest first. What is behind the distance that it
    /// returns need not be seen.
    template <class See>
    void visit(const RaySegment& ray, const See& see) const {
        const V3f sum = ray.origin + ray.direction;
        if (!std::isfinite(sum.x + sum.y + sum.z + ray.time)) return;  // it meets nothing
        const PlacedRay own(ray);
        const RangedRay ranged = own.ranged(ray);
        TraceRay trace = TraceRay::turned(axis_ray(ranged.ray), ranged.range);
        tree_.visit(trace, [&](uint32_t at, float depth) {
            const uint32_t number = numbers_[at];
            const float most = see(number, depth / own.scale, PlacedRay(ray, places_[number]));
            trace.t_max = std::min(trace.t_max, most * own.scale * kOfRounding);
        });
    }

    size_t bytes() const { return tree_.bytes() + numbers_.capacity() * sizeof(uint32_t); }

  private:
    /// Distances in two spaces differ by less.
    static constexpr float kOfRounding = 1 + 0x1p-16f;

    std::span<const ObjectPlace> places_;
    std::vector<uint32_t> numbers_;  ///< of the places in the tree
    ExtentTree tree_;
};

}  // namespace trapeze
