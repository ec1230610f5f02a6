#include "shade/kernels.h"

#include <gtest/gtest.h>

#include <hwy/highway.h>
#include <bit>
#include <cmath>
#include <functional>
#include <random>

#include "shade/scalar_kernels.h"

namespace trapeze {
namespace {

constexpr size_t kCount = 1000;

/// Planes of random numbers, among them zeros, repeats and large ones.
class Planes {
  public:
    Planes() { pool_.start(kCount); }

    Plane numbers(float low, float high) {
        const Plane plane = pool_.take();
        std::uniform_real_distribution<float> number(low, high);
        for (float& x : plane) x = random_() % 16 == 0 ? 0 : number(random_);
        return plane;
    }
    Plane3 vectors(float size) {
        const Plane3 v{numbers(-size, size), numbers(-size, size), numbers(-size, size)};
        for (size_t i = 0; i < v.size(); i += 37) v.x[i] = v.y[i] = v.z[i] = 0;
        return v;
    }
    Plane3 unit_vectors() {
        const Plane3 v = vectors(1);
        kernels::normalize(v, 1, v);
        return v;
    }
    Plane3 copy(const Plane3& from) {
        const Plane3 to = pool_.take3();
        for (int k = 0; k < 3; ++k) std::copy(from[k].begin(), from[k].end(), to[k].begin());
        return to;
    }
    Plane3 out() { return vectors(1); }

  private:
    PlanePool pool_;
    std::mt19937 random_{7};
};

V3f at(ConstPlane3 p, size_t i) {
    return {p.x[i], p.y[i], p.z[i]};
}

/// Runs the body once for each instruction set of this machine that the kernels were compiled for.
void for_each_target(const std::function<void()>& body) {
    int targets = 0;
    const int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
    for (int64_t left = supported; left != 0; left &= left - 1, ++targets) {
        const int64_t target = left & -left;
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        body();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GT(targets, 0);
}

testing::AssertionResult same_bits(float a, float b) {
    if (std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << a << " and " << b;
}

void expect_twin(ConstPlane3 simd, const std::function<V3f(size_t)>& twin) {
    for (size_t i = 0; i < simd.size(); ++i) {
        const V3f expected = twin(i);
        for (int k = 0; k < 3; ++k) ASSERT_TRUE(same_bits(simd[k][i], expected[k])) << i << ' ' << k;
    }
}

void expect_twin(ConstPlane simd, const std::function<float(size_t)>& twin) {
    for (size_t i = 0; i < simd.size(); ++i) ASSERT_TRUE(same_bits(simd[i], twin(i))) << i;
}

TEST(Kernels, NormalsEqualTheirTwin) {
    for_each_target([] {
        Planes planes;
        const Plane3 v = planes.vectors(100), I = planes.vectors(5), out = planes.out();
        kernels::normalize(v, -1, out);
        expect_twin(out, [&](size_t i) { return scalar::normalize(at(v, i), -1); });
        kernels::facing_normal(v, I, out);
        expect_twin(out, [&](size_t i) { return scalar::facing_normal(at(v, i), at(I, i)); });
    });
}

TEST(Kernels, ReflectionEqualsItsTwin) {
    for_each_target([] {
        Planes planes;
        const Plane3 N = planes.unit_vectors(), V = planes.unit_vectors(), L = planes.unit_vectors();
        const Plane3 Cl = planes.vectors(3), before = planes.out(), out = planes.copy(before);
        const Plane roughness = planes.numbers(-0.01f, 0.5f);
        kernels::add_diffuse(N, L, Cl, out);
        expect_twin(out,
                    [&](size_t i) { return at(before, i) + scalar::diffuse(at(N, i), at(L, i), at(Cl, i)); });
        const Plane3 diffuse = planes.copy(out);
        kernels::add_specular(N, V, L, Cl, roughness, out);
        expect_twin(out, [&](size_t i) {
            return at(diffuse, i) + scalar::specular(at(N, i), at(V, i), at(L, i), at(Cl, i), roughness[i]);
        });
    });
}

TEST(Kernels, CombinationsEqualTheirTwin) {
    for_each_target([] {
        Planes planes;
        const Plane3 Os = planes.vectors(1), Cs = planes.vectors(1), a = planes.vectors(2);
        const Plane3 b = planes.vectors(2), I = planes.vectors(9), out = planes.out();
        const Plane ka = planes.numbers(0, 1), kb = planes.numbers(0, 1);
        kernels::lit(Os, Cs, ka, a, kb, b, out);
        const auto lit = [&](size_t i) {
            return (at(Os, i) * at(Cs, i)) * (at(a, i) * ka[i] + at(b, i) * kb[i]);
        };
        expect_twin(out, lit);
        kernels::add_highlight(Os, I, kb, b, out);
        expect_twin(out, [&](size_t i) { return lit(i) + (at(Os, i) * at(I, i)) * (at(b, i) * kb[i]); });
        kernels::default_surface(Os, Cs, a, I, ka, kb, out);
        expect_twin(out, [&](size_t i) {
            return scalar::default_surface(at(Os, i), at(Cs, i), at(a, i), at(I, i), ka[i], kb[i]);
        });
        kernels::multiply(a, b, out);
        expect_twin(out, [&](size_t i) { return at(a, i) * at(b, i); });
        kernels::add(I, out);
        expect_twin(out, [&](size_t i) { return at(a, i) * at(b, i) + at(I, i); });
        kernels::scale(ka, a, out);
        expect_twin(out, [&](size_t i) { return at(a, i) * ka[i]; });
        kernels::move_along(a, b, ka, kb, out);
        expect_twin(out, [&](size_t i) { return scalar::move_along(at(a, i), at(b, i), ka[i], kb[i]); });
    });
}

TEST(Kernels, LightsEqualTheirTwin) {
    const V3f from(0.3f, -2, 1), color(2, 1, 0.5f);
    const kernels::SpotCone cones[] = {{V3f(0.6f, 0, 0.8f), 0.5f, 0.7f, 2.5f},
                                       {V3f(0, 0, 1), 0.5f, 0.5f, 0},
                                       {V3f(0, 1, 0), -0.5f, 0.9f, 40}};
    for_each_target([&] {
        Planes planes;
        const Plane3 P = planes.vectors(4), L = planes.out(), direction = planes.out(), Cl = planes.out();
        for (int k = 0; k < 3; ++k) P[k][5] = from[k];
        kernels::point_light(P, from, color, L, direction, Cl);
        expect_twin(L, [&](size_t i) { return scalar::point_light(at(P, i), from, color).L; });
        expect_twin(direction,
                    [&](size_t i) { return scalar::point_light(at(P, i), from, color).direction; });
        expect_twin(Cl, [&](size_t i) { return scalar::point_light(at(P, i), from, color).Cl; });
        for (const kernels::SpotCone& cone : cones) {
            const Plane3 spot = planes.copy(Cl);
            kernels::spot_falloff(direction, cone, spot);
            expect_twin(spot,
                        [&](size_t i) { return scalar::spot_falloff(at(direction, i), cone, at(Cl, i)); });
        }
    });
}

TEST(Kernels, PatternsEqualTheirTwin) {
    M44f m;
    m.setAxisAngle(V3f(1, 2, 3).normalized(), 0.7f);
    m[3][0] = 4, m[3][1] = -1;
    for (float size : {1.0f, 300.0f, 1e12f}) {
        for_each_target([&] {
            Planes planes;
            const Plane3 p = planes.vectors(size), out = planes.out();
            const Plane value = planes.numbers(0, 1);
            kernels::transform_points(p, m, out);
            expect_twin(out, [&](size_t i) { return scalar::transform_point(at(p, i), m); });
            kernels::noise(p, value);
            expect_twin(value, [&](size_t i) { return scalar::noise(at(p, i)); });
            kernels::sine_waves(p, value);
            expect_twin(value, [&](size_t i) { return scalar::sine_waves(at(p, i)); });
        });
    }
}

TEST(ElementaryFunctions, AreAccurate) {
    for (float x = 1e-6f; x <= 1; x *= 1.0173f) {
        EXPECT_NEAR(scalar::log2(x), std::log2(static_cast<double>(x)), 2e-7 * (1 - std::log2(x)));
        for (float y : {0.5f, 1.0f, 2.0f, 10.0f, 100.0f}) {
            const double exact = std::pow(static_cast<double>(x), y);
            const double exponent = std::fabs(y * std::log2(x));
            if (exponent < 125) {
                EXPECT_NEAR(scalar::pow(x, y), exact, exact * (3e-7 + 2e-7 * exponent)) << x << ' ' << y;
            }
        }
    }
    for (float x = -3; x <= 3; x += 0.0137f)
        EXPECT_NEAR(scalar::sine_of_turns(x), std::sin(2 * M_PI * static_cast<double>(x)), 2e-6) << x;
    EXPECT_EQ(scalar::pow(0, 3), 0);
    EXPECT_EQ(scalar::pow(0, 0), 1);
    EXPECT_EQ(scalar::pow(1, 1e5f), 1);
    EXPECT_EQ(scalar::pow(0.5f, 1e30f), 0);
}

TEST(Noise, IsZeroAtTheLatticeSmoothAndBounded) {
    float least = 0, most = 0;
    for (int i = 0; i < 20000; ++i) {
        const float x = static_cast<float>(i) * 0.0137f;
        const V3f p(x, 0.37f * x, 5 - 0.71f * x);
        const float here = scalar::noise(p);
        least = std::min(least, here), most = std::max(most, here);
        EXPECT_LT(std::fabs(scalar::noise(p + V3f(1e-3f)) - here), 1e-2f);
    }
    EXPECT_LT(least, -0.5f);
    EXPECT_GT(most, 0.5f);
    EXPECT_GE(least, -1.1f);
    EXPECT_LE(most, 1.1f);
    EXPECT_EQ(scalar::noise(V3f(3, -7, 11)), 0);
}

}  // namespace
}  // namespace trapeze
