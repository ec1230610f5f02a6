/// Displaced borders: shared vertices of neighbouring grids go to the same place, with the same normal, since
/// both take what the shader makes of the shared point's own piece (ShadingGrid::border) [decision 0012].
#pragma once

#include <vector>

#include "shade/displace.h"

namespace trapeze {

/// Remembers where a grid's shared vertices are, before displacement, and moves them to where their pieces
/// went.
class BorderWeld {
  public:
    /// Takes positions and normals of a grid that is not displaced yet, nor its border: both have them from
    /// the same place.
    explicit BorderWeld(const ShadingGrid& grid);

    /// Moves the grid's border vertices, at all keys, by as much as the border's pieces were moved, and sets
    /// their normals, except at creases of the undisplaced surface. The grid and its border are displaced by
    /// then.
    void close(ShadingGrid& grid) const;

  private:
    std::vector<V3f> positions_;   ///< of shared vertices, undisplaced: by key, then vertex
    std::vector<bool> is_smooth_;  ///< by shared vertex: grid and border meet without a crease
};

}  // namespace trapeze
