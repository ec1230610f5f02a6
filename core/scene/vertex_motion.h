/// Where a vertex of a grid is while the shutter is open, and how its surface lies then. Shading knows
/// normals as the shutter opens alone; vertices it knows at all keys.
#pragma once

#include <optional>
#include <span>

#include "core/scene/motion_turn.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// Of a grid whose primitive is set; it outlives this. Camera space at shutter open.
class VertexMotion {
  public:
    /// Of what does not deform and has no place: start() must not follow.
    VertexMotion() = default;
    /// `held`: Scene::held_from_camera, where positions at the keys still hold the camera's own motion; else
    /// empty.
    VertexMotion(const ShadingGrid& grid, size_t vertex, std::span<const M44f> held);

    V3f start() const { return place(0, vertex_); }
    /// How far it has come since the shutter opened.
    V3f way(float time) const;
    /// Whether the surface deforms, so that how it lies does not follow from its space.
    bool deforms() const;
    /// Whether the grid has vertices enough to tell how the surface bends: in one of a single row of
    /// micropolygons each tangent is a side's own.
    bool tells_bend() const;
    /// Where a direction of shutter open leads as the surface turns, with its space and as it deforms: by the
    /// shortest turn from its normal as the space alone turns it to its own. And the other way round.
    V3f forward(const V3f& direction, float time, const MotionTurn& space) const;
    V3f back(const V3f& direction, float time, const MotionTurn& space) const;

  private:
    V3f place(int key, size_t vertex) const;
    V3f place_at(float time, size_t vertex) const;
    V3f normal_at_open() const;
    V3f normal(float time) const;

    const ShadingGrid* grid_ = nullptr;
    size_t vertex_ = 0;
    std::span<const M44f> held_;
    int keys_ = 1;
    mutable std::optional<V3f> at_open_, at_known_time_;  ///< normals; the latter is the last one asked for
    mutable float known_time_ = 0;
};

}  // namespace trapeze
