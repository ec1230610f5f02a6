/// What the one traversal loop asks of an acceleration structure, whatever its bounds are: where to begin,
/// and which children of a node a ray may hit. A tree is a view prepared for one ray, so that what it
/// computes once a ray (orientation, motion segment) is its own business.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

namespace trapeze {

/// A node to visit. `depth` is a lower bound of the depth of every hit inside.
struct Visit {
    float depth = 0;
    uint32_t node = 0;
};

/// What a step leads to: at most two children, the far one first.
struct Visits {
    std::array<Visit, 2> visit;
    int count = 0;

    void add(const Visit& v) { visit[count++] = v; }
    const Visit* begin() const { return visit.data(); }
    const Visit* end() const { return visit.data() + count; }
};

/// kStackSize: visits that can wait at once; a guarantee of the builder.
template <class Tree, class Ray>
concept RayTree = requires(const Tree& tree, const Ray& ray, const Visit& visit) {
    { Tree::kStackSize } -> std::convertible_to<int>;
    { tree.enter(ray) } -> std::same_as<Visits>;
    { tree.step(visit, ray) } -> std::same_as<Visits>;
    { tree.is_leaf(visit.node) } -> std::same_as<bool>;
    tree.leaf(visit.node);
};

}  // namespace trapeze
