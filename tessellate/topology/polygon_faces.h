/// Polygons as faces of three and four corners, the pieces that are diced.
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "core/scene/shapes.h"

namespace trapeze {

/// Faces of a mesh, one after the other. `corners` leads back to the file's numbering, by which variables of
/// class facevarying are found.
struct PolygonFaces {
    std::vector<int> sizes;     ///< 3 or 4 corners
    std::vector<int> vertices;  ///< of all faces' corners
    std::vector<int> corners;   ///< where each comes from among the polygons' corners: facevarying's number
    std::vector<int> polygons;  ///< by face
};

/// Convex planar quads stay whole, all else becomes triangles, which run the way of their polygon and name
/// its vertices only. Faces that would name a vertex twice are left out. `keys`: one or more, three floats a
/// vertex; what is cut is cut as it covers the polygon best over all of them, else as at the first.
PolygonFaces make_polygon_faces(const PolygonMesh& mesh, std::span<const std::span<const float>> keys);

/// Polygons of three and four corners without holes as they are: quads stay whole, flat or not.
PolygonFaces make_whole_faces(const PolygonMesh& mesh);

}  // namespace trapeze
