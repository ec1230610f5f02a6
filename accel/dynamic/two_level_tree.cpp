#include "accel/dynamic/two_level_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace trapeze {
namespace {

/// About a voxel an object, at the lowest level.
LooseOptions options_for(size_t objects) {
    constexpr int kMostAlongASide = 6;
    const int halvings = std::bit_width(objects) - 1;
    return {.levels = 3 * std::clamp((halvings + 1) / 3, 1, kMostAlongASide)};
}

}  // namespace

void TwoLevelTree::build(const Grids& grids) {
    objects_.read(grids);
    moves_.assign(objects_.boxes.size(), 0);
    moving_.clear();
    more_move_ = false;
    std::vector<uint32_t> all(moves_.size());
    std::iota(all.begin(), all.end(), 0u);
    still_.build(objects_, std::move(all));
    place();
}

void TwoLevelTree::note_moved(uint32_t object) {
    if (moves_[object]) return;
    moves_[object] = 1;
    moving_.push_back(object);
    more_move_ = true;
}

void TwoLevelTree::place() {
    if (std::exchange(more_move_, false)) still_.take_out(objects_, moves_);
    loose_.build(options_for(moving_.size()), objects_, moving_);
}

void TwoLevelTree::update(const Grids& grids) {
    const std::vector<KeyBox> before = objects_.boxes;
    objects_.read(grids);
    if (objects_.boxes.size() != before.size()) {
        build(grids);
        return;
    }
    for (uint32_t object = 0; object < before.size(); ++object)
        if (!same_box(before[object], objects_.boxes[object])) note_moved(object);
    place();
}

void TwoLevelTree::update(const Grids& grids, std::span<const uint32_t> changed) {
    if (!objects_.reread(grids, changed)) {
        update(grids);
        return;
    }
    for (const uint32_t grid : changed)
        for (uint32_t object = objects_.first_of(grid); object < objects_.first_of(grid + 1); ++object)
            note_moved(object);
    place();
}

BuildStats TwoLevelTree::stats() const {
    BuildStats stats;
    stats.tree_bytes = sizeof(*this) + objects_.bytes() + still_.bytes() + loose_.bytes() +
                       moves_.capacity() + moving_.capacity() * sizeof(uint32_t);
    stats.tree_nodes = still_.size() + loose_.size();
    stats.tree_leaves = objects_.boxes.size();
    return stats;
}

}  // namespace trapeze
