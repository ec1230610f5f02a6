/// Parts of micropolygons, as spatial splits make them: what lies on either side of a plane, and where what
/// is in a box at mid-shutter is at other times [Gruenschloss11 sec. 3.1.1].
///
/// A micropolygon is its two triangles, 00-10-11 and 00-11-01: whatever a ray sees of it by the even-odd rule
/// lies in one of them. Vertices of a part are weights on the corners; a point of fixed weights moves
/// linearly between keys, as the corners do, so that boxes of a part at the keys bound it in between.
#pragma once

#include <array>
#include <span>

#include "core/grid.h"

namespace trapeze {

/// The corners 00, 10, 01, 11 of a micropolygon at some time, in camera space.
using QuadPose = std::array<V3f, 4>;

/// By Grid::vertex(): the corners as the predicate has them, bit for bit.
QuadPose pose_of(const Grid& grid, const MicropolygonId& id, float time01);
Box3f box_of(const QuadPose& pose);

/// The boxes of what lies on either side of a plane; empty where nothing does.
struct Chopped {
    Box3f low, high;
};

/// Divides the part of a micropolygon that is in `box` by the plane where coordinate `axis` is `at`. The
/// boxes are as small as the edges of its triangles say, within rounding (`part_slack()` covers it).
Chopped chop(const QuadPose& pose, const Box3f& box, int axis, float at);

/// What boxes of chop() may lack on any side by rounding; for poses within kBoundableCoordinate.
float part_slack(const QuadPose& pose);

/// The part of a micropolygon in a box: polygons of at most nine vertices, one a triangle [Sutherland74].
class MicropolygonPart {
  public:
    /// Of `pose` in `box`, which is grown by part_slack().
    MicropolygonPart(const QuadPose& pose, const Box3f& box);

    /// Of nothing, which a box that only just touches a micropolygon may hold.
    bool is_empty() const { return count_ == 0; }
    /// The box of its vertices when the corners are elsewhere; not grown.
    Box3f box_when(const QuadPose& pose) const;

  private:
    static constexpr size_t kMostVertices = 18;

    std::array<std::array<double, 4>, kMostVertices> weights_;  ///< of vertices, on the corners
    size_t count_ = 0;
};

}  // namespace trapeze
