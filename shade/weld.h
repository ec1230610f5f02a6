/// Displaced borders: shared vertices of neighbouring grids go to the same place, with the same normal, since
/// both take what the shader makes of the shared point's own piece (ShadingGrid::border) [decision 0012].
#pragma once

#include <vector>

#include "shade/displace.h"

namespace trapeze {

class BorderWeld {
  public:
    /// Of a grid that is not displaced yet, nor its border: where they are, both share.
    explicit BorderWeld(const ShadingGrid& grid);

    /// The grid and its border are displaced: moves the grid's border vertices, at all keys, by as much as
    /// the border's pieces were moved, and sets their normals but at creases of the undisplaced surface.
    void close(ShadingGrid& grid) const;

  private:
    std::vector<V3f> positions_;  ///< of shared vertices, undisplaced: by key, then vertex
    std::vector<bool> is_smooth_;
};

}  // namespace trapeze
