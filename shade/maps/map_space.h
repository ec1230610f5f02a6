/// Where a point lies in a depth map.
#pragma once

#include <cmath>

#include "core/math.h"

namespace trapeze {

/// A depth map's pixels and its camera.
struct DepthView {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;     ///< the pixels that the file has
    float full_width = 1, full_height = 1;  ///< of the picture they are part of
    M44f camera_from_world, screen_from_world;
    bool perspective = true;
};

/// A point in a map: pixels, depth, and the depth's form that is linear over planes.
struct MapPoint {
    float x = 0, y = 0, depth = 0, linear = 0;
    bool seen = false;  ///< before the map's camera
};

/// Places of current-space points, whose world is at camera_from_world.
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
