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
    /// Where no split lowers the SAH cost: medians of the orientation-aware order; else the best split all
    /// the same [Hou10 sec. 3.3].
    bool orient_split = true;
    /// A node above grids takes the better orientation of its children's; else it is axis-aligned.
    bool orient_propagation = true;
    /// The paper's own leaves have fewer than 8 micropolygons; at most kMostSplitFrom.
    int leaf = 8;  ///< splits end at fewer micropolygons than this

    bool oriented() const { return bounds == Bounds::Oriented; }
};

}  // namespace trapeze
