/// The one traversal loop [Hou10 sec. 3.5]. Structures differ in `step`, hit policies in what on_leaf does to
/// the ray's range.
#pragma once

#include "accel/ray_tree.h"

namespace trapeze {

/// What one traversal (or several, added up) looked at: inner nodes stepped through, leaves tested.
struct TraversalStats {
    uint64_t nodes = 0, leaves = 0;
};

/// Visits the leaves that a ray may hit, near ones first as far as bounds tell. on_leaf(leaf, ray) tests what
/// is there and pulls ray.t_max in; it may set it to minus infinity to end. Nodes at exactly t_max are still
/// visited: equal depths are settled by id, so that the answer is that of testing everything.
template <class Ray, RayTree<Ray> Tree, class OnLeaf>
inline void traverse(const Tree& tree, Ray& ray, TraversalStats& stats, OnLeaf&& on_leaf) {
    std::array<Visit, Tree::kStackSize + 2> todo;
    uint32_t waiting = 0;
    // Both places are written and then counted, without a branch: hence two places more than kStackSize.
    const auto push = [&](const Visits& visits) {
        todo[waiting] = visits.visit[0], todo[waiting + 1] = visits.visit[1];
        waiting += visits.count;
    };
    push(tree.enter(ray));
    while (waiting > 0) {
        const Visit at = todo[--waiting];
        // The range may have become shorter since this node was pushed.
        if (at.depth > ray.t_max) continue;
        if (tree.is_leaf(at.node)) {
            ++stats.leaves;
            on_leaf(tree.leaf(at.node), ray);
        } else {
            ++stats.nodes;
            push(tree.step(at, ray));
        }
    }
}

}  // namespace trapeze
