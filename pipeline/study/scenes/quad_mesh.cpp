#include "pipeline/study/scenes/quad_mesh.h"

#include <numeric>

namespace trapeze::scenes {

void QuadMesh::add(const Corners& places, const Corners& colors) {
    places_.insert(places_.end(), places.begin(), places.end());
    colors_.insert(colors_.end(), colors.begin(), colors.end());
}

void QuadMesh::add_wall(const V3d& a, const V3d& b, double height, const V3d& low, const V3d& high) {
    const V3d up(0, height, 0);
    add({a, b, b + up, a + up}, {low, low, high, high});
}

void QuadMesh::add_ground(const V3d& from, const V3d& to, const V3d& color) {
    add({from, V3d(to.x, from.y, from.z), to, V3d(from.x, from.y, to.z)}, color);
}

void QuadMesh::add_box(const V3d& low, const V3d& high, const V3d& color) {
    const double height = high.y - low.y;
    const V3d b(high.x, low.y, low.z), c(high.x, low.y, high.z), d(low.x, low.y, high.z);
    add_wall(low, b, height, color, color);
    add_wall(b, c, height, color, color);
    add_wall(c, d, height, color, color);
    add_wall(d, low, height, color, color);
    add_ground(V3d(low.x, high.y, low.z), high, color);
}

void QuadMesh::add_lamp(const V3d& center, double half_width, double half_height, const V3d& color) {
    const V3d x(half_width, 0, 0), y(0, half_height, 0);
    add({center - x - y, center + x - y, center + x + y, center - x + y}, color);
}

void QuadMesh::write(RibWriter& rib) const {
    Integers vertices(places_.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    rib.request("PointsPolygons", Integers(places_.size() / 4, 4), vertices, "P", flattened(places_),
                "varying color Cs", flattened(colors_));
}

}  // namespace trapeze::scenes
