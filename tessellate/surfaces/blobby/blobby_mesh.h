/// A Blobby's surface as a mesh: surface nets over the blocks of blobby_blocks.h, as dual contouring has them
/// on octrees [Ju02, "Dual Contouring of Hermite Data"]. Every sign change along an edge of the grid, of the
/// finest cells round it, makes a polygon of these cells' vertices: the mesh is closed, whatever the cells'
/// sizes.
#pragma once

#include <vector>

#include "tessellate/surfaces/blobby/blobby_blocks.h"

namespace trapeze {

/// A closed mesh in object space.
struct BlobbyMesh {
    std::vector<V3f> points;
    std::vector<V3f> normals;   ///< away from what is inside, unit length
    std::vector<int> sizes;     ///< of the polygons: 4, and 3 where cells of several sizes meet
    std::vector<int> vertices;  ///< of one polygon after the other; (1 - 0) x (last - 0) points outwards
    /// The leaves that may bear on a point, and its cell's size: a list for many, by number.
    std::vector<std::vector<int>> leaf_lists;
    std::vector<float> list_cells;
    std::vector<int> leaf_list_of_point;
    float coarser = 1;  ///< than was asked for, to keep time and memory within bounds
};

/// Makes the mesh of a field; cells grow until blocks and operations are within bounds. Empty where the field
/// has no surface. The same for any number of threads.
BlobbyMesh blobby_mesh(const BlobbyField& field, const CellSizes& cells,
                       double most_operations = kMostBlobbyOperations);

/// Moves a point along the gradient towards where the field is kBlobbyThreshold; by no more than `reach`, and
/// not where the field is flat. Only nearer or not at all.
V3f onto_surface(const BlobbyField& field, const BlobbyProgram& program, V3f p, float reach,
                 std::vector<FieldValue>& scratch);

}  // namespace trapeze
