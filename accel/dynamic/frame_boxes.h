/// The micropolygons of one frame of a sequence as structures that are updated see them: objects, each in a
/// box that holds it while the shutter is open.
#pragma once

#include <span>
#include <vector>

#include "accel/grid_block.h"
#include "accel/slabs.h"
#include "core/grid.h"
#include "core/stats.h"

namespace trapeze {

/// Objects count in the order of grids and then of rows. Frames with grids of the same shapes have the same
/// objects.
struct FrameBoxes {
    const Grids* grids = nullptr;
    std::vector<MicropolygonId> ids;        ///< of objects
    std::vector<KeyBox> boxes;              ///< of objects, along the axes of space, grown for rounding
    std::vector<MicropolygonId> unbounded;  ///< no objects: what any ray may meet
    float absolute_max = 0;                 ///< the objects' largest coordinate
    float quad_extent = 0;                  ///< the longest side of any object's box at any motion key

    /// Reads a frame, in parallel. Keeps a reference to the grids.
    void read(const Grids& frame);

    size_t bytes() const {
        return (ids.capacity() + unbounded.capacity()) * sizeof(MicropolygonId) +
               boxes.capacity() * sizeof(KeyBox);
    }

    template <class Policy>
    void test_object(uint32_t object, TraceRay& ray, Policy& policy, SampleStats& stats) const {
        test_micropolygon(grids->grids[ids[object].grid], ids[object], ray, policy, stats);
    }
    template <class Policy>
    void test_unbounded(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        for (const MicropolygonId& id : unbounded)
            test_micropolygon(grids->grids[id.grid], id, ray, policy, stats);
    }
};

/// Empty: it holds nothing, and joined with another it is that.
KeyBox empty_box();
bool is_empty(const KeyBox& box);
KeyBox joined(const KeyBox& a, const KeyBox& b);
bool holds(const KeyBox& outer, const KeyBox& inner);
bool same_box(const KeyBox& a, const KeyBox& b);
/// Half of its surface; 0 of an empty one.
float half_area_of(const KeyBox& box);

}  // namespace trapeze
