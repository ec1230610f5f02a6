/// What rasterizers know of grids beforehand: boxes at motion keys, and how far rounding may move what is
/// seen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/scene/camera.h"
#include "sample/patterns/strata.h"
#include "sample/swept_bound.h"

namespace trapeze {

/// How far, in the image plane, the predicate may see a vertex from its place by rounding: near / z + far,
/// much to spare. For orthographic cameras `near` is 0.
struct RoundingSlack {
    float near = 0, far = 0;
};

/// What holds for one grid at all of its keys. Made once for a region; slots and tuples then bound the grid
/// further, for their times and lens points.
struct GridBound {
    RoundingSlack slack;
    float z_min = 0;        ///< over all keys
    float z_safe = 0;       ///< vertices nearer than this have no bound on the raster
    float z_rounding = 0;   ///< of interpolated depths
    bool boundable = true;  ///< else nothing is known of where it is seen
};

/// Part of one motion segment.
struct SegmentPart {
    int segment;
    float from, to;  ///< local time
};

/// The parts of a grid's segments that a time span covers; appended to `parts`.
void segment_parts(const TimeSpan& time, int key_count, std::vector<SegmentPart>& parts);

/// What a grid may cover of the raster in a slot, and its least depth.
struct SlotBound {
    RasterBox box;
    float z_min;
};

/// Bounds of all grids; read from many threads. Refers to the camera.
class GridBounds {
  public:
    /// Camera space, at the two ends of a segment.
    struct SegmentBox {
        V3f min[2], max[2];
    };

    /// In parallel; the same for any number of threads.
    GridBounds(const Camera& camera, const Grids& grids);

    const GridBound& operator[](size_t grid) const { return bounds_[grid]; }

    /// The boxes of a grid's segments follow each other.
    const SegmentBox& segment_box(size_t grid, int segment) const {
        return segments_[first_segment_[grid] + static_cast<size_t>(segment)];
    }

    /// The part of the raster that a grid may cover, conservative for samples of all times in `parts` and
    /// lens points in `lens`. Everything where some of it may be too near to be divided by its depth.
    SlotBound slot_bound(size_t grid, const std::vector<SegmentPart>& parts, const LensBox& lens) const;

    size_t bytes() const;

  private:
    void bound_grid(const Grid& grid, size_t index);

    const Camera& camera_;
    std::vector<GridBound> bounds_;
    std::vector<size_t> first_segment_;  ///< grid -> in segments_
    std::vector<SegmentBox> segments_;
};

/// A grid with what is known of all.
struct BoundedGrid {
    const Grid& grid;
    uint32_t index;
    const GridBounds& bounds;
};

}  // namespace trapeze
