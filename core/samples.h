/// The samples of a tile of pixels, as data: where and when each looks, whatever pattern made them and
/// whatever method resolves them [decision 0017].
#pragma once

#include <cstdint>
#include <vector>

#include "core/pixel_rect.h"
#include "core/rays.h"

namespace trapeze {

/// Samples as a structure of arrays. Samples of one pixel follow each other; pixels run row by row through
/// `pixels`.
struct SampleTile {
    PixelRect
        pixels;  ///< raster pixels, x0 y0 .. x1 y1 exclusive; may reach past the image by the filter's radius
    int samples_per_pixel = 0;
    std::vector<float> x, y;            ///< raster space
    std::vector<float> lens_u, lens_v;  ///< in the unit disk; 0 without a lens
    std::vector<float> time;            ///< in [0, 1); 0 without motion
    std::vector<AxisRay> rays;          ///< the camera's ray of each sample

    size_t size() const { return x.size(); }
    size_t first_of_pixel(int px, int py) const {
        return (static_cast<size_t>(py - pixels.y0) * pixels.width() + (px - pixels.x0)) * samples_per_pixel;
    }
    void resize(size_t n) {
        for (auto* values : {&x, &y, &lens_u, &lens_v, &time}) values->resize(n);
        rays.resize(n);
    }
};

/// Side, in pixels, of the tiles in which samples are made, traced and composited unless a method asks for
/// others.
inline constexpr int kTileSide = 16;

}  // namespace trapeze
