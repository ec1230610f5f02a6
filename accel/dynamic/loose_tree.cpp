#include "accel/dynamic/loose_tree.h"

#include <numeric>

namespace trapeze {

void LooseTree::build(const Grids& grids) {
    objects_.read(grids);
    std::vector<uint32_t> all(objects_.boxes.size());
    std::iota(all.begin(), all.end(), 0u);
    nodes_.build(options_, objects_, std::move(all));
}

BuildStats LooseTree::stats() const {
    BuildStats stats;
    stats.tree_bytes = sizeof(*this) + objects_.bytes() + nodes_.bytes();
    stats.tree_nodes = nodes_.size();
    stats.tree_leaves = (nodes_.size() + 1) / 2;
    return stats;
}

}  // namespace trapeze
