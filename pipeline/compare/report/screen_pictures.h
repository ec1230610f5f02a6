/// Pictures, differences and heat maps as screens show them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "composite/image.h"
#include "pipeline/compare/comparison.h"

namespace trapeze {

/// Linear red, green and blue, row by row.
struct LinearPicture {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

/// A rectangle of an image's window, its colours over black.
LinearPicture part_of(const Image& image, const PixelRect& pixels);
/// Absolute differences, times a scale. The windows are the same.
LinearPicture difference_of(const Image& a, const Image& b, float scale);
/// Means of squares of factor x factor pixels; what is left over at the far borders is cut off.
LinearPicture shrunk(const LinearPicture& picture, int factor);

/// The largest power of two, up to 64, by which nearly all (99.5%) differences at a sample rate can be
/// multiplied and stay below 1.
float difference_scale(const Comparison& comparison, SampleRate rate);

/// How the counts of heat maps become colours: logarithmic from 1 to `top`, below 1 as 1.
struct HeatScale {
    float top = 2;

    float place(float count) const;  ///< in [0, 1]
};
/// Holds nearly all (99.9%) of the values.
HeatScale heat_scale(std::span<const std::vector<float>* const> maps);

/// "data:image/png;base64,...": encoded by the sRGB curve, clipped at white.
std::string png_url(const LinearPicture& picture);
/// A heat map in the colours of viridis, shrunk by taking means.
std::string png_url(const std::vector<float>& map, int width, int height, int factor, const HeatScale& scale);

}  // namespace trapeze
