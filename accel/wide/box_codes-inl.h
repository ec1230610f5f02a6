/// From the codes of a grid's boxes to their planes (see box_codes.h), in vectors. A target may fuse where
/// the scalar form does not: planes may differ from it by kCodeRounding, which boxes are grown by. Compiled
/// once a target.
#if defined(TRAPEZE_ACCEL_BOX_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BOX_CODES_INL_H_
#undef TRAPEZE_ACCEL_BOX_CODES_INL_H_
#else
#define TRAPEZE_ACCEL_BOX_CODES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstring>

#include "accel/wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Decodes one row of BoxPlanes at a key, for `boxes` boxes and those that a whole vector has besides (their
/// codes are read past the row: keys_ is readable 64 bytes past its end).
HWY_INLINE void decode_row(const uint8_t* codes, const CodeScale& scale, size_t boxes, float* out) {
    const hn::CappedTag<float, BoxPlanes::kMost> d;
    const hn::Rebind<int32_t, decltype(d)> di;
    const hn::Rebind<uint8_t, decltype(d)> d8;
    for (size_t b = 0; b < boxes; b += hn::Lanes(d)) {
        const auto code = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, codes + b)));
        hn::Store(hn::MulAdd(code, hn::Set(d, scale.step), hn::Set(d, scale.low)), d, out + b);
    }
}

#if HWY_TARGET != HWY_SCALAR  // it has one lane
/// Four planes from their codes, as CodeScale::plane(); what is read past the third means nothing.
HWY_INLINE auto decode_planes(hn::Vec<hn::FixedTag<float, 4>> low, hn::Vec<hn::FixedTag<float, 4>> step,
                              const uint8_t* codes) {
    const auto code = hn::PromoteTo(hn::FixedTag<int32_t, 4>(), hn::LoadU(hn::FixedTag<uint8_t, 4>(), codes));
    return hn::MulAdd(hn::ConvertTo(hn::FixedTag<float, 4>(), code), step, low);
}
#endif

/// WideTree::read_segment() of a moving grid, in vectors.
HWY_INLINE void read_moving_segment(const WideTree& tree, const WideGrid& grid, int segment,
                                    OrientedSegment& oriented) {
#if HWY_TARGET == HWY_SCALAR
    tree.read_segment(grid, segment, oriented);
#else
    const hn::FixedTag<float, 4> d;
    const hn::FixedTag<int16_t, 4> d16;
    const hn::FixedTag<int32_t, 4> d32;
    const int16_t* axes = grid.axes.code[0];
    float* to = oriented.axes.axis[0];
    const auto one = hn::Set(d, 1 / PackedAxes::kOne);
    for (size_t i = 0; i < 8; i += 4)
        hn::StoreU(hn::Mul(hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d16, axes + i))), one), d, to + i);
    to[8] = static_cast<float>(axes[8]) * (1 / PackedAxes::kOne);

    const uint8_t* bytes = tree.keys_of(grid);
    const hn::FixedTag<uint8_t, 16> d8;
    // The bounds over all keys, three floats each; a fourth lane means nothing.
    const auto low = hn::BitCast(d, hn::LoadU(d8, bytes)),
               high = hn::BitCast(d, hn::LoadU(d8, bytes + sizeof(float[3])));
    const auto step = hn::Mul(hn::Sub(high, low), hn::Set(d, 1.0f / 255));
    const uint8_t* begin = GridKeys(grid, bytes).of_key(segment);
    const uint8_t* end = begin + grid.key_bytes();
    const auto low0 = decode_planes(low, step, begin), low1 = decode_planes(low, step, end);
    const auto high0 = decode_planes(low, step, begin + 3), high1 = decode_planes(low, step, end + 3);
    // Each store of four is overwritten past its third by the next.
    hn::StoreU(low0, d, oriented.at[0].low), hn::StoreU(high0, d, oriented.at[0].high);
    hn::StoreU(low1, d, oriented.at[1].low), hn::StoreU(high1, d, oriented.at[1].high);
    hn::StoreU(low0, d, oriented.box.low), hn::StoreU(high0, d, oriented.box.high);
    hn::StoreU(hn::Sub(low1, low0), d, oriented.box.low_delta),
        hn::StoreU(hn::Sub(high1, high0), d, oriented.box.high_delta);
#endif
}

/// Decodes the boxes of a grid in a segment of its motion, which has been read: rows 0 to 5 at
/// the segment's start and, if kMotion, rows 6 to 11 how far they move.
template <bool kMotion>
HWY_INLINE void decode_boxes(const WideTree& tree, const WideGrid& grid, int segment,
                             const OrientedSegment& oriented, BoxPlanes& out) {
    const hn::CappedTag<float, BoxPlanes::kMost> d;
    const auto boxes = static_cast<size_t>(grid.box_count());
    const GridKeys keys(grid, tree.keys_of(grid));
    for (int end = 0; end < (kMotion ? 2 : 1); ++end) {
        const uint8_t* codes = keys.box_codes(segment + end);
        const KeyBounds& whole = oriented.at[end];
        float* rows = out.row(6 * static_cast<size_t>(end));
        for (size_t k = 0; k < 3; ++k) {
            const CodeScale scale(whole.low[k], whole.high[k]);
            decode_row(codes + k * boxes, scale, boxes, rows + k * BoxPlanes::kMost);
            decode_row(codes + (3 + k) * boxes, scale, boxes, rows + (3 + k) * BoxPlanes::kMost);
        }
    }
    if constexpr (kMotion)
        // Rows 6 to 11 hold planes at the end so far. What places past the last box give means nothing.
        for (size_t i = 0; i < 6 * BoxPlanes::kMost; i += hn::Lanes(d))
            hn::Store(hn::Sub(hn::Load(d, out.row(6) + i), hn::Load(d, out.row(0) + i)), d, out.row(6) + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
