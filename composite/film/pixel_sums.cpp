#include "composite/film/pixel_sums.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/film/pixel_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#ifndef TRAPEZE_COMPOSITE_PIXEL_SUMS_ONCE
#define TRAPEZE_COMPOSITE_PIXEL_SUMS_ONCE
namespace trapeze {

/// Samples that are added side by side.
constexpr size_t kSampleGroup = 16;

/// Planes of `padded` samples, a multiple of kSampleGroup.
struct WeightedPlanes {
    const float* colors;          ///< four planes
    const float *columns, *rows;  ///< weights: a plane for each column and row
    size_t padded;
    int column_count, row_count;
};

}  // namespace trapeze
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kSampleGroup>;
using Lanes = hn::Vec<F>;
constexpr size_t kVectors = kSampleGroup / hn::MaxLanes(F());  ///< that hold a group

/// Weights of samples in a pixel along an axis, as FilterAxis::weigh() has them; a plane for each column.
/// Samples past the last weigh nothing.
void weigh_samples(const FilterAxis& axis, const float* positions, size_t count, int pixel, int columns,
                   float* planes, size_t padded) {
    const F d;
    const hn::RebindToSigned<F> di;
    const Lanes zero = hn::Zero(d), below_one = hn::Set(d, 0x1.fffffep-1f);
    for (size_t s = 0; s < padded; s += hn::Lanes(d)) {
        const size_t left = s < count ? count - s : 0;
        const auto counts = hn::FirstN(d, left);
        const Lanes position =
            left >= hn::Lanes(d) ? hn::LoadU(d, positions + s) : hn::MaskedLoad(counts, d, positions + s);
        Lanes in_pixel = hn::Sub(position, hn::Set(d, static_cast<float>(pixel)));
        in_pixel = hn::IfThenElse(hn::Lt(in_pixel, below_one), in_pixel, below_one);
        in_pixel = hn::IfThenElse(hn::Lt(zero, in_pixel), in_pixel, zero);
        const Lanes start = hn::Add(in_pixel, hn::Set(d, axis.start()));
        const auto second = hn::Ge(start, hn::Set(d, 1.0f));
        const Lanes phase = hn::Sub(start, hn::IfThenElseZero(second, hn::Set(d, 1.0f)));
        const Lanes at = hn::Mul(phase, hn::Set(d, static_cast<float>(FilterAxis::kPhases)));
        const auto row = hn::ConvertTo(di, at);
        const Lanes part = hn::Sub(at, hn::ConvertTo(d, row));
        const auto index = hn::Mul(row, hn::Set(di, axis.taps));
        const float* const low = axis.phases.data();
        Lanes before = zero;  // the weight of the tap before
        for (int c = 0; c < columns; ++c) {
            Lanes weight = zero;
            if (c < axis.taps) {
                const Lanes from = hn::GatherIndex(d, low + c, index);
                const Lanes to = hn::GatherIndex(d, low + axis.taps + c, index);
                weight = hn::Add(from, hn::Mul(part, hn::Sub(to, from)));
                if (c + 1 == axis.taps)
                    weight = hn::IfThenZeroElse(hn::Lt(phase, hn::Set(d, axis.rim)), weight);
            }
            hn::Store(hn::IfThenElseZero(counts, hn::IfThenElse(second, before, weight)), d,
                      planes + static_cast<size_t>(c) * padded + s);
            before = weight;
        }
    }
}

/// The sum of a group's lanes: 16 to 8, to 4, to 2, to 1, each lane with the one half of them away.
HWY_INLINE float sum_of_lanes(const Lanes* group) {
    alignas(64) float all[kSampleGroup];
    for (size_t b = 0; b < kVectors; ++b) hn::Store(group[b], F(), all + b * hn::MaxLanes(F()));
    for (size_t half = kSampleGroup / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i) all[i] += all[i + half];
    return all[0];
}

/// Sums for a pixel around: weights, and kColors weighted planes.
template <int kColors>
HWY_INLINE void sum_products(const WeightedPlanes& in, const float* column, const float* row, float* sums) {
    const F d;
    Lanes total[1 + kColors][kVectors];
    for (auto& group : total)
        for (size_t b = 0; b < kVectors; ++b) group[b] = hn::Zero(d);
    for (size_t s = 0; s < in.padded; s += kSampleGroup)
        for (size_t b = 0; b < kVectors; ++b) {
            const size_t i = s + b * hn::Lanes(d);
            const Lanes weight = hn::Mul(hn::Load(d, column + i), hn::Load(d, row + i));
            total[0][b] = hn::Add(total[0][b], weight);
            for (int c = 0; c < kColors; ++c) {
                const float* const color = in.colors + static_cast<size_t>(c) * in.padded;
                total[1 + c][b] = hn::Add(total[1 + c][b], hn::Mul(weight, hn::Load(d, color + i)));
            }
        }
    for (int c = 0; c <= kColors; ++c) sums[c] = sum_of_lanes(total[c]);
}

/// Sums for all pixels around, row by row, five numbers each.
void sum_samples(const WeightedPlanes& in, bool colored, float* sums) {
    for (int j = 0; j < in.row_count; ++j)
        for (int i = 0; i < in.column_count; ++i, sums += 5) {
            const float* const column = in.columns + static_cast<size_t>(i) * in.padded;
            const float* const row = in.rows + static_cast<size_t>(j) * in.padded;
            if (colored)
                sum_products<4>(in, column, row, sums);
            else
                sum_products<0>(in, column, row, sums);
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(weigh_samples);
HWY_EXPORT(sum_samples);

PixelSums::PixelSums(const FilterKernel& kernel, int samples_per_pixel)
    : kernel_(kernel),
      count_(static_cast<size_t>(samples_per_pixel)),
      padded_((count_ + kSampleGroup - 1) / kSampleGroup * kSampleGroup),
      columns_(kernel.x().columns()),
      rows_(kernel.y().columns()),
      planes_((4 + static_cast<size_t>(columns_ + rows_)) * padded_ + kSampleGroup) {
    aligned_ = (64 - reinterpret_cast<uintptr_t>(planes_.data()) % 64) % 64 / sizeof(float);
}

void PixelSums::sum(const float* x, const float* y, int pixel_x, int pixel_y, bool colored) {
    float* const columns = plane(4);
    float* const rows = plane(4 + static_cast<size_t>(columns_));
    HWY_DYNAMIC_DISPATCH(weigh_samples)(kernel_.x(), x, count_, pixel_x, columns_, columns, padded_);
    HWY_DYNAMIC_DISPATCH(weigh_samples)(kernel_.y(), y, count_, pixel_y, rows_, rows, padded_);
    HWY_DYNAMIC_DISPATCH(sum_samples)({plane(0), columns, rows, padded_, columns_, rows_}, colored, sums_);
}

}  // namespace trapeze
#endif  // HWY_ONCE
