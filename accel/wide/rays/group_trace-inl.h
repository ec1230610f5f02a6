/// Rays that go alike, on their way through a tree together: what they may meet is found once for all, and
/// fetched before it is their turn. Compiled once a target.
#if defined(TRAPEZE_ACCEL_GROUP_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_GROUP_TRACE_INL_H_
#undef TRAPEZE_ACCEL_GROUP_TRACE_INL_H_
#else
#define TRAPEZE_ACCEL_GROUP_TRACE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <utility>

#include "accel/wide/fetch.h"
#include "accel/wide/rays/grid_list.h"
#include "accel/wide/rays/ray_beam-inl.h"
#include "accel/wide/rays/ray_groups.h"
#include "accel/wide/rays/single_ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// For what is in the way of rays, in which order things are met is all the same. kMotion: something in the
/// tree moves.
template <bool kMotion>
class GroupTrace {
  public:
    /// The fewest rays that are worth while.
    static constexpr size_t kFewest = 6;

    /// Of rays with one main axis and sense, RayGroups::kMost at most; met[i] is what is in the way of
    /// rays[i].
    GroupTrace(const WideTree& tree, std::span<TraceRay> rays, FirstOpaque* met)
        : tree_(tree), count_(rays.size()) {
        RayBeam<kMotion>(tree, rays).list(list_);
        for (size_t i = 0; i < count_; ++i) going_[i].ray.emplace(tree, rays[i], met[i], CountNothing());
    }

    /// In rounds: each ray tests the micropolygons that were fetched for it in the last round, and looks for
    /// the next ones. From memory they come while other rays have their turn.
    void run() {
        for (size_t i = 0; i < count_; ++i) going_[i].ray->visit_unbounded();
        find_met();
        uint8_t order[RayGroups::kMost];
        size_t left = 0;
        for (size_t i = 0; i < count_; ++i) order[left++] = static_cast<uint8_t>(i);
        while (left > 0) {
            size_t kept = 0;
            for (size_t k = 0; k < left; ++k)
                if (step(going_[order[k]])) order[kept++] = order[k];
            left = kept;
        }
    }

  private:
    using Ray = SingleRay<kMotion, FirstOpaque, CountNothing>;
    static constexpr size_t kBelow = 64;  ///< links that may wait

    /// What has been fetched for a ray, and is done when it is its turn.
    enum class Fetched : uint8_t { Nothing, Node, Grid, Boxes };

    /// A ray on its way.
    struct Going {
        std::optional<Ray> ray;
        uint16_t met[GridList::kParts];  ///< what it may meet of each part of the list, a bit each
        uint32_t part = 0;               ///< of the list, where it is
        Fetched fetched = Fetched::Nothing;
        uint32_t link = kNoLink;  ///< of the node or grid that is fetched, or whose boxes are
        uint32_t boxes = 0;       ///< a bit each
        MotionSegment segment;
        uint32_t below = 0;      ///< how many links wait
        uint32_t links[kBelow];  ///< below nodes of the list, the next one last
    };

    /// Finds what each ray may meet of the list, and fetches what some ray may.
    void find_met() {
        for (size_t n = 0; n < list_.parts(); ++n) met_[n] = 0;
        for (size_t i = 0; i < count_; ++i) {
            if (going_[i].ray->ended())
                std::fill_n(going_[i].met, list_.parts(), uint16_t{0});
            else
                going_[i].ray->meet_list(list_, going_[i].met, met_);
        }
        for (size_t n = 0; n < list_.parts(); ++n)
            for (uint32_t met = met_[n]; met != 0; met &= met - 1)
                if (const uint32_t link = link_at(n, met); link & kGridLink) fetch_record(link);
        for (size_t n = 0; n < list_.parts(); ++n)
            for (uint32_t met = met_[n]; met != 0; met &= met - 1)
                if (const uint32_t link = link_at(n, met); link & kGridLink) fetch_keys(link);
    }

    uint32_t link_at(size_t part, uint32_t met) const {
        return list_.links[part * GridList::kPart + static_cast<size_t>(std::countr_zero(met))];
    }

    HWY_INLINE void fetch_record(uint32_t link) const {
        fetch(&tree_.grid(link & ~kGridLink), sizeof(WideGrid));
    }
    HWY_INLINE void fetch_keys(uint32_t link) const {
        const WideGrid& grid = tree_.grid(link & ~kGridLink);
        fetch(tree_.keys_of(grid), std::min(grid.keys_bytes(), kMostFetched));
    }
    HWY_INLINE void fetch_node(uint32_t link) const {
        fetch(&tree_.nodes()[link], sizeof(WideNode));
        if constexpr (kMotion) fetch(&tree_.node_motions()[link], sizeof(WideNodeMotion));
        fetch(&tree_.node_largest(link), sizeof(WideNodeLargest));
    }

    /// What comes next of the list; kNoLink where nothing is left.
    HWY_INLINE uint32_t next_of(Going& going) const {
        for (; going.part < list_.parts(); ++going.part) {
            uint16_t& met = going.met[going.part];
            if (met == 0) continue;
            const uint32_t link = link_at(going.part, met);
            met &= static_cast<uint16_t>(met - 1);
            return link;
        }
        return kNoLink;
    }

    /// A ray's turn: does what was fetched for it, and fetches what comes next; whether something does.
    HWY_INLINE bool step(Going& going) {
        switch (std::exchange(going.fetched, Fetched::Nothing)) {
            case Fetched::Nothing:
                break;
            case Fetched::Node:
                visit_node(going);
                break;
            case Fetched::Grid:
                if (visit_grid(going)) return true;
                break;
            case Fetched::Boxes:
                going.ray->visit_boxes(going.link & ~kGridLink, tree_.grid(going.link & ~kGridLink),
                                       going.segment, going.boxes);
        }
        while (!going.ray->ended()) {
            const bool is_below = going.below > 0;
            going.link = is_below ? going.links[--going.below] : next_of(going);
            if (going.link == kNoLink) return false;
            if (!(going.link & kGridLink)) {
                fetch_node(going.link);
                going.fetched = Fetched::Node;
                return true;
            }
            if (is_below) {
                fetch_keys(going.link);
                going.fetched = Fetched::Grid;
                return true;
            }
            if (visit_grid(going)) return true;  // find_met() has fetched it
        }
        return false;
    }

    /// Lets those of a node's children wait that the ray may meet.
    HWY_INLINE void visit_node(Going& going) {
        if (going.below + WideNode::kChildren > kBelow) return going.ray->descend(going.link);
        const ChildRows rows = tree_.children_of(going.link);
        for (uint32_t met = going.ray->met_children(rows); met != 0; met &= met - 1) {
            const uint32_t link = going.links[going.below++] = rows.links[std::countr_zero(met)];
            if (link & kGridLink) fetch_record(link);
        }
    }

    /// Looks at a grid's boxes; whether any has been fetched.
    HWY_INLINE bool visit_grid(Going& going) {
        const uint32_t index = going.link & ~kGridLink;
        const WideGrid& grid = tree_.grid(index);
        going.boxes = going.ray->met_boxes(grid, going.segment);
        if (going.boxes == 0) return false;
        Ray::fetch_boxes(index, grid, going.segment, going.boxes);
        going.fetched = Fetched::Boxes;
        return true;
    }

    static constexpr size_t kMostFetched = 256;  ///< bytes of a grid's keys

    const WideTree& tree_;
    const size_t count_;
    GridList list_;
    uint16_t met_[GridList::kParts];  ///< by some ray
    Going going_[RayGroups::kMost];
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
