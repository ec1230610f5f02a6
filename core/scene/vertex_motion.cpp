#include "core/scene/vertex_motion.h"

#include <algorithm>

#include "core/motion_keys.h"
#include "core/scene/poses.h"
#include "core/scene/scene.h"

namespace trapeze {
namespace {

/// The tangents of a grid at a vertex as its vertices have them: from the vertex before to the one behind
/// along u and v, at the grid's sides from or to the vertex itself. They are off the surface's own by half of
/// what it turns along a micropolygon's side, at sides by all of it.
class GridTangents {
  public:
    /// `place(vertex)`: where a vertex is.
    template <class Place>
    GridTangents(const GridShape& shape, size_t vertex, const Place& place) {
        const size_t row = static_cast<size_t>(shape.nu) + 1, u = vertex % row, v = vertex / row;
        const auto last_u = static_cast<size_t>(shape.nu), last_v = static_cast<size_t>(shape.nv);
        const auto at = [&](size_t column, size_t line) { return place(line * row + column); };
        u_ = at(std::min(u + 1, last_u), v) - at(u > 0 ? u - 1 : 0, v);
        v_ = at(u, std::min(v + 1, last_v)) - at(u, v > 0 ? v - 1 : 0);
    }

    /// Of unit length, along dPdu x dPdv; 0 where there is none.
    V3f normal() const { return u_.cross(v_).normalized(); }

  private:
    V3f u_, v_;
};

}  // namespace

VertexMotion::VertexMotion(const ShadingGrid& grid, size_t vertex, std::span<const M44f> held)
    : grid_(&grid), vertex_(vertex), held_(held), keys_(motion_keys_of(grid, held)) {}

V3f VertexMotion::place(int key, size_t vertex) const {
    const Triples& P = grid_->P[grid_->P.size() > 1 ? static_cast<size_t>(key) : 0];
    const V3f here = P.at(vertex);
    return held_.empty() ? here : here * held_at(held_, key, keys_);
}

V3f VertexMotion::place_at(float time, size_t vertex) const {
    if (keys_ == 1 || time == 0) return place(0, vertex);
    const MotionSegment at = segment_at(time, keys_);
    const V3f from = place(at.index, vertex), to = place(at.index + 1, vertex);
    return from + (to - from) * at.local;
}

V3f VertexMotion::way(float time) const {
    if (keys_ == 1 || time == 0) return V3f(0, 0, 0);
    return place_at(time, vertex_) - start();
}

bool VertexMotion::deforms() const {
    return grid_ && grid_->primitive->shape_keys.size() > 1;
}

bool VertexMotion::tells_bend() const {
    return grid_ && grid_->shape.nu > 1 && grid_->shape.nv > 1;
}

V3f VertexMotion::normal(float time) const {
    if (!at_known_time_ || known_time_ != time) {
        const auto place = [&](size_t vertex) { return place_at(time, vertex); };
        at_known_time_ = GridTangents(grid_->shape, vertex_, place).normal();
        known_time_ = time;
    }
    return *at_known_time_;
}

V3f VertexMotion::normal_at_open() const {
    if (!at_open_) {
        const auto place = [&](size_t vertex) { return this->place(0, vertex); };
        at_open_ = GridTangents(grid_->shape, vertex_, place).normal();
    }
    return *at_open_;
}

V3f VertexMotion::forward(const V3f& direction, float time, const MotionTurn& space) const {
    const V3f turned = space.forward(direction, time);
    if (!deforms() || time == 0) return turned;
    return turned_from(space.forward(normal_at_open(), time), normal(time), turned);
}

V3f VertexMotion::back(const V3f& direction, float time, const MotionTurn& space) const {
    if (!deforms() || time == 0) return space.back(direction, time);
    return space.back(turned_from(normal(time), space.forward(normal_at_open(), time), direction), time);
}

}  // namespace trapeze
