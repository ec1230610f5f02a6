#include "composite/layers/composite_samples.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/layers/composite_samples.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kMostLanes = 16;
using F = hn::CappedTag<float, kMostLanes>;
using I = hn::RebindToSigned<F>;
using FloatLanes = hn::Vec<F>;
using IntLanes = hn::Vec<I>;

/// LayerSum, in lanes.
struct SumLanes {
    FloatLanes transmission[3], color[3], alpha[3];
    IntLanes nearest;
};

/// std::clamp(opacity, 0, 1): what is no number stays.
HWY_INLINE FloatLanes hiding(FloatLanes opacity) {
    const F d;
    const FloatLanes zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    return hn::IfThenElse(hn::Lt(opacity, zero), zero, hn::IfThenElse(hn::Lt(one, opacity), one, opacity));
}

/// Where layers are in the planes, of lanes that have one.
struct PlaneLanes {
    bool follow;  ///< each other, from `start` on
    uint32_t start;
    IntLanes places;  ///< where they do not

    HWY_INLINE FloatLanes of(const float* plane) const {
        const F d;
        return follow ? hn::LoadU(d, plane + start) : hn::GatherIndex(d, plane, places);
    }
};
/// Layers that all of the samples have, the first of them layer `first`.
HWY_INLINE PlaneLanes places_of_all(const LayersOfSamples& in, int32_t first) {
    return {true, in.places ? in.places[first] : static_cast<uint32_t>(first), hn::Zero(I())};
}
/// Layers by their numbers.
HWY_INLINE PlaneLanes places_of_some(const LayersOfSamples& in, IntLanes layers) {
    if (!in.places) return {false, 0, layers};
    return {false, 0, hn::GatherIndex(I(), reinterpret_cast<const int32_t*>(in.places), layers)};
}

/// Adds layers, where samples have one.
HWY_INLINE void add_layers(const float* const* planes, const PlaneLanes& at, IntLanes layer,
                           hn::Mask<F> has_one, SumLanes& sum) {
    const F d;
    const FloatLanes zero = hn::Zero(d);
    auto traceless = has_one;
    for (int c = 0; c < 3; ++c) {
        const FloatLanes color = at.of(planes[c]), opacity = at.of(planes[3 + c]), hides = hiding(opacity);
        traceless = hn::And(traceless, hn::And(hn::Eq(color, zero), hn::Eq(opacity, zero)));
        const auto add = [&](FloatLanes& to, FloatLanes value) HWY_ATTR {
            to = hn::IfThenElse(has_one, hn::Add(to, hn::Mul(sum.transmission[c], value)), to);
        };
        add(sum.color[c], color), add(sum.alpha[c], hides);
        const FloatLanes behind = hn::Mul(sum.transmission[c], hn::Sub(hn::Set(d, 1.0f), hides));
        sum.transmission[c] = hn::IfThenElse(has_one, behind, sum.transmission[c]);
    }
    const I di;
    const auto is_nearest =
        hn::And(hn::RebindMask(di, hn::AndNot(traceless, has_one)), hn::Lt(sum.nearest, hn::Zero(di)));
    sum.nearest = hn::IfThenElse(is_nearest, layer, sum.nearest);
}

/// mean_of_channels()
HWY_INLINE FloatLanes mean_of(const FloatLanes* channels) {
    const F d;
    const auto gray = hn::And(hn::Eq(channels[0], channels[1]), hn::Eq(channels[1], channels[2]));
    const FloatLanes mean =
        hn::Div(hn::Add(hn::Add(channels[0], channels[1]), channels[2]), hn::Set(d, 3.0f));
    return hn::IfThenElse(gray, channels[0], mean);
}

/// Of up to as many samples as there are lanes; the first of them is number `sample`.
HWY_INLINE void composite_lanes(const LayersOfSamples& in, size_t sample, float* const* rgba,
                                int32_t* nearest) {
    const F d;
    const I di;
    const size_t count = std::min(in.count - sample, hn::Lanes(d));
    alignas(64) int32_t begin[kMostLanes] = {}, end[kMostLanes] = {};
    int32_t least = std::numeric_limits<int32_t>::max(), most = 0;
    for (size_t i = 0; i < count; ++i) {
        begin[i] = static_cast<int32_t>(in.first[sample + i] - in.first[0]);
        end[i] = static_cast<int32_t>(in.first[sample + i + 1] - in.first[0]);
        least = std::min(least, end[i] - begin[i]), most = std::max(most, end[i] - begin[i]);
    }
    SumLanes sum;
    for (int c = 0; c < 3; ++c) {
        sum.transmission[c] = hn::Set(d, 1.0f);
        sum.color[c] = sum.alpha[c] = hn::Zero(d);
    }
    sum.nearest = hn::Set(di, -1);
    const IntLanes last = hn::Load(di, end);
    IntLanes layer = hn::Load(di, begin);
    for (int32_t k = 0; k < most; ++k, layer = hn::Add(layer, hn::Set(di, 1))) {
        const FloatLanes zero = hn::Zero(d);
        const auto hidden =
            hn::And(hn::And(hn::Eq(sum.transmission[0], zero), hn::Eq(sum.transmission[1], zero)),
                    hn::Eq(sum.transmission[2], zero));
        const auto has_one = hn::AndNot(hidden, hn::RebindMask(d, hn::Lt(layer, last)));
        if (hn::AllFalse(d, has_one)) break;
        // Others may ask for any layer that is there.
        const IntLanes numbers = hn::IfThenElseZero(hn::RebindMask(di, has_one), layer);
        const PlaneLanes at = k < least ? places_of_all(in, begin[0] + k) : places_of_some(in, numbers);
        add_layers(in.planes, at, numbers, has_one, sum);
    }
    alignas(64) float numbers[4][kMostLanes];
    alignas(64) int32_t seen[kMostLanes];
    for (int c = 0; c < 3; ++c) hn::Store(sum.color[c], d, numbers[c]);
    hn::Store(mean_of(sum.alpha), d, numbers[3]);
    hn::Store(sum.nearest, di, seen);
    for (int c = 0; c < 4; ++c) std::copy_n(numbers[c], count, rgba[c] + sample);
    std::copy_n(seen, count, nearest + sample);
}

void composite_samples_in_lanes(const LayersOfSamples& in, float* const* rgba, int32_t* nearest) {
    for (size_t sample = 0; sample < in.count; sample += hn::Lanes(F()))
        composite_lanes(in, sample, rgba, nearest);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(composite_samples_in_lanes);

void composite_samples(const LayersOfSamples& layers, float* const* rgba, int32_t* nearest) {
    HWY_DYNAMIC_DISPATCH(composite_samples_in_lanes)(layers, rgba, nearest);
}

}  // namespace trapeze
#endif  // HWY_ONCE
