/// Control cages of Catmull-Clark surfaces with creases: turned and flat things put together from points.
#pragma once

#include <functional>
#include <vector>

#include "core/math.h"
#include "pipeline/study/scenes/rib_writer.h"

namespace trapeze::scenes {

/// A cage while it is put together.
struct Cage {
    std::vector<V3d> points, colors;  ///< no colours: that of the attributes
    Integers sizes, corners;          ///< numbers of points of each face; the points, face by face

    Integers holes;  ///< faces that are not drawn

    /// A chain of points along which the surface keeps an edge; sharpness as in RISpec's "crease".
    struct Crease {
        Integers chain;
        double sharpness;
    };
    std::vector<Crease> creases;

    /// Adds a point; returns its number.
    int add(const V3d& point, const V3d& color);
    void face(const Integers& points_of_face);
    /// Adds a crease; none where the sharpness is 0.
    void crease(const Integers& chain, double sharpness);
    /// Writes the SubdivisionMesh. Faces on a border are drawn up to it.
    void write(RibWriter& rib) const;
};

/// A ring of a turned thing: points at a height on the y axis, round it. Radius 0: the pole at an end.
struct Ring {
    double y, radius;
    V3d color;
    double sharpness = 0;
};

/// How rings become a surface.
struct Lathe {
    int sides = 8;
    double width = 1, depth = 1;  ///< factors of the radius along x and z
    double ridges = 0;            ///< sharpness of the lines from ring to ring
};

/// Adds a turned thing, closed at both ends by a pole or a flat face.
void add_lathe(Cage& cage, const Lathe& lathe, const std::vector<Ring>& rings);

/// Adds a ball: a cube that the subdivision rounds.
void add_stud(Cage& cage, const V3d& center, double radius, const V3d& color);

/// A flat thing in the plane of x and y: a front and a back sheet over a grid of points, with rims where the
/// grid or a hole in it ends, sharp edges where the thickness there is 0.
struct Plate {
    int rows, columns;  ///< of points
    double rim = 3, edge = 8;
    double z = 0;  ///< of the plane

    struct Point {
        double x, y;
        double half_thickness;
        V3d color;
        double ridge = 0;  ///< sharpness of the line to the next row
    };
    std::function<Point(int row, int column)> point = {};
    std::function<bool(int row, int column)> hole = [](int, int) { return false; };
};

void add_plate(Cage& cage, const Plate& plate);

}  // namespace trapeze::scenes
