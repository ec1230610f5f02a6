#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using testing::check_kernel;
using testing::for_each_target;
using testing::KernelNumbers;
using testing::LaneFunction;
using testing::Register;

V3d triple(const std::vector<float>& x) {
    return {x[0], x[1], x[2]};
}

void put(const V3d& v, double* out) {
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
}

TEST(Geometry, Products) {
    KernelNumbers numbers;
    const auto near_one = [&] { return numbers.below(9) ? numbers.between(-2, 2) : 0.0f; };
    const auto check = [&](Op op, std::vector<int> widths, const LaneFunction& exact) {
        SCOPED_TRACE(::testing::Message() << "op " << int(op));
        check_kernel({op, std::move(widths), exact, {near_one}, 4, 2e-6});
    };
    check(Op::Dot, {1, 3, 3}, [](const auto& in, double* out) { *out = triple(in[0]).dot(triple(in[1])); });
    check(Op::Cross, {3, 3, 3},
          [](const auto& in, double* out) { put(triple(in[0]).cross(triple(in[1])), out); });
    check(Op::Length, {1, 3}, [](const auto& in, double* out) { *out = triple(in[0]).length(); });
    check(Op::Distance, {1, 3, 3},
          [](const auto& in, double* out) { *out = (triple(in[0]) - triple(in[1])).length(); });
    check(Op::Normalize, {3, 3}, [](const auto& in, double* out) { put(triple(in[0]).normalized(), out); });
    check(Op::FaceForward, {3, 3, 3, 3}, [](const auto& in, double* out) {
        const bool behind = triple(in[1]).dot(triple(in[2])) > 0;
        put(triple(in[0]) * (behind ? -1.0 : 1.0), out);
    });
}

/// Pairs of unit vectors and a ratio of indices, by lane.
struct Facing {
    explicit Facing(bool uniform) : I(3, uniform, 256), N(3, uniform, 256), eta(1, uniform, 256) {
        KernelNumbers numbers;
        for (size_t i = 0; i < 256; ++i) {
            for (Register* r : {&I, &N}) {
                const V3f v(numbers.between(-1, 1), numbers.between(-1, 1), numbers.between(-1, 1));
                for (int k = 0; k < 3; ++k) r->set(i, k, v.normalized()[k]);
            }
            eta.set(i, 0, numbers.between(0.4f, 2.5f));
        }
        for (int k = 0; k < 3; ++k) I.set(0, k, -N.at(0, k));  // along the normal
    }
    V3d vector(const Register& r, size_t i) const { return {r.at(i, 0), r.at(i, 1), r.at(i, 2)}; }

    Register I, N, eta;
};

TEST(Geometry, LightIsReflectedAndRefracted) {
    for (bool uniform : {false, true}) {
        Facing f(uniform);
        Register Kr(1, false, 256), Kt(1, false, 256), R(3, false, 256), T(3, false, 256);
        for_each_target([&] {
            find_kernel(Op::Fresnel, std::vector{1, 1, 3, 3, 3, 3, 1})(
                256, std::vector{Kr.operand(), Kt.operand(), R.operand(), T.operand(), f.I.operand(),
                                 f.N.operand(), f.eta.operand()});
            for (size_t i = 0; i < 256; ++i) {
                const V3d I = f.vector(f.I, i), N = f.vector(f.N, i), t = f.vector(T, i);
                const double eta = f.eta.at(i, 0), c = std::fabs(I.dot(N));
                EXPECT_LT((f.vector(R, i) - (I - N * (2 * I.dot(N)))).length(), 1e-6);
                EXPECT_NEAR(Kr.at(i, 0) + Kt.at(i, 0), 1, 1e-7);
                const double sine = eta * std::sqrt(1 - c * c);
                if (std::fabs(sine - 1) < 1e-4) continue;
                if (sine > 1) {
                    EXPECT_EQ(t, V3d(0));
                    EXPECT_EQ(Kr.at(i, 0), 1);
                    continue;
                }
                // Snell's law: the part across the normal shrinks by eta; the result is on N's far side.
                const double g = std::sqrt(1 - sine * sine);
                EXPECT_LT((t - ((I - N * I.dot(N)) * eta - N * g)).length(), 1e-4);
                // By the angles: tangents and sines of their sums and differences.
                const double a = std::acos(c), b = std::asin(sine);
                const double expected = a < 1e-3 ? std::pow((1 - eta) / (1 + eta), 2)
                                                 : (std::pow(std::sin(a - b) / std::sin(a + b), 2) +
                                                    std::pow(std::tan(a - b) / std::tan(a + b), 2)) /
                                                       2;
                EXPECT_NEAR(Kr.at(i, 0), expected, 1e-4) << c << ' ' << eta;
            }
        });
    }
}

TEST(Geometry, ReflectsAndRefractsByThemselvesAsInFresnel) {
    Facing f(false);
    Register Kr(1, false, 256), Kt(1, false, 256), R(3, false, 256), T(3, false, 256);
    Register R2(3, false, 256), T2(3, false, 256), Kr2(1, false, 256);
    find_kernel(Op::Fresnel, std::vector{1, 1, 3, 3, 3, 3, 1})(
        256, std::vector{Kr.operand(), Kt.operand(), R.operand(), T.operand(), f.I.operand(), f.N.operand(),
                         f.eta.operand()});
    find_kernel(Op::Fresnel, std::vector{1, 1, 3, 3, 1})(
        256, std::vector{Kr2.operand(), Kt.operand(), f.I.operand(), f.N.operand(), f.eta.operand()});
    find_kernel(Op::Reflect, std::vector{3, 3, 3})(256,
                                                   std::vector{R2.operand(), f.I.operand(), f.N.operand()});
    find_kernel(Op::Refract, std::vector{3, 3, 3, 1})(
        256, std::vector{T2.operand(), f.I.operand(), f.N.operand(), f.eta.operand()});
    for (size_t i = 0; i < 256; ++i) {
        EXPECT_EQ(Kr.at(i, 0), Kr2.at(i, 0));
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(R.at(i, k), R2.at(i, k));
            EXPECT_EQ(T.at(i, k), T2.at(i, k));
        }
    }
}

TEST(Geometry, TurnsAboutLinesAndMeasuresFromThem) {
    KernelNumbers numbers;
    const auto number = [&] { return numbers.between(-2, 2); };
    check_kernel({Op::Rotate,
                  {3, 3, 1, 3, 3},
                  [](const auto& in, double* out) {
                      const V3d a = triple(in[2]), axis = (triple(in[3]) - a).normalized(),
                                q = triple(in[0]) - a;
                      const V3d along = axis * axis.dot(q), across = q - along;
                      const double angle = in[1][0];
                      put(a + along + across * std::cos(angle) + axis.cross(across) * std::sin(angle), out);
                  },
                  {number},
                  4,
                  1e-5});
    check_kernel({Op::LineDistance,
                  {1, 3, 3, 3},
                  [](const auto& in, double* out) {
                      const V3d a = triple(in[0]), b = triple(in[1]), q = triple(in[2]);
                      const double t = (q - a).dot(b - a) / (b - a).length2();
                      *out = t < 0   ? (q - a).length()
                             : t > 1 ? (q - b).length()
                                     : (q - a).cross((b - a).normalized()).length();
                  },
                  {number},
                  4,
                  1e-5});
    Register out(3, true, 16), p(3, true, 16), angle(1, true, 16), a(3, true, 16), distance(1, true, 16);
    p.set(0, 1, 5), angle.set(0, 0, 1);
    find_kernel(Op::Rotate, std::vector{3, 3, 1, 3, 3})(
        16, std::vector{out.operand(), p.operand(), angle.operand(), a.operand(), a.operand()});
    EXPECT_EQ(out.at(0, 1), 5) << "a line without direction";
    find_kernel(Op::LineDistance, std::vector{1, 3, 3, 3})(
        16, std::vector{distance.operand(), a.operand(), a.operand(), p.operand()});
    EXPECT_EQ(distance.at(0, 0), 5);
}

TEST(Geometry, NothingHasNoDirection) {
    Register out(3, false, 16), in(3, false, 16);
    in.set(3, 1, 1e-30f);
    find_kernel(Op::Normalize, std::vector{3, 3})(16, std::vector{out.operand(), in.operand()});
    for (size_t i = 0; i < 16; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(out.at(i, k), 0) << i;
}

}  // namespace
}  // namespace trapeze::vm
