#include "sample/bundle_order.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace trapeze {
namespace {

/// The cell of a point of the disk on an axis of the square that was mapped to the disk [Shirley97], nearly;
/// for sorting only.
struct LensCells {
    float scale, last;

    explicit LensCells(int bits)
        : scale(0.5f * static_cast<float>(1 << bits)), last(static_cast<float>((1 << bits) - 1)) {}

    uint32_t cell(float square) const {
        return static_cast<uint32_t>(std::min(std::max((square + 1) * scale, 0.0f), last));
    }
    uint32_t operator()(float u, float v, int bits) const {
        const float au = std::abs(u), av = std::abs(v);
        const float radius = std::sqrt(u * u + v * v);
        const bool wide = au > av;
        const float ratio = (wide ? av : au) / std::max(wide ? au : av, 1e-9f);
        const float minor = radius * ratio * (1.273f - 0.273f * ratio);  // 4 / pi * atan, roughly
        const float a = std::copysign(wide ? radius : minor, u), b = std::copysign(wide ? minor : radius, v);
        return cell(b) << bits | cell(a);
    }
};

uint32_t even_bits(uint32_t code) {
    uint32_t value = 0;
    for (int bit = 0; bit < 16; ++bit) value |= (code >> (2 * bit) & 1) << bit;
    return value;
}

/// First samples of pixels along the Z-order curve over a tile's rectangle, of whatever size.
void z_order_of_pixels(const SampleTile& samples, std::vector<uint32_t>& first) {
    const int width = samples.pixels.width(), height = samples.pixels.height();
    first.clear();
    const uint32_t side = std::bit_ceil(static_cast<uint32_t>(std::max({width, height, 1})));
    for (uint64_t code = 0; code < uint64_t{side} * side; ++code) {
        const auto x = static_cast<int>(even_bits(static_cast<uint32_t>(code)));
        const auto y = static_cast<int>(even_bits(static_cast<uint32_t>(code >> 1)));
        if (x < width && y < height)
            first.push_back(
                static_cast<uint32_t>(samples.first_of_pixel(samples.pixels.x0 + x, samples.pixels.y0 + y)));
    }
}

}  // namespace

void order_bundles(const SampleTile& samples, bool motion, bool defocus, const BundleOrder& order,
                   SampleScratch& scratch) {
    const int width = samples.pixels.width(), height = samples.pixels.height();
    const auto per_pixel = static_cast<uint32_t>(samples.samples_per_pixel);
    const int lens_bits = defocus ? order.lens_bits : 0, time_bits = motion ? order.time_bits : 0;
    const int bits = 2 * lens_bits + time_bits;
    const int side = order.block_side, blocks_x = (width + side - 1) / side,
              blocks_y = (height + side - 1) / side;

    scratch.keys.resize(samples.size());
    const LensCells lens(order.lens_bits);
    const auto time_cells = static_cast<float>(1 << time_bits);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto block = static_cast<uint32_t>(y / side * blocks_x + x / side) << bits;
            const size_t first = samples.first_of_pixel(samples.pixels.x0 + x, samples.pixels.y0 + y);
            for (size_t i = first; i < first + per_pixel; ++i) {
                uint32_t key = block;
                if (motion)
                    key |= static_cast<uint32_t>(std::min(samples.time[i] * time_cells, time_cells - 1));
                if (defocus) key |= lens(samples.lens_u[i], samples.lens_v[i], order.lens_bits) << time_bits;
                scratch.keys[i] = key;
            }
        }

    scratch.starts.assign((static_cast<size_t>(blocks_x) * blocks_y << bits) + 1, 0);
    for (const uint32_t key : scratch.keys) ++scratch.starts[key + 1];
    for (size_t i = 1; i < scratch.starts.size(); ++i) scratch.starts[i] += scratch.starts[i - 1];
    z_order_of_pixels(samples, scratch.pixel_first);
    scratch.order.resize(samples.size());
    for (const uint32_t first : scratch.pixel_first)
        for (uint32_t i = first; i < first + per_pixel; ++i)
            scratch.order[scratch.starts[scratch.keys[i]]++] = i;
}

}  // namespace trapeze
