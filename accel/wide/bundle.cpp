/// Which form of accel/wide/bundle_trace-inl.h takes a bundle through a tree, and the copying of rays into
/// bundles. Compiled once a target; the best one that the machine has is chosen at each call.
#include "accel/wide/bundle.h"

#include <cmath>
#include <cstddef>

#include "accel/wide/bundle_scratch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/bundle.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "accel/wide/bundle_trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What dispatch calls, for one of four combinations known at compile time.
void trace(const TraceInput& in, RayBlur blur) {
    if (blur.motion) {
        if (blur.lens)
            BundleTrace<true, true, false>(in).run();
        else
            BundleTrace<true, false, false>(in).run();
    } else {
        if (blur.lens)
            BundleTrace<false, true, false>(in).run();
        else
            BundleTrace<false, false, kHasSharpPackets>(in).run();
    }
}

/// Copies components of rays as they lie in memory to planes; those not wanted become 0.
template <bool kMotion, bool kLens>
class RayGatherer {
  public:
    RayGatherer(const AxisRay* rays, const uint32_t* order, RayBundle& bundle)
        : rays_(rays), order_(order), bundle_(bundle) {}

    void run() const {
        size_t i = 0;
#if HWY_TARGET != HWY_SCALAR  // it has one lane
        for (; i + 4 <= bundle_.count; i += 4) four(i);
#endif
        for (; i < bundle_.count; ++i) one(i);
    }

  private:
#if HWY_TARGET != HWY_SCALAR
    /// Four rays at a time by shuffles of whole rays: gather instructions take several times as long.
    HWY_INLINE void four(size_t i) const {
        static_assert(offsetof(AxisRay, ux) == 12 && offsetof(AxisRay, uy) == 16 && sizeof(AxisRay) == 24);
        const hn::FixedTag<float, 4> d;
        const hn::FixedTag<float, 2> pair;
        const auto from = [&](size_t k) { return reinterpret_cast<const float*>(rays_ + order_[i + k]); };
        const float *a = from(0), *b = from(1), *c = from(2), *e = from(3);
        // A ray is ox, oy, oz, ux, uy, time: its first four floats are one load, its last two come with
        // another ray's.
        const auto first = [d](const float* ray) HWY_ATTR { return hn::LoadU(d, ray); };
        const auto last = [d, pair](const float* x, const float* y) HWY_ATTR {
            return hn::Combine(d, hn::LoadU(pair, y + 4), hn::LoadU(pair, x + 4));
        };
        const auto ra = first(a), rb = first(b), rc = first(c), re = first(e);
        const auto o_ab = hn::InterleaveLower(d, ra, rb), o_ce = hn::InterleaveLower(d, rc, re);
        const auto u_ab = hn::InterleaveUpper(d, ra, rb), u_ce = hn::InterleaveUpper(d, rc, re);
        const auto t_ab = last(a, b), t_ce = last(c, e), zero = hn::Zero(d);
        hn::Store(kLens ? hn::ConcatLowerLower(d, o_ce, o_ab) : zero, d, bundle_.ox + i);
        hn::Store(kLens ? hn::ConcatUpperUpper(d, o_ce, o_ab) : zero, d, bundle_.oy + i);
        hn::Store(hn::ConcatUpperUpper(d, u_ce, u_ab), d, bundle_.ux + i);
        hn::Store(hn::ConcatEven(d, t_ce, t_ab), d, bundle_.uy + i);
        hn::Store(kMotion ? hn::ConcatOdd(d, t_ce, t_ab) : zero, d, bundle_.time + i);
    }
#endif
    HWY_INLINE void one(size_t i) const {
        const AxisRay& ray = rays_[order_[i]];
        bundle_.ox[i] = kLens ? ray.ox : 0.0f, bundle_.oy[i] = kLens ? ray.oy : 0.0f;
        bundle_.ux[i] = ray.ux, bundle_.uy[i] = ray.uy;
        bundle_.time[i] = kMotion ? ray.time : 0.0f;
    }

    const AxisRay* rays_;
    const uint32_t* order_;
    RayBundle& bundle_;
};

void fill(std::span<const AxisRay> rays, std::span<const uint32_t> order, RayBlur blur, RayBundle& bundle) {
    bundle.count = order.size();
    if (blur.motion)
        blur.lens ? RayGatherer<true, true>(rays.data(), order.data(), bundle).run()
                  : RayGatherer<true, false>(rays.data(), order.data(), bundle).run();
    else
        blur.lens ? RayGatherer<false, true>(rays.data(), order.data(), bundle).run()
                  : RayGatherer<false, false>(rays.data(), order.data(), bundle).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(trace);
HWY_EXPORT(fill);

BundleScratchPointer make_bundle_scratch() {
    return BundleScratchPointer(new BundleScratch);
}
void DeleteBundleScratch::operator()(BundleScratch* scratch) const {
    delete scratch;
}

void fill_bundle(std::span<const AxisRay> rays, std::span<const uint32_t> order, RayBlur blur,
                 RayBundle& bundle) {
    HWY_DYNAMIC_DISPATCH(fill)(rays, order, blur, bundle);
}

void trace_bundle(const WideTree& tree, DepthRange range, bool lens, float focal_distance, RayBundle& rays,
                  BundleScratch& scratch, SampleStats& stats) {
    rays.layers.begin(rays.wanted_layers.most == 0 ? 0 : rays.count, rays.wanted_layers);
    if (rays.count == 0) return;
    // Without a lens the focal distance may be any: 0 for its inverse leaves out what it is multiplied by.
    const TraceInput in{tree, range, lens ? 1 / focal_distance : 0.0f, rays, scratch, stats};
    HWY_DYNAMIC_DISPATCH(trace)(in, {tree.moves(), lens});
}

}  // namespace trapeze
#endif  // HWY_ONCE
