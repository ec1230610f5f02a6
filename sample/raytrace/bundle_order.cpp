#include "sample/raytrace/bundle_order.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sample/raytrace/pixel_order.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/raytrace/bundle_order.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The cell on an axis of a coordinate in [-1, 1].
template <class V>
HWY_INLINE auto cell(V square, int bits) {
    const hn::DFromV<V> d;
    const hn::RebindToSigned<decltype(d)> di;
    const V at = hn::MulAdd(square, hn::Set(d, 0.5f * static_cast<float>(1 << bits)),
                            hn::Set(d, 0.5f * static_cast<float>(1 << bits)));
    return hn::ConvertTo(di,
                         hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, static_cast<float>((1 << bits) - 1))));
}

/// keys = block | cell of the lens | cell of time, of `count` samples; u, v or time null: left out.
void add_keys(const float* u, const float* v, const float* time, size_t count, uint32_t block, int lens_bits,
              int time_bits, uint32_t* keys) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::RebindToUnsigned<decltype(d)> du;
    const size_t lanes = hn::Lanes(d);
    // The last vector overlaps the one before where there is one, else is a part.
    for (size_t i = 0; i < count; i += lanes) {
        const size_t at = i + lanes <= count || count < lanes ? i : count - lanes;
        const auto load = [&](const float* from) HWY_ATTR {
            if (count >= lanes) return hn::LoadU(d, from + at);
            HWY_ALIGN float part[hn::MaxLanes(d)] = {};
            std::copy_n(from, count, part);
            return hn::Load(d, part);
        };
        auto key = hn::Set(di, static_cast<int32_t>(block));
        if (time) {
            const auto last = hn::Set(d, static_cast<float>((1 << time_bits) - 1));
            const auto t = hn::Mul(load(time), hn::Set(d, static_cast<float>(1 << time_bits)));
            key = hn::Or(key, hn::ConvertTo(di, hn::Min(t, last)));
        }
        if (u) {
            // From the disk back to the square [Shirley97], nearly: this is for sorting only.
            const auto x = load(u), y = load(v), ax = hn::Abs(x), ay = hn::Abs(y);
            const auto radius = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
            const auto wide = hn::Gt(ax, ay);
            const auto ratio = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), hn::Set(d, 1e-9f)));
            const auto arc = hn::NegMulAdd(ratio, hn::Set(d, 0.273f), hn::Set(d, 1.273f));  // atan * 4 / pi
            const auto minor = hn::Mul(radius, hn::Mul(ratio, arc));
            const auto a = hn::CopySign(hn::IfThenElse(wide, radius, minor), x);
            const auto b = hn::CopySign(hn::IfThenElse(wide, minor, radius), y);
            const auto lens = hn::Or(hn::ShiftLeftSame(cell(b, lens_bits), lens_bits), cell(a, lens_bits));
            key = hn::Or(key, hn::ShiftLeftSame(lens, time_bits));
        }
        if (count >= lanes) {
            hn::StoreU(hn::BitCast(du, key), du, keys + at);
        } else {
            HWY_ALIGN uint32_t part[hn::MaxLanes(d)];
            hn::Store(hn::BitCast(du, key), du, part);
            std::copy_n(part, count, keys);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(add_keys);

namespace {

/// Along the Z-order curve, so that pixels which follow each other lie close by in both directions.
void list_first_samples(const SampleTile& samples, std::vector<uint32_t>& first) {
    first.clear();
    for_each_first_sample(samples, [&](uint32_t sample) { first.push_back(sample); });
}

/// Pixel by pixel; a pixel's samples one after another.
void order_by_pixels(const SampleTile& samples, BundleOrderScratch& scratch, std::vector<uint32_t>& result) {
    list_first_samples(samples, scratch.pixel_first);
    result.resize(samples.size());
    uint32_t* next = result.data();
    for (const uint32_t first : scratch.pixel_first)
        for (uint32_t i = first; i < first + static_cast<uint32_t>(samples.samples_per_pixel); ++i)
            *next++ = i;
}

/// What a group of consecutive rays covers of the picture: `square` pixels in either direction, and of the
/// lens along, of the lens across, and of the time these parts.
struct Footprint {
    float square, along, across, time;

    /// How many grids it meets, or squares `parts` times as small; a way is taken to run along.
    float meets(const BlurMoments& m, float parts) const {
        const float s = square * parts, a = along * parts, b = across * parts, t = time * parts;
        return m.one + 2 * s * m.r + (a + b) * m.p + t * m.q + s * s * m.rr + s * (a + b) * m.rp +
               s * t * m.rq + a * b * m.pp + t * b * m.pq;
    }
};

/// An order is keys of block, lens and time; consecutive rays fill a cell of them, and where they are more
/// than a cell has, they spread over the next cells in the order of the key.
Footprint footprint(float rays, const BundleOrder& order, float samples_per_pixel) {
    const float block = static_cast<float>(order.block_side * order.block_side),
                lens_cells = static_cast<float>(1 << order.lens_bits),
                time_cells = static_cast<float>(1 << order.time_bits);
    const float rays_of_cell = block * samples_per_pixel / (lens_cells * lens_cells * time_cells);
    // More rays than a cell has come from the next cells: of time first, then along the lens, then across.
    const float cells = rays / rays_of_cell;
    return {std::sqrt(block * std::min(cells, 1.0f)),
            std::clamp(cells / time_cells, 1.0f, lens_cells) / lens_cells,
            std::clamp(cells / (time_cells * lens_cells), 1.0f, lens_cells) / lens_cells,
            std::clamp(cells, 1.0f, time_cells) / time_cells};
}

/// In cycles a ray, roughly (twice or half of each makes little difference): of a packet with each grid it
/// meets, of a bundle with each grid, and with each block of a quarter of its side. A bundle of a larger
/// block of pixels has its rays farther apart in memory.
float cost_of(const BlurMoments& blur, const BundleOrder& order, int samples_per_pixel) {
    constexpr float kPacket = 16, kBundle = 1024;
    constexpr float kPacketAndGrid = 100 / kPacket, kBundleAndGrid = 300 / kBundle,
                    kBundleAndBlock = 100 / kBundle;
    const auto spp = static_cast<float>(samples_per_pixel);
    const Footprint packet = footprint(kPacket, order, spp), bundle = footprint(kBundle, order, spp);
    const float cost = kPacketAndGrid * packet.meets(blur, 1) + kBundleAndGrid * bundle.meets(blur, 1) +
                       kBundleAndBlock * bundle.meets(blur, 4);
    return order.block_side > 8 ? 1.07f * cost : cost;
}

}  // namespace

/// All orders are tried, some fifty: a tile has many more rays than that. Among equals the first is kept: the
/// smallest blocks, and the coarsest cells.
BundleOrder best_order(const BlurMoments& blur, int samples_per_pixel, RayBlur blurs) {
    BundleOrder best;
    float least = HUGE_VALF;
    for (const int side : {8, 16})
        for (int lens_bits = 0; lens_bits <= (blurs.lens ? 3 : 0); ++lens_bits)
            for (int time_bits = 0; time_bits <= (blurs.motion ? 5 : 0); ++time_bits) {
                const BundleOrder order{side, lens_bits, time_bits};
                const float cost = cost_of(blur, order, samples_per_pixel);
                if (cost < least) least = cost, best = order;
            }
    return best;
}

/// A counting sort by key over the Z-ordered pixels: stable, so that rays of one key keep the order of their
/// pixels.
void order_bundles(const SampleTile& samples, RayBlur blur, const BundleOrder& order,
                   BundleOrderScratch& scratch, std::vector<uint32_t>& result) {
    const int width = samples.pixels.width(), height = samples.pixels.height();
    const auto per_pixel = static_cast<uint32_t>(samples.samples_per_pixel);
    const int lens_bits = blur.lens ? order.lens_bits : 0, time_bits = blur.motion ? order.time_bits : 0;
    const int bits = 2 * lens_bits + time_bits;
    const int side = order.block_side, blocks_x = (width + side - 1) / side,
              blocks_y = (height + side - 1) / side;

    if (bits == 0) {  // blocks of any side follow each other along the curve, too
        order_by_pixels(samples, scratch, result);
        return;
    }
    scratch.keys.resize(samples.size());
    const float* lens_u = blur.lens ? samples.lens_u.data() : nullptr;
    const float* time = blur.motion ? samples.time.data() : nullptr;
    for (size_t first = 0; first < samples.size(); first += per_pixel) {
        const PixelPlace pixel = samples.pixel_of(first);
        const int x = pixel.x - samples.pixels.x0, y = pixel.y - samples.pixels.y0;
        const auto block = static_cast<uint32_t>(y / side * blocks_x + x / side) << bits;
        HWY_DYNAMIC_DISPATCH(add_keys)
        (lens_u ? lens_u + first : nullptr, samples.lens_v.data() + first, time ? time + first : nullptr,
         per_pixel, block, lens_bits, time_bits, scratch.keys.data() + first);
    }

    scratch.starts.assign((static_cast<size_t>(blocks_x) * blocks_y << bits) + 1, 0);
    for (const uint32_t key : scratch.keys) ++scratch.starts[key + 1];
    for (size_t i = 1; i < scratch.starts.size(); ++i) scratch.starts[i] += scratch.starts[i - 1];
    list_first_samples(samples, scratch.pixel_first);
    result.resize(samples.size());
    for (const uint32_t first : scratch.pixel_first)
        for (uint32_t i = first; i < first + per_pixel; ++i) result[scratch.starts[scratch.keys[i]]++] = i;
}

}  // namespace trapeze
#endif  // HWY_ONCE
