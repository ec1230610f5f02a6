#include "shade/vm/kernels/light_kernels.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/math.h"
#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using testing::for_each_target;
using testing::KernelNumbers;
using testing::Register;

constexpr size_t kLit = 128;

V3d at(const Register& r, size_t i) {
    return {r.at(i, 0), r.at(i, 1), r.at(i, 2)};
}

/// A light and a surface at each vertex; some are black, some without direction.
class LightKernels : public ::testing::TestWithParam<bool> {
  protected:
    LightKernels()
        : N(vectors(1)),
          V(vectors(1)),
          L(vectors(1)),
          Cl(3, GetParam(), kLit),
          roughness(1, GetParam(), kLit),
          size(1, GetParam(), kLit),
          before(3, false, kLit) {
        Cl.fill([this] { return numbers_.between(0, 2); });
        roughness.fill([this] { return numbers_.between(0.02f, 1); });
        size.fill([this] { return numbers_.between(1, 50); });
        before.fill([this] { return numbers_.between(0, 1); });
    }

    Register vectors(float length) {
        Register r(3, GetParam(), kLit);
        for (size_t i = 0; i < kLit; ++i) {
            const V3f v(numbers_.between(-1, 1), numbers_.between(-1, 1), numbers_.between(-1, 1));
            for (int k = 0; k < 3; ++k)
                r.set(i, k, i % 32 == 5 && !GetParam() ? 0 : v.normalized()[k] * length);
        }
        return r;
    }

    /// On every target: what is added is `lobe` times Cl / 2.
    void check(const std::function<void(const Operand&)>& add, const std::function<double(size_t)>& lobe) {
        for_each_target([&] {
            Register out = before;
            add(out.operand());
            for (size_t i = 0; i < kLit; ++i)
                for (int k = 0; k < 3; ++k)
                    EXPECT_NEAR(out.at(i, k), before.at(i, k) + lobe(i) * Cl.at(i, k) * 0.5, 2e-5)
                        << i << ' ' << k;
            if (first_.empty()) first_.push_back(out);
            EXPECT_TRUE(std::equal(out.planes().begin(), out.planes().end(), first_[0].planes().begin()));
        });
        first_.clear();
    }

    KernelNumbers numbers_;
    std::vector<Register> first_;
    Register N, V, L, Cl, roughness, size, before;
};

TEST_P(LightKernels, AddUp) {
    check([&](const Operand& out) { add_light(kLit, Cl.operand(), 0.5f, out); }, [](size_t) { return 1; });
    check([&](const Operand& out) { add_diffuse(kLit, N.operand(), L.operand(), Cl.operand(), 0.5f, out); },
          [&](size_t i) { return std::max(0.0, at(N, i).dot(at(L, i))); });
}

double specular(const V3d& N, const V3d& V, const V3d& L, double roughness) {
    if (N.dot(L) <= 0) return 0;
    return std::pow(std::max(0.0, N.dot((V + L).normalized())), 8 / roughness);
}

TEST_P(LightKernels, AddHighlights) {
    check(
        [&](const Operand& out) {
            add_specular(kLit, N.operand(), V.operand(), roughness.operand(), L.operand(), Cl.operand(), 0.5f,
                         out);
        },
        [&](size_t i) { return specular(at(N, i), at(V, i), at(L, i), roughness.at(i, 0)); });
    check(
        [&](const Operand& out) {
            add_phong(kLit, N.operand(), V.operand(), size.operand(), L.operand(), Cl.operand(), 0.5f, out);
        },
        [&](size_t i) {
            const V3d n = at(N, i), v = at(V, i), mirrored = (n * (2 * n.dot(v)) - v).normalized();
            const double cosine = mirrored.dot(at(L, i));
            return cosine > 0 ? std::pow(cosine, size.at(i, 0)) : 0;
        });
}

TEST_P(LightKernels, GiveTheShareOfOneDirection) {
    Register far = vectors(7), out(3, false, kLit), single(1, false, kLit);
    for_each_target([&] {
        const Operand inputs[] = {far.operand(), N.operand(), V.operand(), roughness.operand()};
        find_kernel(rsl::Op::SpecularBrdf, std::vector{3, 3, 3, 3, 1})(
            kLit, std::vector{out.operand(), inputs[0], inputs[1], inputs[2], inputs[3]});
        find_kernel(rsl::Op::SpecularBrdf, std::vector{1, 3, 3, 3, 1})(
            kLit, std::vector{single.operand(), inputs[0], inputs[1], inputs[2], inputs[3]});
        for (size_t i = 0; i < kLit; ++i) {
            const double lobe = specular(at(N, i), at(V, i), at(far, i).normalized(), roughness.at(i, 0));
            EXPECT_NEAR(single.at(i, 0), lobe, 2e-5);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(out.at(i, k), single.at(i, 0));
        }
    });
}

TEST_P(LightKernels, ConesHoldWhatIsNearTheirAxis) {
    Register v = vectors(3), axis = vectors(0.2f), angle(1, GetParam(), kLit), mask(1, false, kLit);
    angle.fill([this] { return numbers_.below(8) ? numbers_.between(0, 3.1f) : 3.2f; });
    for_each_target([&] {
        cone_mask(kLit, v.operand(), axis.operand(), angle.operand(), mask.operand());
        for (size_t i = 0; i < kLit; ++i) {
            const V3d a = at(axis, i), b = at(v, i);
            const bool nothing = a.length() == 0 || b.length() == 0;
            const double between =
                nothing ? 4 : std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
            const float limit = angle.at(i, 0);
            if (std::fabs(between - limit) < 1e-5) continue;
            EXPECT_EQ(std::bit_cast<uint32_t>(mask.at(i, 0)), limit > 3.15 || between < limit ? ~0u : 0u)
                << i;
        }
    });
}

TEST_P(LightKernels, SurfacesSeeTheWayToTheLight) {
    Register lit(1, false, kLit), sent = before, arriving(3, false, kLit), direction(3, false, kLit);
    lit.fill([this] { return std::bit_cast<float>(numbers_.below(3) ? ~0u : 0u); });
    Register way(3, false, kLit);
    for (size_t i = 0; i < kLit; ++i)
        for (int k = 0; k < 3; ++k) way.set(i, k, i % 32 == 5 ? 0 : numbers_.between(-9, 9));
    for_each_target([&] {
        Register to_light = way;
        receive_light(kLit, lit.operand(), GetParam() ? Cl.operand() : sent.operand(), to_light.operand(),
                      direction.operand(), arriving.operand());
        for (size_t i = 0; i < kLit; ++i) {
            const V3d from = at(way, i);
            const bool shines = std::bit_cast<uint32_t>(lit.at(i, 0)) && from.length() > 0;
            for (int k = 0; k < 3; ++k) {
                EXPECT_EQ(to_light.at(i, k), -way.at(i, k));
                EXPECT_NEAR(direction.at(i, k), from.length() > 0 ? -from[k] / from.length() : 0, 1e-6);
                EXPECT_EQ(arriving.at(i, k), shines ? (GetParam() ? Cl : sent).at(i, k) : 0) << i;
            }
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Uniform, LightKernels, ::testing::Bool());

}  // namespace
}  // namespace trapeze::vm
