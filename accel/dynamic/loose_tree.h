/// The loose hierarchy: a binary tree of a fixed number of levels into which objects are put by their middles
/// and sizes alone [DynBvh06 sec. 3.2]. A frame is emptied, filled and bounded anew, in time linear in its
/// objects and nodes; nothing is compared with anything.
#pragma once

#include <cstdint>

#include "accel/dynamic/frame_boxes.h"
#include "accel/dynamic/loose_nodes.h"

namespace trapeze {

class LooseTree {
  public:
    explicit LooseTree(const LooseOptions& options = {}) : options_(options) {}

    /// Keeps a reference to the grids. Objects are read and placed in parallel.
    void build(const Grids& grids);
    /// Nothing of the frame before is of use: what moves costs no more than what stands still.
    void update(const Grids& grids) { build(grids); }

    /// Shows the policy the hits of a ray, near ones first as far as boxes tell.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        ++stats.rays;
        objects_.test_unbounded(ray, policy, stats);
        nodes_.trace(objects_, ray, policy, stats);
    }

    BuildStats stats() const;
    /// Of all objects, which are the members, in order.
    const LooseNodes& nodes() const { return nodes_; }

  private:
    LooseOptions options_;
    FrameBoxes objects_;
    LooseNodes nodes_;
};

}  // namespace trapeze
