#include "composite/film/pixel_sums.h"

#include <algorithm>
#include <bit>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/film/pixel_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#ifndef TRAPEZE_COMPOSITE_PIXEL_SUMS_ONCE
#define TRAPEZE_COMPOSITE_PIXEL_SUMS_ONCE
namespace trapeze {

/// A pixel's samples, with what each weighs in the pixels around: planes as of SamplePlanes.
struct WeightedPlanes {
    std::span<const float* const> channels;
    const SamplePlanes& weights;
    bool is_separable;  ///< as PixelSums::weights_ says
    int column_count, row_count;

    const float* column(int i, int j) const {
        return weights[static_cast<size_t>(is_separable ? i : j * column_count + i)];
    }
    const float* row(int j) const {
        return weights[static_cast<size_t>(is_separable ? column_count + j : row_count * column_count)];
    }
};

/// Channels that are summed side by side; the first of them are colour and alpha, which are finite.
constexpr size_t kChannelsAtOnce = 4;

}  // namespace trapeze
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, SamplePlanes::kVectorGroup>;
using Lanes = hn::Vec<F>;

/// Where samples lie along an axis: FilterAxis::locate() in lanes.
struct PlaceLanes {
    Lanes phase;
    hn::Mask<F> second;  ///< whether the first tap is the second column
};

HWY_INLINE PlaceLanes locate(const FilterAxis& axis, const float* positions, size_t count, int pixel) {
    const F d;
    const Lanes zero = hn::Zero(d), below_one = hn::Set(d, 0x1.fffffep-1f);
    const Lanes position =
        count >= hn::Lanes(d) ? hn::LoadU(d, positions) : hn::MaskedLoad(hn::FirstN(d, count), d, positions);
    Lanes in_pixel = hn::Sub(position, hn::Set(d, static_cast<float>(pixel)));
    in_pixel = hn::IfThenElse(hn::Lt(in_pixel, below_one), in_pixel, below_one);
    in_pixel = hn::IfThenElse(hn::Lt(zero, in_pixel), in_pixel, zero);
    const Lanes start = hn::Add(in_pixel, hn::Set(d, axis.start()));
    const auto second = hn::Ge(start, hn::Set(d, 1.0f));
    return {hn::Sub(start, hn::IfThenElseZero(second, hn::Set(d, 1.0f))), second};
}

/// A table's number at `row`, and what it is more at the next: pairs, so that one load brings both.
struct PairLanes {
    Lanes low, step;
};
HWY_INLINE PairLanes gather_pairs(const int64_t* pairs, hn::VFromD<hn::RebindToSigned<F>> row) {
    const F d;
#if HWY_TARGET == HWY_SCALAR
    const auto pair = std::bit_cast<FilterAxis::Pair>(pairs[hn::GetLane(row)]);
    return {hn::Set(d, pair.weight), hn::Set(d, pair.step)};
#else
    const hn::Repartition<int64_t, F> wide;
    const hn::Half<hn::RebindToSigned<F>> half;
    const auto lower = hn::GatherIndex(wide, pairs, hn::PromoteTo(wide, hn::LowerHalf(half, row)));
    const auto upper = hn::GatherIndex(wide, pairs, hn::PromoteTo(wide, hn::UpperHalf(half, row)));
    return {hn::ConcatEven(d, hn::BitCast(d, upper), hn::BitCast(d, lower)),
            hn::ConcatOdd(d, hn::BitCast(d, upper), hn::BitCast(d, lower))};
#endif
}

/// Weights of samples in a pixel along an axis, as FilterAxis::weigh() has them; a plane for each column.
/// Samples past the last weigh nothing.
void weigh_samples(const FilterAxis& axis, const float* positions, size_t count, int pixel, int columns,
                   float* planes, size_t padded) {
    if (axis.only_weight) {
        std::fill_n(std::fill_n(planes, count, *axis.only_weight), padded - count, 0.0f);
        return;
    }
    const F d;
    const hn::RebindToSigned<F> di;
    for (size_t s = 0; s < padded; s += hn::Lanes(d)) {
        const size_t left = s < count ? count - s : 0;
        const auto counts = hn::FirstN(d, left);
        const auto [phase, second] = locate(axis, positions + s, left, pixel);
        const Lanes at = hn::Mul(phase, hn::Set(d, static_cast<float>(FilterAxis::kPhases)));
        const auto row = hn::ConvertTo(di, at);
        const Lanes part = hn::Sub(at, hn::ConvertTo(d, row));
        Lanes before = hn::Zero(d);  // the weight of the tap before
        for (int c = 0; c < columns; ++c) {
            Lanes weight = hn::Zero(d);
            if (c < axis.taps) {
                const auto [low, step] = gather_pairs(axis.tap(c), row);
                weight = hn::Add(low, hn::Mul(part, step));
                if (c + 1 == axis.taps)
                    weight = hn::IfThenZeroElse(hn::Lt(phase, hn::Set(d, axis.rim)), weight);
            }
            hn::Store(hn::IfThenElseZero(counts, hn::IfThenElse(second, before, weight)), d,
                      planes + static_cast<size_t>(c) * padded + s);
            before = weight;
        }
    }
}

/// Whether samples reach a column by a tap, which may be the last, whose rim counts for nothing; and how far
/// its pixel's centre is.
struct TapLanes {
    hn::Mask<F> reaches;
    Lanes distance;
};
HWY_INLINE TapLanes tap_of_column(const FilterAxis& axis, const PlaceLanes& place, int column) {
    const F d;
    const Lanes tap =
        hn::Sub(hn::Set(d, static_cast<float>(column)), hn::IfThenElseZero(place.second, hn::Set(d, 1.0f)));
    const auto is_last = hn::Eq(tap, hn::Set(d, static_cast<float>(axis.taps - 1)));
    const auto outside =
        hn::Or(hn::Or(hn::Lt(tap, hn::Zero(d)), hn::Ge(tap, hn::Set(d, static_cast<float>(axis.taps)))),
               hn::And(is_last, hn::Lt(place.phase, hn::Set(d, axis.rim))));
    return {hn::Not(outside), hn::Sub(hn::Add(hn::Set(d, axis.half_width - 1), place.phase), tap)};
}

/// Weights of samples by a filter that is not separable, as FilterKernel::weigh() has them; a plane for each
/// pixel around, row by row.
void weigh_samples_by_distance(const FilterKernel& kernel, const float* x, const float* y, size_t count,
                               int pixel_x, int pixel_y, SamplePlanes& planes) {
    const F d;
    const hn::RebindToSigned<F> di;
    const FilterKernel::RadialTable& table = kernel.radial();
    const float* const values = table.values.data();
    const Lanes last = hn::Set(d, table.last);
    for (size_t s = 0; s < planes.stride(); s += hn::Lanes(d)) {
        const size_t left = s < count ? count - s : 0;
        const auto counts = hn::FirstN(d, left);
        const PlaceLanes column_place = locate(kernel.x(), x + s, left, pixel_x),
                         row_place = locate(kernel.y(), y + s, left, pixel_y);
        size_t plane = 0;
        for (int j = 0; j < kernel.y().columns(); ++j) {
            const TapLanes of_row = tap_of_column(kernel.y(), row_place, j);
            const Lanes dy = hn::Mul(of_row.distance, hn::Set(d, table.aspect)), dy2 = hn::Mul(dy, dy);
            for (int i = 0; i < kernel.x().columns(); ++i, ++plane) {
                const auto [reaches, dx] = tap_of_column(kernel.x(), column_place, i);
                const Lanes at = hn::Mul(hn::Sqrt(hn::Add(hn::Mul(dx, dx), dy2)), hn::Set(d, table.scale));
                const auto inside =
                    hn::And(hn::And(counts, hn::Lt(at, last)), hn::And(reaches, of_row.reaches));
                const auto row = hn::ConvertTo(di, hn::IfThenElseZero(inside, at));
                const Lanes low = hn::GatherIndex(d, values, row), high = hn::GatherIndex(d, values + 1, row);
                const Lanes part = hn::Sub(at, hn::ConvertTo(d, row));
                hn::Store(hn::IfThenElseZero(inside, hn::Add(low, hn::Mul(part, hn::Sub(high, low)))), d,
                          planes[plane] + s);
            }
        }
    }
}

/// Adds up lanes by halves, until four are left: each lane of a half with the one that is half of them away.
template <size_t kGroup, class D>
HWY_INLINE void store_quarters(D d, const hn::Vec<D>* group, float* quarters) {
    if constexpr (kGroup == 1) {
        hn::Store(group[0], d, quarters);
#if HWY_TARGET != HWY_SCALAR
    } else if constexpr (hn::MaxLanes(D()) == kGroup && kGroup > 4) {
        const hn::Half<D> half;
        const hn::Vec<decltype(half)> sum =
            hn::Add(hn::LowerHalf(half, group[0]), hn::UpperHalf(half, group[0]));
        store_quarters<kGroup / 2>(half, &sum, quarters);
#endif
    } else if constexpr (kGroup > 4) {
        constexpr size_t kVectors = kGroup / hn::MaxLanes(D());
        hn::Vec<D> sums[kVectors / 2];
        for (size_t i = 0; i < kVectors / 2; ++i) sums[i] = hn::Add(group[i], group[i + kVectors / 2]);
        store_quarters<kGroup / 2>(d, sums, quarters);
    } else {
        for (size_t i = 0; i < kGroup; i += hn::MaxLanes(d)) hn::StoreU(*group++, d, quarters + i);
    }
}

/// What is left of the lanes of sums: as many quarters as there are.
template <size_t kGroup>
constexpr size_t kQuarters = kGroup == 1 ? 1 : 4;

/// Sums for a pixel around: weights, and kChannels weighted planes from `channel` on. `quarters` gets
/// kQuarters numbers for each, the weights' only with the first channel.
template <size_t kGroup, int kChannels>
HWY_INLINE void sum_products(const WeightedPlanes& in, size_t channel, const float* column, const float* row,
                             float* quarters) {
    const hn::CappedTag<float, kGroup> d;
    using V = hn::Vec<decltype(d)>;
    constexpr size_t kVectors = kGroup / hn::MaxLanes(d);  // that hold a group
    const bool finite = channel == 0;
    V total[1 + kChannels][kVectors];
    for (auto& group : total)
        for (V& lanes : group) lanes = hn::Zero(d);
    for (size_t s = 0; s < in.weights.stride(); s += kGroup)
        for (size_t b = 0; b < kVectors; ++b) {
            const size_t i = s + b * hn::Lanes(d);
            const V weight = hn::Mul(hn::Load(d, column + i), hn::Load(d, row + i));
            total[0][b] = hn::Add(total[0][b], weight);
            for (size_t c = 0; c < kChannels; ++c) {
                V product = hn::Mul(weight, hn::Load(d, in.channels[channel + c] + i));
                if (!finite) product = hn::IfThenZeroElse(hn::Eq(weight, hn::Zero(d)), product);
                total[1 + c][b] = hn::Add(total[1 + c][b], product);
            }
        }
    if (channel == 0) store_quarters<kGroup>(d, total[0], quarters);
    for (size_t c = 0; c < kChannels; ++c)
        store_quarters<kGroup>(d, total[1 + c], quarters + kQuarters<kGroup> * (1 + channel + c));
}

/// Adds up quarters, by halves: a multiple of vectors.
void add_quarters(const float* quarters, size_t count, float* sums) {
    const F d;
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
        Lanes q[4];
        hn::LoadInterleaved4(d, quarters + 4 * i, q[0], q[1], q[2], q[3]);
        hn::StoreU(hn::Add(hn::Add(q[0], q[2]), hn::Add(q[1], q[3])), d, sums + i);
    }
}

/// Sums for all pixels around, row by row, `sum_count` numbers each: a weight, and the channels.
template <size_t kGroup>
void sum_groups(const WeightedPlanes& in, SumsOfPixels& out) {
    const size_t step = kQuarters<kGroup> * out.per_pixel;
    float* at = kGroup == 1 ? out.sums.data() : out.quarters.data();
    for (int j = 0; j < in.row_count; ++j)
        for (int i = 0; i < in.column_count; ++i, at += step) {
            const float *const column = in.column(i, j), *const row = in.row(j);
            if (in.channels.empty()) sum_products<kGroup, 0>(in, 0, column, row, at);
            size_t c = 0;
            for (; c + kChannelsAtOnce <= in.channels.size(); c += kChannelsAtOnce)
                sum_products<kGroup, kChannelsAtOnce>(in, c, column, row, at);
            for (; c < in.channels.size(); ++c) sum_products<kGroup, 1>(in, c, column, row, at);
        }
    if (kGroup > 1) add_quarters(out.quarters.data(), out.count, out.sums.data());
}

void sum_samples(const WeightedPlanes& in, bool in_vectors, SumsOfPixels& out) {
    if (in_vectors)
        sum_groups<SamplePlanes::kVectorGroup>(in, out);
    else
        sum_groups<1>(in, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(weigh_samples);
HWY_EXPORT(weigh_samples_by_distance);
HWY_EXPORT(sum_samples);

PixelSums::PixelSums(const FilterKernel& kernel, size_t samples_per_pixel, size_t channels)
    : kernel_(kernel),
      count_(samples_per_pixel),
      columns_(kernel.x().columns()),
      rows_(kernel.y().columns()),
      weights_(static_cast<size_t>(kernel.is_separable() ? columns_ + rows_ : columns_ * rows_ + 1), count_),
      sums_(1 + channels, static_cast<size_t>(columns_ * rows_)),
      taps_(static_cast<size_t>(kernel.tap_count())) {
    if (!kernel.is_separable()) std::fill_n(weights_[static_cast<size_t>(columns_ * rows_)], count_, 1.0f);
}

void PixelSums::sum(const float* x, const float* y, int pixel_x, int pixel_y,
                    std::span<const float* const> planes) {
    const bool in_vectors = SamplePlanes::group_of(count_) > 1;
    if (!in_vectors) {
        weigh_one_by_one(x, y, pixel_x, pixel_y);
    } else if (kernel_.is_separable()) {
        const auto weigh = HWY_DYNAMIC_DISPATCH(weigh_samples);
        weigh(kernel_.x(), x, count_, pixel_x, columns_, weights_[0], weights_.stride());
        weigh(kernel_.y(), y, count_, pixel_y, rows_, weights_[static_cast<size_t>(columns_)],
              weights_.stride());
    } else {
        HWY_DYNAMIC_DISPATCH(weigh_samples_by_distance)(kernel_, x, y, count_, pixel_x, pixel_y, weights_);
    }
    HWY_DYNAMIC_DISPATCH(sum_samples)
    ({planes, weights_, kernel_.is_separable(), columns_, rows_}, in_vectors, sums_);
}

/// Weights of samples, each alone.
void PixelSums::weigh_one_by_one(const float* x, const float* y, int pixel_x, int pixel_y) {
    const int left = pixel_x - kernel_.reach_x(), above = pixel_y - kernel_.reach_y();
    const int planes = kernel_.is_separable() ? columns_ + rows_ : columns_ * rows_;
    std::fill_n(weights_[0], static_cast<size_t>(planes) * weights_.stride(), 0.0f);
    const auto set = [this](int plane, size_t sample, float weight) {
        weights_[static_cast<size_t>(plane)][sample] = weight;
    };
    const int taps_x = kernel_.taps_x(), taps_y = kernel_.taps_y();
    for (size_t s = 0; s < count_; ++s) {
        if (kernel_.is_separable()) {
            const int column = kernel_.x().weigh(x[s], pixel_x, taps_.data()) - left;
            for (int i = 0; i < taps_x && column + i < columns_; ++i) set(column + i, s, taps_[i]);
            const int row = kernel_.y().weigh(y[s], pixel_y, taps_.data()) - above;
            for (int j = 0; j < taps_y && row + j < rows_; ++j) set(columns_ + row + j, s, taps_[j]);
            continue;
        }
        const FilterTaps first = kernel_.weigh(x[s], y[s], pixel_x, pixel_y, taps_.data());
        const int column = first.x0 - left, row = first.y0 - above;
        for (int j = 0; j < taps_y && row + j < rows_; ++j)
            for (int i = 0; i < taps_x && column + i < columns_; ++i)
                set((row + j) * columns_ + column + i, s, taps_[j * taps_x + i]);
    }
}

}  // namespace trapeze
#endif  // HWY_ONCE
