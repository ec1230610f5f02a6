/// Pictures, differences and heat maps as screens show them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "composite/image.h"
#include "pipeline/compare/comparison.h"

namespace trapeze {

/// A picture of linear red, green and blue, row by row.
struct LinearPicture {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

/// A rectangle of an image's window, its colours composited over black.
LinearPicture part_of(const Image& image, const PixelRect& pixels);
/// Absolute differences of two images of the same window, multiplied by `scale`.
LinearPicture difference_of(const Image& a, const Image& b, float scale);
/// A smaller picture: means of squares of factor x factor pixels; what is left over at the right and lower
/// borders is cut off.
LinearPicture shrunk(const LinearPicture& picture, int factor);

/// A factor that makes differences visible: the largest power of two, up to 64, with which nearly all (99.5%)
/// of them at a sample rate stay below 1.
float difference_scale(const Comparison& comparison, SampleRate rate);

/// How the counts of heat maps become colours: logarithmic from 1 to `top`, below 1 as 1.
struct HeatScale {
    float top = 2;

    float place(float count) const;  ///< on the colour scale, 0 to 1
};
/// A scale whose top nearly all (99.9%) of the maps' values lie below.
HeatScale heat_scale(std::span<const std::vector<float>* const> maps);

/// A picture as "data:image/png;base64,...": encoded by the sRGB curve, clipped at white.
std::string png_url(const LinearPicture& picture);
/// A heat map in the colours of viridis, shrunk by taking means.
std::string png_url(const std::vector<float>& map, int width, int height, int factor, const HeatScale& scale);

}  // namespace trapeze
