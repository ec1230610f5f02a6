/// The SIMD form of the predicate against the scalar one, bit for bit, on every target of the machine.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/hit_micropolygon.h"
#include "core/simd/targets_harness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/hit_micropolygon_simd_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/hit_micropolygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// Lanes are rays (SoA, `count` padded to whole vectors) against one quad.
void test_rays(const float* ox, const float* oy, const float* oz, const float* ux, const float* uy,
               size_t count, const Quad& quad, Facing facing, float* depth, uint8_t* hit) {
    const hn::ScalableTag<float> d;
    HWY_ALIGN float is_hit[hn::MaxLanes(d)];
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto vertex = [&](int component, int corner) HWY_ATTR {
            return hn::Set(d, (component == 0 ? quad.x : component == 1 ? quad.y : quad.z)[corner]);
        };
        auto z = hn::Zero(d);
        const auto mask =
            hit_micropolygon(d, hn::LoadU(d, ox + i), hn::LoadU(d, oy + i), hn::LoadU(d, oz + i),
                             hn::LoadU(d, ux + i), hn::LoadU(d, uy + i), vertex, facing, z);
        hn::StoreU(z, d, depth + i);
        hn::Store(hn::IfThenElseZero(mask, hn::Set(d, 1.0f)), d, is_hit);
        for (size_t lane = 0; lane < hn::Lanes(d); ++lane) hit[i + lane] = is_hit[lane] != 0;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

using testing::for_each_target;

HWY_EXPORT(test_rays);

constexpr size_t kRays = 64;

/// Numbers that are likely to meet: small integers, their neighbours, ordinary ones, the extremes and NaN.
class Awkward {
  public:
    explicit Awkward(bool extreme) : extreme_(extreme) {}

    float operator()() {
        switch (engine_() % (extreme_ ? 16 : 8)) {
            case 0:
                return static_cast<float>(static_cast<int>(engine_() % 5) - 2);
            case 1:
                return std::nextafter(static_cast<float>(static_cast<int>(engine_() % 3) - 1), 5.0f);
            case 8:
                return -kLargestCoordinate;  // products overflow, differences of infinities are not numbers
            case 9:
                return kLargestCoordinate;
            case 10:
                return 1e25f;
            case 11:
                return -1e-40f;
            case 12:
                return 1e-30f;
            default:
                return std::uniform_real_distribution<float>(-2, 2)(engine_);
        }
    }
    uint32_t bits() { return engine_(); }

  private:
    std::mt19937 engine_{11};
    bool extreme_;
};

Quad awkward_quad(Awkward& number) {
    Quad q;
    for (int i = 0; i < 4; ++i) q.x[i] = number(), q.y[i] = number(), q.z[i] = number();
    const auto copy = [&q](int to, int from) {
        q.x[to] = q.x[from], q.y[to] = q.y[from], q.z[to] = q.z[from];
    };
    switch (number.bits() % 6) {
        case 0:
            copy(1, 0);
            break;  // a triangle
        case 1:
            copy(2, 0), copy(3, 1);
            break;  // a line
        case 2:
            copy(1, 0), copy(2, 0), copy(3, 0);
            break;  // a point
        case 3:
            q.x[3] = q.x[0] + 1e-7f, q.y[3] = q.y[0];
            break;  // a needle
        default:
            break;  // bow-ties among them
    }
    return q;
}

/// Equal bits, or both not a number.
bool same(float a, float b) {
    return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

void compare(bool extreme) {
    Awkward number(extreme);
    size_t hits = 0;
    for (int round = 0; round < 4000; ++round) {
        std::vector<AxisRay> rays(kRays);
        std::vector<float> plane[5];
        for (AxisRay& ray : rays) {
            ray = {number(), number(), round % 2 ? number() : 0.0f, number(), number(), 0};
            const float values[5] = {ray.ox, ray.oy, ray.oz, ray.ux, ray.uy};
            for (int k = 0; k < 5; ++k) plane[k].push_back(values[k]);
        }
        const Quad quad = awkward_quad(number);
        const auto facing = static_cast<Facing>(round % 3);
        float depth[kRays];
        uint8_t hit[kRays];
        HWY_DYNAMIC_DISPATCH(test_rays)
        (plane[0].data(), plane[1].data(), plane[2].data(), plane[3].data(), plane[4].data(), kRays, quad,
         facing, depth, hit);
        for (size_t i = 0; i < kRays; ++i) {
            float expected = 0;
            ASSERT_EQ(hit[i] != 0, hit_micropolygon(rays[i], quad, facing, &expected)) << round << ' ' << i;
            if (!hit[i]) continue;
            ++hits;
            ASSERT_TRUE(same(depth[i], expected)) << depth[i] << ' ' << expected;
        }
    }
    EXPECT_GT(hits, 5000u);
}

TEST(HitMicropolygonSimd, EqualsTheScalarFormOnEveryTarget) {
    for_each_target([] { compare(false), compare(true); });
}

}  // namespace
}  // namespace trapeze
#endif  // HWY_ONCE
