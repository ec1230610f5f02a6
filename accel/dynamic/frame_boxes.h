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
    /// Reads a frame that differs from the one before in these grids alone, by number: in time linear in
    /// them. False, with nothing changed, where it has other objects, or some that are none: read it all. The
    /// extents are then at least those of the frame.
    bool reread(const Grids& frame, std::span<const uint32_t> changed);
    /// The objects of a grid, from the first on; where nothing is unbounded.
    uint32_t first_of(uint32_t grid) const { return first_[grid]; }

    /// Memory held; the grids' own is not counted.
    size_t bytes() const {
        return (ids.capacity() + unbounded.capacity()) * sizeof(MicropolygonId) +
               boxes.capacity() * sizeof(KeyBox) + first_.capacity() * sizeof(uint32_t);
    }

    /// Puts an object to the predicate, at the time of the ray; its box is not asked.
    template <class Policy>
    void test_object(uint32_t object, TraceRay& ray, Policy& policy, SampleStats& stats) const {
        test_micropolygon(grids->grids[ids[object].grid], ids[object], ray, policy, stats);
    }
    /// What every ray has to be tested against once, before a tree is walked through.
    template <class Policy>
    void test_unbounded(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        for (const MicropolygonId& id : unbounded)
            test_micropolygon(grids->grids[id.grid], id, ray, policy, stats);
    }

  private:
    std::vector<uint32_t> first_;  ///< micropolygons before each grid's, and all
};

/// Empty: it holds nothing, and joined with another it is that.
KeyBox empty_box();
/// Looks at the first axis alone: boxes here are empty along all axes or none.
bool is_empty(const KeyBox& box);
/// The smallest box about both; an empty one adds nothing.
KeyBox joined(const KeyBox& a, const KeyBox& b);
/// Whether all of `inner` is in `outer`, sides included. Any box holds an empty one.
bool holds(const KeyBox& outer, const KeyBox& inner);
/// Exact, so that objects that have not moved are recognised. Lane 3 is not looked at.
bool same_box(const KeyBox& a, const KeyBox& b);
/// Half of its surface; 0 of an empty one.
float half_area_of(const KeyBox& box);

}  // namespace trapeze
