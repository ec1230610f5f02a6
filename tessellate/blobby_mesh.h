/// A Blobby's surface as a mesh of quads: surface nets over a sparse grid of the leaves' neighbourhoods.
/// Every sign change along an edge of the grid makes a quad of the vertices of its four cells, so that the
/// mesh is closed.
#pragma once

#include <vector>

#include "tessellate/blobby_field.h"

namespace trapeze {

struct BlobbyMesh {
    std::vector<V3f> points;
    std::vector<V3f> normals;   ///< away from what is inside, unit length
    std::vector<int> vertices;  ///< four for each quad; (1 - 0) x (3 - 0) points outwards
    /// The leaves that may bear on a point: a list for many, by number.
    std::vector<std::vector<int>> leaf_lists;
    std::vector<int> leaf_list_of_point;
    float cell = 0;  ///< of the grid, as it became
};

/// cell: the grid's, in object space; made larger until time and memory are within bounds.
BlobbyMesh blobby_mesh(const BlobbyField& field, float cell);

/// Moves a point along the gradient onto the surface; by no more than `reach`, and not where the field is
/// flat.
V3f onto_surface(const BlobbyField& field, const BlobbyProgram& program, V3f p, float reach,
                 std::vector<FieldValue>& scratch);

}  // namespace trapeze
