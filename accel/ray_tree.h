/// What the one traversal loop asks of an acceleration structure, whatever its bounds are: where to begin,
/// and which children of a node a ray may hit. A tree is a view prepared for one ray, so that what it
/// computes once a ray (orientation, motion segment) is its own business.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

namespace trapeze {

/// A node to visit. `depth` is a lower bound of the depths of all hits inside, along the ray's axis; `node`
/// is a name that only the tree understands.
struct Visit {
    float depth = 0;
    uint32_t node = 0;
};

/// What a step leads to: the first `count` of two children, the far one first, because the loop's stack takes
/// the last one pushed. Made without branches: which child is nearer, and whether it is met, cannot be
/// predicted.
struct Visits {
    std::array<Visit, 2> visit;
    uint32_t count = 0;

    /// The second place is filled too: the loop copies both and then counts.
    static Visits one(const Visit& v, bool met) { return {{v, v}, met ? 1u : 0u}; }
    /// The visits of those of two children that the ray meets, the farther one first.
    static Visits two(const std::array<Visit, 2>& v, bool met_first, bool met_second) {
        // Children of equal depth keep their order, so that a traversal is the same on all machines.
        const bool swap = !met_first || (met_second && v[0].depth < v[1].depth);
        const uint32_t first = swap ? 1 : 0;
        return {{v[first], v[1 - first]},
                static_cast<uint32_t>(met_first) + static_cast<uint32_t>(met_second)};
    }
};

/// What a structure offers to traverse(). enter() gives the root or nothing, step() the children of an inner
/// node that the ray may hit, leaf() what is in a leaf. kStackSize: visits that can wait at once, at most;
/// the builder guarantees it.
template <class Tree, class Ray>
concept RayTree = requires(const Tree& tree, const Ray& ray, const Visit& visit) {
    { Tree::kStackSize } -> std::convertible_to<int>;
    { tree.enter(ray) } -> std::same_as<Visits>;
    { tree.step(visit, ray) } -> std::same_as<Visits>;
    { tree.is_leaf(visit.node) } -> std::same_as<bool>;
    tree.leaf(visit.node);
};

}  // namespace trapeze
