#include "pipeline/compare/error_structure.h"

#include <algorithm>

#include "pipeline/compare/pictures.h"

namespace trapeze {
namespace {

/// Replaces one channel of a block by its mean.
void take_mean(Image& image, const PixelRect& block, size_t channel) {
    double sum = 0;
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x)
            sum += static_cast<double>(image.rgba[4 * image.index(x, y) + channel]);
    const auto mean = static_cast<float>(sum / (static_cast<double>(block.width()) * block.height()));
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x) image.rgba[4 * image.index(x, y) + channel] = mean;
}

}  // namespace

Image block_means(const Image& image, int block) {
    Image means = image;
    const PixelRect& window = image.window;
    for (int y = window.y0; y < window.y1; y += block)
        for (int x = window.x0; x < window.x1; x += block)
            for (size_t c = 0; c < 4; ++c)
                take_mean(means, {x, y, std::min(x + block, window.x1), std::min(y + block, window.y1)}, c);
    return means;
}

PictureError picture_error(const Image& image, const Image& reference, int block) {
    const double rmse = rms_difference(image, reference);
    if (!(rmse > 0)) return {};
    const double shared = rms_difference(block_means(image, block), block_means(reference, block)) / rmse;
    // Of errors of their own, a mean's square is, on the mean, a pixel's by the pixels of a block.
    const auto blocks = [block](int pixels) { return (pixels + block - 1) / block; };
    const int width = reference.window.width(), height = reference.window.height();
    const double pixels_of_block =
        static_cast<double>(width) * height / (static_cast<double>(blocks(width)) * blocks(height));
    return {rmse, shared * shared * pixels_of_block};
}

}  // namespace trapeze
