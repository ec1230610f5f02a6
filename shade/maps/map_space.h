/// Where a point lies in a depth map, and how deep.
#pragma once

#include <cmath>

#include "core/math.h"

namespace trapeze {

/// A depth map's pixels and its camera. Matrices are for row vectors.
struct DepthView {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;         ///< the pixels that the file has; x1, y1 are behind the last
    float full_width = 1, full_height = 1;      ///< pixels of the whole picture
    M44f camera_from_world, screen_from_world;  ///< screen: -1..1 across the picture and up it
    bool perspective = true;
};

/// A point in a map: its place in pixels of the whole picture, y down; its depth from the map's camera; and
/// `linear`, the depth (orthographic) or its inverse (perspective), which is linear over planes.
struct MapPoint {
    float x = 0, y = 0, depth = 0, linear = 0;
    bool seen = false;  ///< in front of the map's camera; else the place is not set
};

/// Finds points of the current space in a map. `camera_from_world` is of the render: its camera space is the
/// current one.
class MapSpace {
  public:
    MapSpace(const DepthView& map, const M44f& camera_from_world)
        : width_(map.full_width), height_(map.full_height), perspective_(map.perspective) {
        const M44d world_from_current = M44d(camera_from_world).inverse();
        camera_ = M44f(world_from_current * M44d(map.camera_from_world));
        screen_ = M44f(world_from_current * M44d(map.screen_from_world));
    }

    MapPoint operator()(const V3f& p) const {
        MapPoint at;
        at.depth = p.x * camera_[0][2] + p.y * camera_[1][2] + p.z * camera_[2][2] + camera_[3][2];
        const float w = p.x * screen_[0][3] + p.y * screen_[1][3] + p.z * screen_[2][3] + screen_[3][3];
        if (!(at.depth > 0) || !(w > 0)) return at;
        const float x = p.x * screen_[0][0] + p.y * screen_[1][0] + p.z * screen_[2][0] + screen_[3][0];
        const float y = p.x * screen_[0][1] + p.y * screen_[1][1] + p.z * screen_[2][1] + screen_[3][1];
        at.x = (0.5f + 0.5f * x / w) * width_;
        at.y = (0.5f - 0.5f * y / w) * height_;
        at.linear = perspective_ ? 1 / at.depth : at.depth;
        at.seen = std::isfinite(at.x) && std::isfinite(at.y);
        return at;
    }

  private:
    float width_, height_;  ///< pixels
    bool perspective_;
    M44f camera_, screen_;  ///< of the map, from the current space
};

}  // namespace trapeze
