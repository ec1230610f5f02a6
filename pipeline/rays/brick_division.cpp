#include "pipeline/rays/brick_division.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "accel/builders/morton_order.h"
#include "accel/builders/sah_topology.h"

namespace trapeze {
namespace {

bool is_bounded(const RunExtent& run) {
    return std::isfinite(run.extent.absolute_max);
}

/// Adds bricks to a division.
class BrickDivider {
  public:
    BrickDivider(const std::vector<RunExtent>& runs, size_t most_bytes, BrickDivision& division)
        : runs_(runs), most_bytes_(most_bytes), division_(division) {}

    /// All that are bounded.
    void divide_space() {
        for (uint32_t i = 0; i < runs_.size(); ++i) {
            if (!is_bounded(runs_[i])) continue;
            const KeyBounds& box = runs_[i].extent.box.at[0];
            SahItem& item = items_.emplace_back();
            item.id = i, item.weight = std::max(runs_[i].bytes, 1u);
            for (int k = 0; k < 3; ++k) item.box.min[k] = box.low[k], item.box.max[k] = box.high[k];
        }
        if (items_.empty()) return;
        SahOptions options;
        options.split_anyway = true;
        options.fallback_order = [](std::span<SahItem> part) {
            sort_by_orientation(part, [](uint32_t) { return V3f(0, 0, 1); });
        };
        const SahTopology sorted = build_sah_topology(items_, options);
        leaf_first_ = sorted.leaf_first;
        measure(sorted.tree);
        divide(sorted.tree, sorted.tree.root);
    }

    /// Those that have no bounds, in the order in which they come.
    void divide_rest() {
        std::vector<uint32_t> part;
        size_t bytes = 0;
        for (uint32_t i = 0; i < runs_.size(); ++i) {
            if (is_bounded(runs_[i])) continue;
            if (!part.empty() && bytes + runs_[i].bytes > most_bytes_) {
                add_brick(part);
                part.clear(), bytes = 0;
            }
            part.push_back(i), bytes += runs_[i].bytes;
        }
        if (!part.empty()) add_brick(part);
    }

  private:
    /// Leaves below an inner node, from the first to behind the last, and the bytes of what they hold.
    struct Below {
        uint32_t first, end;
        size_t bytes;
    };

    Below below(TopLink link) const {
        if (!link.is_leaf()) return below_[link.index()];
        const uint32_t leaf = link.index();
        size_t bytes = 0;
        for (uint32_t i = leaf_first_[leaf]; i < leaf_first_[leaf + 1]; ++i) bytes += items_[i].weight;
        return {leaf, leaf + 1, bytes};
    }

    /// Children come after their parents.
    void measure(const TopTopology& tree) {
        below_.resize(tree.inner.size());
        for (size_t i = tree.inner.size(); i-- > 0;) {
            const Below left = below(tree.inner[i][0]), right = below(tree.inner[i][1]);
            below_[i] = {left.first, right.end, left.bytes + right.bytes};
        }
    }

    /// Not deeper than kTopDepthLimit.
    void divide(const TopTopology& tree, TopLink link) {
        const Below here = below(link);
        if (link.is_leaf() || here.bytes <= most_bytes_) {
            std::vector<uint32_t> part;
            for (uint32_t i = leaf_first_[here.first]; i < leaf_first_[here.end]; ++i)
                part.push_back(items_[i].id);
            return add_brick(part);
        }
        for (const TopLink child : tree.inner[link.index()]) divide(tree, child);
    }

    void add_brick(std::vector<uint32_t>& part) {
        std::ranges::sort(part, {}, [&](uint32_t i) { return runs_[i].run.first; });
        GridExtent extent = runs_[part.front()].extent;
        for (const uint32_t i : part) {
            extent = united(extent, runs_[i].extent);
            division_.runs.push_back(runs_[i].run);
        }
        division_.extents.push_back(extent);
        division_.first.push_back(static_cast<uint32_t>(division_.runs.size()));
    }

    const std::vector<RunExtent>& runs_;
    const size_t most_bytes_;
    BrickDivision& division_;
    std::vector<SahItem> items_;
    std::vector<uint32_t> leaf_first_;
    std::vector<Below> below_;
};

}  // namespace

BrickDivision divide_into_bricks(const std::vector<RunExtent>& runs, size_t most_bytes) {
    BrickDivision division;
    division.first.push_back(0);
    division.runs.reserve(runs.size());
    BrickDivider divider(runs, most_bytes, division);
    divider.divide_space();
    divider.divide_rest();
    return division;
}

}  // namespace trapeze
