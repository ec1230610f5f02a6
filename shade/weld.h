/// Displaced borders: shared vertices of neighbouring grids go to the same place, with the same normal, since
/// both take what the shader makes of the shared point's own piece (ShadingGrid::border).
#pragma once

#include <vector>

#include "shade/displace.h"

namespace trapeze {

/// To be called before pieces are displaced: keeps their positions as P[1].
void remember_undisplaced(ShadingGrid& pieces);

/// Moves the vertices of border pieces, and finds their normals from the moved P unless the shader set N.
/// Vertices that would move to no finite place stay.
void displace_pieces(const Displaced& displaced, ShadingGrid& pieces);

class BorderWeld {
  public:
    /// Of a grid that is not displaced yet, nor its border.
    explicit BorderWeld(const ShadingGrid& grid);

    /// The grid and its border are displaced: moves the grid's border vertices, at all keys, by as much as
    /// the border's pieces were moved, and sets their normals but at creases of the undisplaced surface.
    void close(ShadingGrid& grid) const;

  private:
    std::vector<V3f> positions_;  ///< of shared vertices, undisplaced: by key, then vertex
    std::vector<bool> is_smooth_;
};

}  // namespace trapeze
