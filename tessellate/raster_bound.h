/// Which pixels' samples may see what lies in boxes of camera space.
#pragma once

#include <span>

#include "core/math.h"
#include "core/scene/camera.h"

namespace trapeze {

class RasterBound {
  public:
    /// picture: the pixels that are sampled at all; what lies outside is dropped.
    RasterBound(const Camera& camera, const PixelRect& picture) : camera_(camera), picture_(picture) {}

    struct Result {
        PixelRect rect;       ///< clamped to the picture; empty: nothing can be seen
        bool inside = false;  ///< the picture holds all of it, and so it does of any part
    };
    /// boxes: at each motion key, between which points move linearly.
    Result of(std::span<const Box3f> boxes) const;

  private:
    struct Rect {
        float x0, y0, x1, y1;
    };
    Rect projected(const Box3f& box) const;
    bool missed_by_all_rays(const Box3f& box) const;
    bool missed_along(int axis, const Box3f& box) const;

    Camera camera_;
    PixelRect picture_;
};

}  // namespace trapeze
