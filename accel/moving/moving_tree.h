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

#include "accel/moving/moving_options.h"
#include "accel/moving/spatial_topology.h"
#include "accel/paper/list_tree.h"

namespace trapeze {

class MovingTree final : public ListTree {
  public:
    /// Builds in parallel. Keeps a reference to the grids. At most 2^30 micropolygons and parts.
    explicit MovingTree(const Grids& grids, const MovingTreeOptions& options = {});

  private:
    struct Sources;

    /// Bounds nodes that are leaves.
    void bound_leaves(const Sources& sources, const SpatialTopology& topology);
    /// Bounds the node of an inner link, and all inner ones below it, by their children.
    void bound_below(const TopTopology& topology, TopLink link, size_t node, int depth);
};

}  // namespace trapeze
