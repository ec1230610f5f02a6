/// Binary trees whose nodes stand in pairs: the sides of inner node i are nodes 2 i and 2 i + 1, and the root
/// is the last.
#pragma once

#include <vector>

#include "accel/builders/sah_topology.h"
#include "accel/ray_tree.h"

namespace trapeze {

/// Sizes the nodes of a topology, and says which is below which.
template <class Nodes>
void link_nodes(const TopTopology& topology, size_t leaf_count, Nodes& nodes) {
    nodes.clear();
    if (leaf_count == 0) return;
    nodes.resize(2 * leaf_count - 1);
    for (size_t i = 0; i < topology.inner.size(); ++i)
        for (const size_t side : {0, 1}) nodes[2 * i + side].link = topology.inner[i][side];
    nodes.back().link = topology.root;
}

/// The root of so many nodes, and the sides of an inner one, by the number that its link is: those that
/// meet(node, visit) says the ray meets. It sets the visit in any case.
template <class Meet>
Visits enter_paired(size_t nodes, const Meet& meet) {
    if (nodes == 0) return {};
    Visit root;
    const bool met = meet(nodes - 1, root);
    return Visits::one(root, met);
}
template <class Meet>
Visits step_paired(uint32_t inner, const Meet& meet) {
    const size_t first = 2 * size_t{inner};
    std::array<Visit, 2> children;
    const bool met_first = meet(first, children[0]), met_second = meet(first + 1, children[1]);
    return Visits::two(children, met_first, met_second);
}

}  // namespace trapeze
