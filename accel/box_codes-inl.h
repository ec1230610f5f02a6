/// From the codes of a grid's boxes to their planes (see box_codes.h). Compiled once a target.
#if defined(TRAPEZE_ACCEL_BOX_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BOX_CODES_INL_H_
#undef TRAPEZE_ACCEL_BOX_CODES_INL_H_
#else
#define TRAPEZE_ACCEL_BOX_CODES_INL_H_
#endif

#include <hwy/highway.h>

#include "accel/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The planes of row k at a key, for `boxes` boxes and those that a whole vector has besides.
HWY_INLINE void decode_row(const uint8_t* codes, const CodeScale& scale, size_t boxes, float* out) {
    const hn::CappedTag<float, BoxPlanes::kMost> d;
    const hn::Rebind<int32_t, decltype(d)> di;
    const hn::Rebind<uint8_t, decltype(d)> d8;
    for (size_t b = 0; b < boxes; b += hn::Lanes(d)) {
        const auto code = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, codes + b)));
        hn::Store(hn::MulAdd(code, hn::Set(d, scale.step), hn::Set(d, scale.low)), d, out + b);
    }
}

/// The boxes of a grid in a segment of its motion, of which the frame has been read; at its start alone
/// unless kMoves.
template <bool kMoves>
HWY_INLINE void decode_boxes(const WideTree& tree, const WideGrid& grid, int segment,
                             const SegmentFrame& frame, BoxPlanes& out) {
    const hn::CappedTag<float, BoxPlanes::kMost> d;
    const auto boxes = static_cast<size_t>(grid.box_count());
    const GridKeys keys(grid, tree.keys_of(grid));
    for (int end = 0; end < (kMoves ? 2 : 1); ++end) {
        const uint8_t* codes = keys.box_codes(segment + end);
        const KeyBounds& whole = frame.at[end];
        float* rows = out.row(6 * static_cast<size_t>(end));
        for (size_t k = 0; k < 3; ++k) {
            const CodeScale scale(whole.low[k], whole.high[k]);
            decode_row(codes + k * boxes, scale, boxes, rows + k * BoxPlanes::kMost);
            decode_row(codes + (3 + k) * boxes, scale, boxes, rows + (3 + k) * BoxPlanes::kMost);
        }
    }
    if constexpr (kMoves)
        for (size_t i = 0; i < 6 * BoxPlanes::kMost; i += hn::Lanes(d))
            hn::Store(hn::Sub(hn::Load(d, out.row(6) + i), hn::Load(d, out.row(0) + i)), d, out.row(6) + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
