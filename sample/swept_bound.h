/// Where on the raster a moving, defocused thing can be seen: a conservative box.
#pragma once

#include "core/grid.h"
#include "core/scene/camera.h"

namespace trapeze {

/// Beyond this the predicate's products may overflow, and nothing is known.
inline constexpr double kBoundable = 1e15;

/// Relative rounding of the predicate and of the rays, with much to spare.
inline constexpr double kRasterRounding = 0x1p-18;

/// Pixels that samples may lie outside the image (filters).
inline constexpr double kMostPixelsOutside = 1024;

/// The largest coordinate of the image plane that a sample may have, the lens' part of slopes included.
double ray_reach(const Camera& camera);

/// Raster space; empty when min > max. Closed, in doubles: bounds are compared with pixels and not with
/// samples, and may be infinite.
struct RasterBox {
    double min_x, min_y, max_x, max_y;

    static RasterBox everything();
    static RasterBox nothing();
};

/// Collects the points of a thing at all its keys: corners that move linearly between them.
class SweptBound {
  public:
    void add(float x, float y, float z);

    /// The pixels of all samples that may see it through any point of the lens at any time. Everything when
    /// it touches or crosses the near plane; nothing when it is wholly outside the clipping range.
    RasterBox raster(const Camera& camera) const;

  private:
    double z_min_ = 1e300, z_max_ = -1e300, absolute_max_ = 0;
    double x_min_ = 1e300, x_max_ = -1e300, y_min_ = 1e300, y_max_ = -1e300;
    /// Projected on the plane z = 1; meaningful when z_min_ is positive.
    double px_min_ = 1e300, px_max_ = -1e300, py_min_ = 1e300, py_max_ = -1e300;
};

/// Adds a vertex of a grid at the ends of all its segments.
void add_vertex(const Grid& grid, int i, int j, SweptBound& bound);

/// The bound of a whole grid.
RasterBox raster_bound(const Grid& grid, const Camera& camera);

/// The part of `pixels` whose samples may lie in a box; all zero when there is none.
PixelRect pixels_within(const RasterBox& box, const PixelRect& pixels);

}  // namespace trapeze
