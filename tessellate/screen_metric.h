/// How many pixels long a piece of a surface is. Projection needs no point in front of the eye: outside the
/// view, lengths are angles seen from the eye, so that nothing near the eye plane grows beyond bounds and no
/// eye splits are needed.
#pragma once

#include "core/camera.h"
#include "core/math.h"

namespace trapeze {

class ScreenMetric {
  public:
    /// Not raster oriented (Attribute "dice" "rasterorient" 0): pieces count as if seen square on.
    explicit ScreenMetric(const Camera& camera, bool raster_oriented = true);

    /// Pixels from p to q, camera space. Not less than a quarter of what the piece would have if it were seen
    /// square on: edge-on surfaces may turn to the viewer while the shutter is open, or be displaced.
    float length(const V3f& p, const V3f& q) const;

  private:
    float perspective_length(const V3f& p, const V3f& q) const;
    float orthographic_length(const V3f& p, const V3f& q) const;

    bool perspective_;
    float least_foreshortening_;
    float pixels_x_, pixels_y_, pixels_;  ///< per unit of the image plane
    float view_cosine_;                   ///< of the angle to the image's farthest corner
    V2f center_{0, 0};                    ///< of the window, orthographic
    float radius_ = 1;                    ///< of a circle around the window, orthographic
};

}  // namespace trapeze
