/// Two trees: one of what has moved, filled anew in each frame, and one of all else, which stays but for what
/// is taken out of it when it begins to move. What moves in a large scene that does not is sorted in a space
/// of its own size: the report on updated trees proposes two levels where the loose hierarchy fails, the
/// "teapot in the stadium" [DynBvh06 sec. 4 and 5].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/dynamic/box_tree.h"
#include "accel/dynamic/frame_boxes.h"
#include "accel/dynamic/loose_nodes.h"

namespace trapeze {

/// What has moved once counts as moving from then on. Frames are read by many threads; rays may be traced
/// from many while it stays.
class TwoLevelTree {
  public:
    /// All of a first frame stands still. Keeps a reference to the grids, as update() does.
    void build(const Grids& grids);
    /// Looks for what has moved. A frame with another number of objects is built.
    void update(const Grids& grids);
    /// The same where only these grids, by number, differ from the frame before: in time linear in what has
    /// moved by now, where nothing is new to that.
    void update(const Grids& grids, std::span<const uint32_t> changed);

    /// Shows the policy the hits of a ray.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        ++stats.rays;
        objects_.test_unbounded(ray, policy, stats);
        loose_.trace(objects_, ray, policy, stats);
        still_.trace(objects_, ray, policy, stats);
    }

    BuildStats stats() const;
    /// Objects that have moved by now.
    size_t moving() const { return moving_.size(); }

  private:
    void note_moved(uint32_t object);
    void place();

    FrameBoxes objects_;
    std::vector<uint8_t> moves_;    ///< of objects: in moving_
    std::vector<uint32_t> moving_;  ///< objects
    bool more_move_ = false;        ///< than still_ knows
    BoxTree still_;
    LooseNodes loose_;
};

}  // namespace trapeze
