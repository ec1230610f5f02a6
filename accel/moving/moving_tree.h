/// A binary tree over micropolygons whose nodes have a box at each of some motion keys, interpolated at the
/// time of a ray [Christensen06]: what all papers on moving boxes compare with. With a budget for spatial
/// splits it is the MSBVH [Gruenschloss11]: its topology is that of micropolygons at mid-shutter where planes
/// may cut them [Stich09], and a leaf's boxes are those of the parts that it refers to, wherever they are at
/// the keys. Or it is a linear tree [Lauterbach09], which is built fastest.
///
/// Departs from the papers: micropolygons instead of triangles; the one predicate, which also decides in
/// which order hits are; boxes are grown for rounding, and the depth at which they are entered is taken less
/// by the size of the largest micropolygon in them [decision 0004]. So the tree finds what testing everything
/// finds, bit for bit, but for naive clipping, which is wrong. Parts that the second form of clipping makes
/// hold a micropolygon only all together: a hit outside of its leaf's box counts. Instances, and weights of
/// keys other than linear, are not there: grids have neither.
#pragma once

#include "accel/builders/build_clock.h"
#include "accel/moving/moving_options.h"
#include "accel/moving/spatial_topology.h"
#include "accel/moving/swept_boxes.h"
#include "accel/paper/list_tree.h"

namespace trapeze {

/// Threads may trace at once, but not while refit() changes it.
class MovingTree final : public ListTree {
  public:
    /// Builds in parallel. Keeps a reference to the grids. At most 2^30 micropolygons and parts.
    explicit MovingTree(const Grids& grids, const MovingTreeOptions& options = {});

    /// Takes the grids of another frame of the same sequence, in place of those that the tree has, which must
    /// still be there: nodes and lists stay, and boxes are made anew, in parallel. A micropolygon of which
    /// several leaves have a part is cut again, by each leaf's box as it was at the last frame's shutter
    /// close [Gruenschloss11 sec. 5]: together the boxes hold all of it then, and so wherever it is. Grids of
    /// other shapes are built. Keeps a reference to the grids.
    void refit(const Grids& grids);

  private:
    struct Sources;
    struct LeafBoxes;
    struct LastFrame;

    void build();
    /// Makes a tree by the surface area heuristic, with splits if there is a budget for them.
    void build_spatial(const SweptBoxes& boxes, PhaseClock& clock, BuildPhases& phases);
    /// Whether the lists have all micropolygons of grids, and no others.
    bool lists_hold(const Grids& grids) const;
    /// What refit() keeps of the frame that the tree is of; `times`: how many references each micropolygon
    /// has.
    LastFrame last_frame(std::vector<uint32_t> times) const;
    /// Bounds all nodes.
    void bound(const Sources& sources);
    /// The boxes of what reference `r` of a list is to, at any number of keys; `whole`: those of its
    /// micropolygon, at the keys of its grid.
    std::span<const Box3f> boxes_of(const Sources& sources, size_t r, size_t list,
                                    std::span<const Box3f> whole, LeafBoxes& boxes);
    void bound_leaf(const Sources& sources, size_t node, LeafBoxes& boxes);
    /// Bounds a node and all below it. Returns the sum of their mean areas, each times the steps that it
    /// takes: one, or of a leaf its tests.
    double bound_below(const Sources& sources, size_t node, int depth, LeafBoxes& boxes);
    /// The area of a node's box, as a mean of the shutter but for a factor. A node is met with the ratio of
    /// its area to the root's, which is what stats() say of the surface area heuristic; a step costs as much
    /// as a test.
    double mean_area(size_t node) const;

    MovingTreeOptions options_;
};

}  // namespace trapeze
