/// The samples of a tile of pixels, as data: where and when each looks, whatever pattern made them and
/// whatever method resolves them [decision 0017].
#pragma once

#include <cstdint>
#include <vector>

#include "core/pixel_rect.h"
#include "core/rays.h"

namespace trapeze {

/// A pixel of the raster, which may lie past the image.
struct PixelPlace {
    int x = 0, y = 0;

    bool operator==(const PixelPlace&) const = default;
};

/// Samples as a structure of arrays. Samples of one pixel follow each other; pixels run row by row through
/// `pixels`, or are listed.
struct SampleTile {
    PixelRect
        pixels;  ///< raster pixels, x0 y0 .. x1 y1 exclusive; may reach past the image by the filter's radius
    /// Where not empty, samples are of these of the pixels alone, in this order. Such tiles are made where
    /// pixels have numbers of samples of their own; methods say whether they take them.
    std::vector<PixelPlace> listed;
    std::vector<uint16_t> in_pixel;  ///< of listed pixels: the number of each sample among all of its pixel's
    int samples_per_pixel = 0;
    std::vector<float> x, y;            ///< raster space
    std::vector<float> lens_u, lens_v;  ///< in the unit disk; 0 without a lens
    std::vector<float> time;            ///< in [0, 1); 0 without motion
    std::vector<AxisRay> rays;          ///< the camera's ray of each sample

    size_t size() const { return x.size(); }
    bool is_list() const { return !listed.empty(); }
    /// Where the samples of a pixel of the rectangle begin; not of a list.
    size_t first_of_pixel(int px, int py) const {
        return (static_cast<size_t>(py - pixels.y0) * pixels.width() + (px - pixels.x0)) * samples_per_pixel;
    }
    PixelPlace pixel_of(size_t sample) const {
        const size_t pixel = sample / static_cast<size_t>(samples_per_pixel);
        if (is_list()) return listed[pixel];
        const auto at = static_cast<int>(pixel), width = pixels.width();
        return {pixels.x0 + at % width, pixels.y0 + at / width};
    }
    /// A sample's number among all that its pixel may have.
    size_t number_in_pixel(size_t sample) const {
        return is_list() ? in_pixel[sample] : sample % static_cast<size_t>(samples_per_pixel);
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
