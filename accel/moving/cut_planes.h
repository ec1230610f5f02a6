/// The plane that cuts a node of a tree at the least cost of the surface area heuristic [Stich09 sec. 4.3]:
/// what spatial splits choose from, and what they cost most time for.
#pragma once

#include <limits>
#include <span>

#include "accel/builders/sah_topology.h"
#include "accel/moving/lane_pose.h"

namespace trapeze {

/// A plane that cuts a node, what the node costs then, and the boxes and numbers of references on its sides.
struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 0;
    float at = 0;
    Box3f low, high;
    size_t low_count = 0, high_count = 0;
    /// No plane of the same slabs costs less, whatever is in the boxes that it cuts: sides hold what they
    /// hold whole. But for parts whose boxes are larger than their polygons: some cuts of such are not found.
    double least = std::numeric_limits<double>::infinity();
};

/// Looks for planes between slabs of equal width, of which large nodes have more than small ones.
class CutPlanes {
  public:
    /// `poses`: micropolygon -> where it is, by PartId::index(); they are looked at if planes are to cut
    /// polygons (tight), else none are needed. Keeps references.
    CutPlanes(std::span<const LanePose> poses, bool tight) : poses_(poses), tight_(tight) {}

    /// The cheapest of the planes along that axis which is best if boxes are cut without looking at what is
    /// in them: that tells the axis, and spares two thirds of the work. What is in them is not looked at
    /// either where no plane can cost less than `to_beat`. Cost infinite where there is none. `box`: of the
    /// references.
    Cut best(std::span<const SahItem> references, const Box3f& box, double to_beat) const;
    /// The two parts of a reference's box: those of its polygon (tight), or of the box alone.
    LaneChopped divided(const SahItem& reference, int axis, float at) const;

  private:
    std::span<const LanePose> poses_;
    bool tight_;
};

}  // namespace trapeze
