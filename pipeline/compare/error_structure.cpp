#include "pipeline/compare/error_structure.h"

#include <algorithm>

#include "pipeline/compare/pictures.h"

namespace trapeze {
namespace {

/// Sums over whole blocks, all three colours together.
struct BlockSums {
    double pixels = 0;  ///< of squares of the pixels' errors
    double blocks = 0;  ///< of squares of the sums of the errors of a block
};

void add_block(const Image& image, const Image& reference, int x0, int y0, int block, BlockSums& sums) {
    double together[3] = {};
    for (int y = y0; y < y0 + block; ++y)
        for (int x = x0; x < x0 + block; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const size_t at = 4 * image.index(x, y) + c;
                const double error =
                    static_cast<double>(image.rgba[at]) - static_cast<double>(reference.rgba[at]);
                sums.pixels += error * error;
                together[c] += error;
            }
    for (const double sum : together) sums.blocks += sum * sum;
}

}  // namespace

Image block_means(const Image& image, int block) {
    Image means = image;
    std::fill(means.rgba.begin(), means.rgba.end(), 0.0f);
    const PixelRect& window = image.window;
    for (int y0 = window.y0; y0 + block <= window.y1; y0 += block)
        for (int x0 = window.x0; x0 + block <= window.x1; x0 += block)
            for (size_t c = 0; c < 4; ++c) {
                double sum = 0;
                for (int y = y0; y < y0 + block; ++y)
                    for (int x = x0; x < x0 + block; ++x)
                        sum += static_cast<double>(image.rgba[4 * image.index(x, y) + c]);
                for (int y = y0; y < y0 + block; ++y)
                    for (int x = x0; x < x0 + block; ++x)
                        means.rgba[4 * image.index(x, y) + c] = static_cast<float>(sum / (block * block));
            }
    return means;
}

PictureError picture_error(const Image& image, const Image& reference, int block) {
    BlockSums sums;
    const PixelRect& window = reference.window;
    for (int y = window.y0; y + block <= window.y1; y += block)
        for (int x = window.x0; x + block <= window.x1; x += block)
            add_block(image, reference, x, y, block, sums);
    // Errors of their own: the square of their sum is, on the mean, the sum of their squares.
    return {rms_difference(image, reference), sums.pixels > 0 ? sums.blocks / sums.pixels : 0};
}

}  // namespace trapeze
