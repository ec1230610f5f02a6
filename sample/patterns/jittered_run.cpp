#include "sample/patterns/jittered_run.h"

#include <algorithm>
#include <cstddef>

#include "sample/patterns/strata.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/patterns/jittered_run.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using U = hn::ScalableTag<uint32_t>;
using I = hn::ScalableTag<int32_t>;
using FloatLanes = hn::Vec<F>;
using WordLanes = hn::Vec<U>;

/// hash() of core/random.h in lanes.
HWY_INLINE WordLanes hash(WordLanes x) {
    const U d;
    x = hn::Add(hn::Mul(x, hn::Set(d, 747796405u)), hn::Set(d, 2891336453u));
    const WordLanes shift = hn::Add(hn::ShiftRight<28>(x), hn::Set(d, 4u));
    x = hn::Mul(hn::Xor(hn::Shr(x, shift), x), hn::Set(d, 277803737u));
    return hn::Xor(hn::ShiftRight<22>(x), x);
}

/// unit_float(hash(sample's hash + dimension)) in lanes: 24 bits in [0, 1).
HWY_INLINE FloatLanes jitter(WordLanes sample_hash, SampleDimension dimension) {
    const WordLanes bits = hash(hn::Add(sample_hash, hn::Set(U(), static_cast<uint32_t>(dimension))));
    return hn::Mul(hn::ConvertTo(F(), hn::BitCast(I(), hn::ShiftRight<8>(bits))),
                   hn::Set(F(), 1.0f / 16777216.0f));
}

/// place() of strata.h in lanes, the same operations in the same order.
HWY_INLINE FloatLanes place(FloatLanes index, FloatLanes at, float count) {
    const F d;
    return hn::Min(hn::Div(hn::Add(index, at), hn::Set(d, count)), hn::Set(d, kBelowOne));
}

/// turned() of strata.h, as a float.
HWY_INLINE FloatLanes turned(WordLanes region, WordLanes turn, int count) {
    const U d;
    const WordLanes flipped = hn::Xor(region, hn::And(turn, hn::Set(d, 0xffffu)));
    const WordLanes moved = hn::Add(flipped, hn::ShiftRight<16>(turn));
    const WordLanes within = hn::Min(moved, hn::Sub(moved, hn::Set(d, static_cast<uint32_t>(count))));
    return hn::ConvertTo(F(), hn::BitCast(I(), within));
}

/// disk_from_square(), the same operations in the same order.
HWY_INLINE void disk_from_square(FloatLanes u, FloatLanes v, FloatLanes& x, FloatLanes& y) {
    const F d;
    const FloatLanes one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    const FloatLanes a = hn::Sub(hn::Mul(two, u), one), b = hn::Sub(hn::Mul(two, v), one);
    const auto wide = hn::Gt(hn::Abs(a), hn::Abs(b));
    const FloatLanes r = hn::IfThenElse(wide, a, b), other = hn::IfThenElse(wide, b, a);
    const FloatLanes divisor = hn::IfThenElse(hn::Eq(r, hn::Zero(d)), one, r);
    const FloatLanes angle = hn::Mul(hn::Set(d, kQuarterPi), hn::Div(other, divisor));
    const FloatLanes z = hn::Mul(angle, angle);
    const auto term = [d, z](FloatLanes sum, float next)
                          HWY_ATTR { return hn::Add(hn::Mul(sum, z), hn::Set(d, next)); };
    const FloatLanes sine =
        hn::Mul(term(term(term(hn::Set(d, kSine[0]), kSine[1]), kSine[2]), kSine[3]), angle);
    const FloatLanes cosine =
        term(term(term(term(hn::Set(d, kCosine[0]), kCosine[1]), kCosine[2]), kCosine[3]), kCosine[4]);
    const FloatLanes along = hn::Mul(r, cosine), across = hn::Mul(r, sine);
    x = hn::IfThenElse(wide, along, across);
    y = hn::IfThenElse(wide, across, along);
}

/// LensShape::from_square() to an outline, the same operations in the same order.
HWY_INLINE void polygon_from_square(const LensOutline& outline, FloatLanes u, FloatLanes v, FloatLanes& x,
                                    FloatLanes& y) {
    const F d;
    const FloatLanes zero = hn::Zero(d), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    const FloatLanes a = hn::Sub(hn::Mul(two, u), one), b = hn::Sub(hn::Mul(two, v), one);
    const auto wide = hn::Gt(hn::Abs(a), hn::Abs(b));
    const FloatLanes r = hn::IfThenElse(wide, a, b), other = hn::IfThenElse(wide, b, a);
    const FloatLanes ratio = hn::Div(other, hn::IfThenElse(hn::Eq(r, zero), one, r));
    const FloatLanes quarter = hn::Add(hn::IfThenElse(wide, one, hn::Set(d, 3.0f)),
                                       hn::IfThenElseZero(hn::Lt(r, zero), hn::Set(d, 4.0f)));
    const auto count = static_cast<float>(outline.size());
    const FloatLanes place =
        hn::Mul(hn::Add(quarter, hn::IfThenElse(wide, ratio, hn::Neg(ratio))), hn::Set(d, count * 0.125f));
    const hn::Vec<I> corner = hn::ConvertTo(I(), hn::Min(place, hn::Set(d, count - 1)));
    const FloatLanes part = hn::Sub(place, hn::ConvertTo(d, corner));
    const float density = outline.density, even = 1 - density;
    const FloatLanes inner =
        hn::Max(hn::Add(hn::Set(d, even * even), hn::Mul(hn::Set(d, 4 * density), hn::Mul(r, r))), zero);
    const FloatLanes divisor = hn::Max(hn::Add(hn::Set(d, even), hn::Sqrt(inner)), hn::Set(d, kLeastDivisor));
    const FloatLanes distance = hn::Mul(hn::Abs(r), hn::Sqrt(hn::Div(two, divisor)));
    const auto on_rim = [&](const std::vector<float>& from, const std::vector<float>& along) HWY_ATTR {
        return hn::Add(hn::GatherIndex(d, from.data(), corner),
                       hn::Mul(part, hn::GatherIndex(d, along.data(), corner)));
    };
    x = hn::Mul(distance, on_rim(outline.x, outline.dx));
    y = hn::Mul(distance, on_rim(outline.y, outline.dy));
}

/// What samples have of their pixel: its only one's, or looked up. A gather of lanes costs about as much as
/// the rest of a sample's place, so runs within one pixel are spared it.
template <bool kOnePixel>
struct PixelLanes {
    const RunPixels& pixels;
    hn::Vec<I> slot;

    HWY_INLINE WordLanes word(const uint32_t* of) const {
        if constexpr (kOnePixel)
            return hn::Set(U(), *of);
        else
            return hn::GatherIndex(U(), of, slot);
    }
    HWY_INLINE FloatLanes number(const float* of) const {
        if constexpr (kOnePixel)
            return hn::Set(F(), *of);
        else
            return hn::GatherIndex(F(), of, slot);
    }
};

/// Camera::ray(), the same operations in the same order.
HWY_INLINE void store_rays(const Camera& camera, FloatLanes x, FloatLanes y, FloatLanes lens_u,
                           FloatLanes lens_v, size_t at, RunSamples& out) {
    const F d;
    const FloatLanes plane_x =
        hn::Add(hn::Mul(x, hn::Set(d, camera.plane_scale_x)), hn::Set(d, camera.plane_offset_x));
    const FloatLanes plane_y =
        hn::Add(hn::Mul(y, hn::Set(d, camera.plane_scale_y)), hn::Set(d, camera.plane_offset_y));
    const FloatLanes radius = hn::Set(d, camera.lens_radius), focal = hn::Set(d, camera.focal_distance);
    const FloatLanes lens_x = hn::Mul(lens_u, radius), lens_y = hn::Mul(lens_v, radius);
    const FloatLanes slope_x = hn::Div(lens_x, focal), slope_y = hn::Div(lens_y, focal);
    if (camera.perspective) {
        hn::Store(lens_x, d, out.ox + at), hn::Store(lens_y, d, out.oy + at);
        hn::Store(hn::Sub(plane_x, slope_x), d, out.ux + at);
        hn::Store(hn::Sub(plane_y, slope_y), d, out.uy + at);
    } else {
        hn::Store(hn::Add(plane_x, lens_x), d, out.ox + at);
        hn::Store(hn::Add(plane_y, lens_y), d, out.oy + at);
        hn::Store(hn::Neg(slope_x), d, out.ux + at), hn::Store(hn::Neg(slope_y), d, out.uy + at);
    }
}

/// The order of operations is that of the scalar place(), disk_from_square() and Camera::ray(): the bounds
/// that StratifiedPattern gives for slots are made by these, and hold only for equal bits.
template <bool kOnePixel>
HWY_INLINE void make_samples(const RunRegions& regions, const RunPixels& pixels, const Camera& camera,
                             size_t first, size_t count, RunSamples& out) {
    const F d;
    const U du;
    const auto nx = static_cast<float>(regions.nx), ny = static_cast<float>(regions.ny);
    const auto all = static_cast<float>(regions.samples_per_pixel());
    const WordLanes all_words = hn::Set(du, static_cast<uint32_t>(regions.samples_per_pixel()));
    for (size_t at = 0; at < count; at += hn::Lanes(d)) {
        const size_t i = first + at;
        const PixelLanes<kOnePixel> pixel{pixels, hn::BitCast(I(), hn::LoadU(du, regions.pixel.data() + i))};
        const WordLanes sample_hash =
            hash(hn::Add(pixel.word(pixels.hash), hn::LoadU(du, &regions.index[i])));
        const FloatLanes middle = hn::Set(d, 0.5f);
        const FloatLanes at_x = regions.jittered ? jitter(sample_hash, kSubpixelX) : middle;
        const FloatLanes at_y = regions.jittered ? jitter(sample_hash, kSubpixelY) : middle;
        const FloatLanes column =
            turned(hn::LoadU(du, &regions.column[i]), pixel.word(pixels.turn_x), regions.nx);
        const FloatLanes row = turned(hn::LoadU(du, &regions.row[i]), pixel.word(pixels.turn_y), regions.ny);
        const FloatLanes in_x = place(column, at_x, nx), in_y = place(row, at_y, ny);
        const FloatLanes x = hn::Min(hn::Add(pixel.number(pixels.x), in_x), pixel.number(pixels.x_limit));
        const FloatLanes y = hn::Min(hn::Add(hn::Set(d, pixels.y), in_y), hn::Set(d, pixels.y_limit));
        FloatLanes lens_u = hn::Zero(d), lens_v = hn::Zero(d), time = hn::Zero(d);
        if (regions.lens) {
            const FloatLanes u =
                place(hn::LoadU(d, &regions.lens_column[i]), jitter(sample_hash, kLensU), nx);
            const FloatLanes v = place(hn::LoadU(d, &regions.lens_row[i]), jitter(sample_hash, kLensV), ny);
            if (regions.outline.size() != 0)
                polygon_from_square(regions.outline, u, v, lens_u, lens_v);
            else
                disk_from_square(u, v, lens_u, lens_v);
        }
        if (regions.motion) {
            const WordLanes moved = hn::Add(hn::LoadU(du, &regions.time[i]), pixel.word(pixels.time_shift));
            const WordLanes region = hn::Min(moved, hn::Sub(moved, all_words));  // modulo: below 0 is huge
            time = place(hn::ConvertTo(d, hn::BitCast(I(), region)), jitter(sample_hash, kTime), all);
        }
        hn::Store(x, d, out.x + at), hn::Store(y, d, out.y + at);
        hn::Store(lens_u, d, out.lens_u + at), hn::Store(lens_v, d, out.lens_v + at);
        hn::Store(time, d, out.time + at);
        store_rays(camera, x, y, lens_u, lens_v, at, out);
    }
}

void make_run_samples(const RunRegions& regions, const RunPixels& pixels, const Camera& camera, size_t first,
                      size_t count, RunSamples& out) {
    if (regions.pixels == 1)
        make_samples<true>(regions, pixels, camera, first, count, out);
    else
        make_samples<false>(regions, pixels, camera, first, count, out);
}

/// Four rays at a time, as three pairs of floats each: (ox, oy), (0, ux), (uy, time).
void interleave_rays(const RunSamples& samples, size_t count, AxisRay* rays) {
    size_t i = 0;
#if HWY_TARGET != HWY_SCALAR  // it has one lane
    const hn::FixedTag<float, 4> d;
    const hn::FixedTag<uint64_t, 2> pairs;
    const auto two_rays = [pairs](auto o, auto mixed, auto u, AxisRay* to) HWY_ATTR {
        auto* const at = reinterpret_cast<uint64_t*>(to);
        hn::StoreU(hn::InterleaveLower(pairs, o, mixed), pairs, at);
        hn::StoreU(hn::ConcatUpperLower(pairs, o, u), pairs, at + 2);
        hn::StoreU(hn::InterleaveUpper(pairs, mixed, u), pairs, at + 4);
    };
    for (; i + 4 <= count; i += 4) {
        const auto ox = hn::Load(d, samples.ox + i), oy = hn::Load(d, samples.oy + i), oz = hn::Zero(d);
        const auto ux = hn::Load(d, samples.ux + i), uy = hn::Load(d, samples.uy + i);
        const auto time = hn::Load(d, samples.time + i);
        two_rays(hn::BitCast(pairs, hn::InterleaveLower(d, ox, oy)),
                 hn::BitCast(pairs, hn::InterleaveLower(d, oz, ux)),
                 hn::BitCast(pairs, hn::InterleaveLower(d, uy, time)), rays + i);
        two_rays(hn::BitCast(pairs, hn::InterleaveUpper(d, ox, oy)),
                 hn::BitCast(pairs, hn::InterleaveUpper(d, oz, ux)),
                 hn::BitCast(pairs, hn::InterleaveUpper(d, uy, time)), rays + i + 2);
    }
#endif
    for (; i < count; ++i)
        rays[i] = {samples.ox[i], samples.oy[i], 0, samples.ux[i], samples.uy[i], samples.time[i]};
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(make_run_samples);
HWY_EXPORT(interleave_rays);

/// Several pixels of few samples make one run, so that vectors are full. Regions repeat from pixel to pixel;
/// padding repeats them too, for vectors that reach past the end must read numbers.
RunRegions::RunRegions(int columns, int rows, bool has_lens, bool has_motion,
                       const std::vector<uint32_t>& lens_of, const std::vector<uint32_t>& time_of)
    : nx(columns), ny(rows), lens(has_lens), motion(has_motion) {
    const auto count = static_cast<size_t>(samples_per_pixel());
    pixels = std::clamp<size_t>(RunSamples::kCount / count, 1, kMaxRunPixels);
    if (count >= RunSamples::kPadding) pixels = 1;  // vectors are full as it is
    const auto width = static_cast<uint32_t>(nx);
    for (size_t s = 0; s < pixels * count + RunSamples::kPadding; ++s) {
        const auto i = static_cast<uint32_t>(s % count);
        index.push_back(i);
        pixel.push_back(static_cast<uint32_t>(std::min(s / count, pixels - 1)));
        column.push_back(i % width), row.push_back(i / width);
        lens_column.push_back(static_cast<float>(lens_of[i] % width));
        lens_row.push_back(static_cast<float>(lens_of[i] / width));
        time.push_back(time_of[i]);
    }
}

/// For a level of adaptive sampling: the samples keep their index in the pixel, and with it their hash and
/// their jitter, so that a level's samples are those of the whole pattern.
RunRegions::RunRegions(const RunRegions& whole, std::span<const uint32_t> samples)
    : nx(whole.nx),
      ny(whole.ny),
      lens(whole.lens),
      motion(whole.motion),
      outline(whole.outline),
      jittered(whole.jittered) {
    for (size_t s = 0; s < samples.size() + RunSamples::kPadding; ++s) {
        const uint32_t i = samples[s % samples.size()];  // the first pixel of a run is the whole one's
        index.push_back(i), pixel.push_back(0);
        column.push_back(whole.column[i]), row.push_back(whole.row[i]);
        lens_column.push_back(whole.lens_column[i]), lens_row.push_back(whole.lens_row[i]);
        time.push_back(whole.time[i]);
    }
}

/// Two forms, since a run within one pixel has its pixel's numbers in all lanes, and need not look them up.
void make_run_samples(const RunRegions& regions, const RunPixels& pixels, const Camera& camera, size_t first,
                      size_t count, RunSamples& out) {
    HWY_DYNAMIC_DISPATCH(make_run_samples)(regions, pixels, camera, first, count, out);
}

/// From planes to structures, whose order of members the vector code takes for granted: hence the checks.
void interleave_rays(const RunSamples& samples, size_t count, AxisRay* rays) {
    static_assert(offsetof(AxisRay, ox) == 0 && offsetof(AxisRay, oy) == 4 && offsetof(AxisRay, oz) == 8 &&
                  offsetof(AxisRay, ux) == 12 && offsetof(AxisRay, uy) == 16 &&
                  offsetof(AxisRay, time) == 20 && sizeof(AxisRay) == 24);
    HWY_DYNAMIC_DISPATCH(interleave_rays)(samples, count, rays);
}

}  // namespace trapeze
#endif  // HWY_ONCE
