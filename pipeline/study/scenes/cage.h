/// Control cages of Catmull-Clark surfaces with creases: turned and flat things put together from points.
#pragma once

#include <functional>
#include <vector>

#include "core/math.h"
#include "pipeline/study/scenes/rib_writer.h"

namespace trapeze::scenes {

struct Cage {
    std::vector<V3d> points, colors;  ///< no colours: that of the attributes
    Integers sizes, corners;          ///< of the faces, as SubdivisionMesh has them

    Integers holes;  ///< faces that are not drawn

    struct Crease {
        Integers chain;
        double sharpness;
    };
    std::vector<Crease> creases;

    int add(const V3d& point, const V3d& color);
    void face(const Integers& points_of_face);
    /// None where the sharpness is 0.
    void crease(const Integers& chain, double sharpness);
    /// Faces on a border are drawn up to it.
    void write(RibWriter& rib) const;
};

/// A ring of a turned thing about the y axis; of radius 0: its pole.
struct Ring {
    double y, radius;
    V3d color;
    double sharpness = 0;
};

struct Lathe {
    int sides = 8;
    double width = 1, depth = 1;  ///< factors of the radius along x and z
    double ridges = 0;            ///< sharpness of the lines from ring to ring
};

/// Closed at both ends, by a pole or a flat face.
void add_lathe(Cage& cage, const Lathe& lathe, const std::vector<Ring>& rings);

/// A ball: a cube that the subdivision rounds.
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
