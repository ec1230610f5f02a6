#include "accel/wide/extent_tree.h"

#include <cmath>

namespace trapeze {

ExtentTree::ExtentTree(std::span<const GridExtent> extents) {
    std::vector<uint32_t> bounded;
    for (uint32_t i = 0; i < extents.size(); ++i) {
        if (!std::isfinite(extents[i].absolute_max)) {
            unbounded_.push_back(i);
            continue;
        }
        bounded.push_back(i);
    }
    if (!bounded.empty()) nodes_ = build_wide_top(extents, bounded);
    largest_.resize(nodes_.size());
    // What is below a node comes after it, and is known first.
    for (size_t n = nodes_.size(); n-- > 0;)
        for (int i = 0; i < nodes_[n].count; ++i) {
            const uint32_t link = nodes_[n].child[i].link;
            Largest& largest = largest_[n][static_cast<size_t>(i)];
            if (link & kGridLink) {
                const GridExtent& extent = extents[link & ~kGridLink];
                largest = {extent.absolute_max, extent.largest_micropolygon};
                continue;
            }
            for (const Largest& below : largest_[link]) {
                largest.coordinate = std::max(largest.coordinate, below.coordinate);
                largest.extent = std::max(largest.extent, below.extent);
            }
        }
}

/// Record and keys are made for the extent alone, and thrown away. It grows as for a ray without slope from
/// the origin; visit() adds what rounds for the ray at hand.
GridExtent extent_of(const Grid& grid) {
    WideGrid record;
    record.nu = grid.shape.nu, record.nv = grid.shape.nv, record.key_count = grid.key_count;
    record.first_pair = 0;
    std::vector<uint8_t> keys(record.keys_bytes());
    GridExtent extent;
    bound_grid(grid, kTraceRounding, 0x1p-80f, record, keys.data(), extent);
    return extent;
}

/// Boxes are linear over the shutter: those about both at its two ends hold both at all times.
GridExtent united(const GridExtent& a, const GridExtent& b) {
    GridExtent both = a;
    for (int end = 0; end < 2; ++end)
        for (int k = 0; k < 3; ++k) {
            float &low = both.box.at[end].low[k], &high = both.box.at[end].high[k];
            low = std::min(low, b.box.at[end].low[k]), high = std::max(high, b.box.at[end].high[k]);
        }
    both.absolute_max = std::max(a.absolute_max, b.absolute_max);
    both.largest_micropolygon = std::max(a.largest_micropolygon, b.largest_micropolygon);
    return both;
}

}  // namespace trapeze
