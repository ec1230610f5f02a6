/// A single ray against the boxes of a node's children and those of a grid, one box a lane. Boxes grow by
/// what rounds for the ray at hand (TraceRay::rounding()), near where they are: its reach may be any.
/// Compiled once a target.
#if defined(TRAPEZE_ACCEL_RAY_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_RAY_SLABS_INL_H_
#undef TRAPEZE_ACCEL_RAY_SLABS_INL_H_
#else
#define TRAPEZE_ACCEL_RAY_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "accel/trace_ray.h"
#include "accel/wide/bfloat16-inl.h"
#include "accel/wide/block_hits-inl.h"
#include "accel/wide/box_codes-inl.h"
#include "accel/wide/wide_tree.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes of the depths between which a ray is inside boxes.
struct Inside {
    VF near, far;

    /// Between these depths at most.
    HWY_INLINE Inside(float from, float to) : near(hn::Set(F32(), from)), far(hn::Set(F32(), to)) {}
    /// Cuts with the slabs of three axes.
    HWY_INLINE void cut(const VF* enter, const VF* leave) {
        near = hn::Max(hn::Max(near, enter[0]), hn::Max(enter[1], enter[2]));
        far = hn::Min(hn::Min(far, leave[0]), hn::Min(leave[1], leave[2]));
    }
    /// What is no number makes no bound.
    HWY_INLINE MF missed() const { return hn::Gt(near, far); }
};

/// A ray against planes along the axes of space: it is at the plane p of axis k at depth p * inverse[k] -
/// at[k].
struct NodeSlabs {
    float inverse[3], at[3], steepness[3];  ///< the last one is |inverse|
    size_t in_row[3], out_row[3];           ///< of WideNode: planes through which it comes in and goes out

    explicit NodeSlabs(const TraceRay& ray) {
        for (size_t k = 0; k < 3; ++k) {
            const float direction = ray.direction[static_cast<int>(k)];
            inverse[k] = 1.0f / (std::abs(direction) < kLeastDirection ? kLeastDirection : direction);
            at[k] = ray.origin[static_cast<int>(k)] * inverse[k];
            steepness[k] = std::abs(inverse[k]);
            const size_t backward = inverse[k] < 0 ? 3 : 0;
            in_row[k] = k + backward, out_row[k] = k + 3 - backward;
        }
    }

    /// Cuts with the boxes of children from number `first` on, grown by `pad`; at a time, if kMotion.
    template <bool kMotion>
    HWY_INLINE void cut(const ChildRows& rows, size_t first, float time, float pad, Inside& inside) const {
        const F32 d;
        VF enter[3], leave[3];
#pragma GCC unroll 3
        for (size_t k = 0; k < 3; ++k) {
            VF in = hn::Load(d, rows.row(in_row[k]) + first), out = hn::Load(d, rows.row(out_row[k]) + first);
            if constexpr (kMotion) {
                in = hn::MulAdd(hn::Set(d, time), from_bfloat16(d, rows.motion(in_row[k]) + first), in);
                out = hn::MulAdd(hn::Set(d, time), from_bfloat16(d, rows.motion(out_row[k]) + first), out);
            }
            const VF by = hn::Set(d, inverse[k]), from = hn::Set(d, at[k]),
                     grown = hn::Mul(hn::Set(d, pad), hn::Set(d, steepness[k]));
            enter[k] = hn::MulSub(in, by, hn::Add(from, grown));
            leave[k] = hn::MulSub(out, by, hn::Sub(from, grown));
        }
        inside.cut(enter, leave);
    }
};

/// A ray against the boxes of a grid at the ray's time, in the grid's axes. It comes into those of code c,
/// of axis k, at depth step[0][k] * c - enter[k], and goes out at step[0][k] * c - leave[k]; where the grid
/// moves, + step[1][k] times the code at the segment's end.
template <bool kMotion>
class GridSlabs {
  public:
    HWY_INLINE GridSlabs(const WideTree& tree, const WideGrid& grid, MotionSegment segment,
                         const TraceRay& ray, float pad)
        : count_(static_cast<size_t>(grid.box_count())) {
        const uint8_t* bytes = tree.keys_of(grid);
        const GridKeys keys(grid, bytes);
        codes_[0] = keys.box_codes(segment.index);
        if constexpr (kMotion) codes_[1] = codes_[0] + grid.key_bytes();
#if HWY_TARGET == HWY_SCALAR
        const GridAxes axes = grid.axes.unpacked();
        const KeyBounds from = keys.oriented(segment.index),
                        to = kMotion ? keys.oriented(segment.index + 1) : from;
        for (int k = 0; k < 3; ++k) {
            const float* a = axes.axis[k];
            const float direction = a[0] * ray.direction.x + a[1] * ray.direction.y + a[2] * ray.direction.z;
            const float origin = a[0] * ray.origin.x + a[1] * ray.origin.y + a[2] * ray.origin.z;
            const float inverse =
                1.0f / (std::abs(direction) < kLeastDirection ? kLeastDirection : direction);
            const float first = from.low[k] + segment.local * (to.low[k] - from.low[k]);
            const float at = (origin - first) * inverse, grown = pad * std::abs(inverse);
            enter_.of_axis[k] = at + grown, leave_.of_axis[k] = at - grown;
            step_[0].of_axis[k] = (from.high[k] - from.low[k]) * (1.0f / 255) * (1 - segment.local) * inverse;
            step_[1].of_axis[k] = (to.high[k] - to.low[k]) * (1.0f / 255) * segment.local * inverse;
            backward_ |= static_cast<uint32_t>(inverse < 0) << k;
        }
#else
        // Lanes are the axes; the last one means nothing.
        const hn::FixedTag<float, 4> d;
        const auto x = axes_along<0>(grid), y = axes_along<1>(grid), z = axes_along<2>(grid);
        const auto turned = [&](const V3f& v) HWY_ATTR {
            return hn::MulAdd(x, hn::Set(d, v.x),
                              hn::MulAdd(y, hn::Set(d, v.y), hn::Mul(z, hn::Set(d, v.z))));
        };
        const auto least = hn::Set(d, kLeastDirection), across = turned(ray.direction);
        const auto direction = hn::IfThenElse(hn::Lt(hn::Abs(across), least), least, across);
        backward_ = mask_bits(d, hn::Lt(direction, hn::Zero(d)));
        const auto inverse = hn::Div(hn::Set(d, 1.0f), direction);

        const hn::FixedTag<uint8_t, 16> d8;
        auto low = hn::BitCast(d, hn::LoadU(d8, bytes)),
             size = hn::Sub(hn::BitCast(d, hn::LoadU(d8, bytes + sizeof(float[3]))), low);
        const auto part = hn::Set(d, 1.0f / 255);
        if constexpr (kMotion) {
            const uint8_t *begin = keys.of_key(segment.index), *end = begin + grid.key_bytes();
            const auto step = hn::Mul(size, part), local = hn::Set(d, segment.local);
            const auto low0 = decode_planes(low, step, begin), low1 = decode_planes(low, step, end);
            const auto size0 = hn::Sub(decode_planes(low, step, begin + 3), low0),
                       size1 = hn::Sub(decode_planes(low, step, end + 3), low1);
            low = hn::MulAdd(local, hn::Sub(low1, low0), low0);
            size = hn::Mul(size0, hn::Sub(hn::Set(d, 1.0f), local));
            step_[1] = hn::Mul(hn::Mul(hn::Mul(size1, local), part), inverse);
        }
        step_[0] = hn::Mul(hn::Mul(size, part), inverse);
        const auto at = hn::Mul(hn::Sub(turned(ray.origin), low), inverse),
                   grown = hn::Mul(hn::Set(d, pad), hn::Abs(inverse));
        enter_ = hn::Add(at, grown), leave_ = hn::Sub(at, grown);
#endif
    }

    size_t count() const {
        return count_;
    }

    /// Cuts with boxes from number `first` on. What is past the last box means nothing.
    HWY_INLINE void cut(size_t first, Inside& inside) const {
        VF enter[3], leave[3];
        slab<0>(first, enter[0], leave[0]);
        slab<1>(first, enter[1], leave[1]);
        slab<2>(first, enter[2], leave[2]);
        inside.cut(enter, leave);
    }

  private:
#if HWY_TARGET == HWY_SCALAR
    struct Four {
        float of_axis[4];
    };
    template <int kAxis>
    static HWY_INLINE VF lanes_of(const Four& four) {
        return hn::Set(F32(), four.of_axis[kAxis]);
    }
#else
    using Four = hn::Vec<hn::FixedTag<float, 4> >;  ///< a number for each axis; the last one means nothing

    template <int kAxis>
    static HWY_INLINE VF lanes_of(Four four) {
        return hn::Set(F32(), hn::GetLane(hn::Broadcast<kAxis>(four)));
    }
    /// Coordinate c of the three axes.
    template <size_t kCoordinate>
    static HWY_INLINE auto axes_along(const WideGrid& grid) {
        // Every third code becomes the upper half of a lane.
        alignas(16) static constexpr uint8_t kEveryThird[16] = {128, 128, 0,  1,  128, 128, 6,   7,
                                                                128, 128, 12, 13, 128, 128, 128, 128};
        // Sixteen bytes are loaded from one of the first three codes on: they may reach beyond the axes, not
        // beyond the record.
        static_assert(offsetof(WideGrid, axes) + sizeof(int16_t[2]) + 16 <= sizeof(WideGrid));
        const hn::FixedTag<uint8_t, 16> d8;
        const hn::FixedTag<int32_t, 4> d32;
        const auto codes = hn::LoadU(d8, reinterpret_cast<const uint8_t*>(&grid) + offsetof(WideGrid, axes) +
                                             sizeof(int16_t) * kCoordinate);
        const auto upper = hn::BitCast(d32, hn::TableLookupBytesOr0(codes, hn::Load(d8, kEveryThird)));
        const hn::FixedTag<float, 4> d;
        return hn::Mul(hn::ConvertTo(d, upper), hn::Set(d, 0x1p-16f / PackedAxes::kOne));
    }
#endif
    /// Depths at which the ray comes into boxes and goes out along an axis of the grid.
    template <int kAxis>
    HWY_INLINE void slab(size_t first, VF& in, VF& out) const {
        const size_t backward = backward_ >> kAxis & 1, in_row = (kAxis + 3 * backward) * count_ + first,
                     out_row = (kAxis + 3 - 3 * backward) * count_ + first;
        const VF step = lanes_of<kAxis>(step_[0]);
        in = hn::MulSub(codes(0, in_row), step, lanes_of<kAxis>(enter_));
        out = hn::MulSub(codes(0, out_row), step, lanes_of<kAxis>(leave_));
        if constexpr (!kMotion) return;
        const VF end_step = lanes_of<kAxis>(step_[1]);
        in = hn::MulAdd(codes(1, in_row), end_step, in);
        out = hn::MulAdd(codes(1, out_row), end_step, out);
    }
    /// Codes at the segment's start (0) or end (1), as floats.
    HWY_INLINE VF codes(int end, size_t at) const {
        const hn::Rebind<uint8_t, F32> d8;
        return hn::ConvertTo(F32(), hn::PromoteTo(I32(), hn::LoadU(d8, codes_[end] + at)));
    }

    const uint8_t* codes_[2];
    size_t count_;
    uint32_t backward_ = 0;  ///< a bit an axis: it comes in through high planes
    Four enter_, leave_, step_[2];
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
