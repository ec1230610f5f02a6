/// The choices of the paper's controlled study [Hou10 table 4].
#pragma once

namespace trapeze {

/// Defaults are the paper's own method.
struct PaperTreeOptions {
    /// What a node is bounded by. The topology is the same for all of them.
    enum class Bounds {
        Oriented,     ///< OBB hyper-trapezoids
        AxisAligned,  ///< AABB hyper-trapezoids
        WholeMotion   ///< one axis-aligned box for all times: the paper's 4D AABB
    };

    Bounds bounds = Bounds::Oriented;
    /// What is done where no split lowers the SAH cost. True: the median of the orientation-aware order is
    /// split at [Hou10 sec. 3.3]. False: the best of the splits is taken all the same.
    bool orient_split = true;
    /// A node above grids takes the better orientation of its children's; else it is axis-aligned.
    bool orient_propagation = true;
    /// The paper's own leaves have fewer than 8 micropolygons; at most kMostSplitFrom.
    int leaf = 8;  ///< splits end at fewer micropolygons than this
    /// A node above grids is bounded by merging its children's boxes alone, as the paper says it
    /// [Hou10 sec. 3.3]; else from what is in its leaves, where these are few [decision 0008].
    bool bounds_from_children = false;
    /// A ray is turned once into the axes that several nodes on its way have; else anew at each.
    bool keep_turned_rays = false;

    bool oriented() const { return bounds == Bounds::Oriented; }
};

}  // namespace trapeze
