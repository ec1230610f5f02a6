/// The choices of trees whose boxes are interpolated between motion keys.
#pragma once

#include <cstdint>

namespace trapeze {

/// Defaults are the plain tree, which all papers on moving boxes compare with [Christensen06].
struct MovingTreeOptions {
    /// Where a part of a micropolygon, in a box at mid-shutter, is taken to be at other times.
    enum class Clipping {
        Polygon,  ///< its polygon moves with the corners [Gruenschloss11 sec. 3.1.1]
        Box,      ///< the box moves as the whole micropolygon's does [Gruenschloss11 sec. 3.1.2, eq. 1]
        Naive     ///< the box of its polygon moves so: hits are lost [Gruenschloss11 fig. 3]
    };

    /// What divides micropolygons at mid-shutter.
    enum class Topology {
        Sah,    ///< the surface area heuristic, with spatial splits where there is a budget for them
        Morton  ///< the order of Morton codes [Lauterbach09]
    };

    /// Spatial splits: parts that may be added, for each micropolygon; 0: none are made.
    double budget = 0;
    Clipping clipping = Clipping::Polygon;
    /// Boxes of a node, evenly spaced over the shutter, 1 or 2^m + 1; 0: as many keys as any grid has.
    int keys = 0;
    /// Leaves have fewer micropolygons, or parts.
    int leaf = 8;
    Topology topology = Topology::Sah;
};

}  // namespace trapeze
