/// How much the picture is blurred where, roughly: what decides the order in which rays are best traced.
#pragma once

#include <vector>

#include "core/grid.h"
#include "core/scene/camera.h"

namespace trapeze {

/// Sums over grids that are seen in a part of the picture, of products of
///   r = 1 / g, p = lens / g, q = motion / g
/// where g is the side of the grid, `lens` the diameter of its circle of confusion, `motion` the length of
/// its way while the shutter is open, all in pixels. How many grids any shape of rays meets follows from
/// them.
struct BlurMoments {
    float one = 0, r = 0, p = 0, q = 0, rr = 0, rp = 0, rq = 0, pp = 0, pq = 0;

    void add(float lens, float motion, float grid);
};

/// A map of squares of kSide pixels. It knows grids by a few of their vertices only: orders made from it may
/// be good or bad, never wrong.
class BlurMap {
  public:
    static constexpr int kSide = 16;

    /// Looks at each grid once, by its bound and a few of its vertices; it keeps no reference to either.
    BlurMap(const Camera& camera, const Grids& grids);

    /// In the middle of some pixels, which may reach past the image.
    const BlurMoments& at(const PixelRect& pixels) const;

  private:
    int columns_, rows_;
    std::vector<BlurMoments> cells_;
};

}  // namespace trapeze
