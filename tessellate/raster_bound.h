/// Which pixels' samples may see what lies in boxes of camera space, through any point of the lens.
/// Conservative: a pixel left out sees nothing of it; many that are in may see nothing either.
#pragma once

#include <span>

#include "core/math.h"
#include "core/scene/camera.h"

namespace trapeze {

/// Bounds for one camera and picture. Raster pixels, x right, y down.
class RasterBound {
  public:
    /// picture: the pixels that are sampled at all; what lies outside is dropped.
    RasterBound(const Camera& camera, const PixelRect& picture) : camera_(camera), picture_(picture) {}

    /// Of geometry that is seen from all sides, not by the camera alone: the whole picture, whatever the box.
    static RasterBound of_everything(const Camera& camera, const PixelRect& picture) {
        RasterBound bound(camera, picture);
        bound.everything_ = true;
        return bound;
    }

    /// What may see the boxes.
    struct Result {
        PixelRect rect;       ///< clamped to the picture; empty: nothing can be seen
        bool inside = false;  ///< the picture holds all of it, and so it does of any part
    };
    /// The pixels that may see what moves through boxes, one at each motion key, between which points move
    /// linearly. An empty result: nothing is in the picture, or all is outside the clipping planes.
    Result of(std::span<const Box3f> boxes) const;

  private:
    /// Raster bounds before they are rounded to pixels. Floats may be infinite or NaN here; they are clamped
    /// when pixels are made of them.
    struct Rect {
        float x0, y0, x1, y1;
    };
    /// The box as a pinhole sees it; all of it must be in front of the eye.
    Rect projected(const Box3f& box) const;
    /// Whether no ray of the picture comes through a box, which may cross the eye plane.
    bool missed_by_all_rays(const Box3f& box) const;
    /// Whether all rays pass the box on one side, seen along x (axis 0) or y alone.
    bool missed_along(int axis, const Box3f& box) const;

    Camera camera_;
    PixelRect picture_;
    bool everything_ = false;
};

/// A box that holds what shaders displace by up to `displacement_bound`, and the rounding of positions.
Box3f grown(const Box3f& box, float displacement_bound);

}  // namespace trapeze
