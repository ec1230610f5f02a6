#include <gtest/gtest.h>

#include <Imath/ImathMatrix.h>
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
using Inputs = std::vector<std::vector<float>>;
using M44d = Imath::M44d;

M44d matrix(const std::vector<float>& x) {
    M44d m;
    for (int k = 0; k < 16; ++k) m[k / 4][k % 4] = x[static_cast<size_t>(k)];
    return m;
}
V3d triple_of(const std::vector<float>& x) {
    return {x[0], x[1], x[2]};
}
void put(const M44d& m, double* out) {
    for (int k = 0; k < 16; ++k) out[k] = m[k / 4][k % 4];
}

class Matrices : public ::testing::Test {
  protected:
    /// The sixteen numbers of matrices that are far from singular, one after the other.
    std::function<float()> regular() {
        return [this, next = 0]() mutable {
            const int k = next++ % 16;
            return numbers_.between(-0.25f, 0.25f) + (k % 5 == 0 ? 1.5f : 0.0f);
        };
    }
    std::function<float()> number() {
        return [this] { return numbers_.between(-2, 2); };
    }
    void check(Op op, std::vector<int> widths, const LaneFunction& exact,
               std::vector<std::function<float()>> numbers) {
        SCOPED_TRACE(::testing::Message() << "op " << int(op));
        check_kernel({op, std::move(widths), exact, std::move(numbers), 4, 4e-6});
    }
    KernelNumbers numbers_;
};

double largest(const M44d& m) {
    double most = 0;
    for (int k = 0; k < 16; ++k) most = std::max(most, std::fabs(m[k / 4][k % 4]));
    return most;
}

TEST_F(Matrices, Products) {
    check(Op::MatrixMultiply, {16, 16, 16},
          [](const Inputs& in, double* out) { put(matrix(in[0]) * matrix(in[1]), out); }, {number()});
    check(Op::TranslateMatrix, {16, 16, 3},
          [](const Inputs& in, double* out) {
              put(M44d().setTranslation(triple_of(in[1])) * matrix(in[0]), out);
          },
          {number()});
    check(Op::ScaleMatrix, {16, 16, 3},
          [](const Inputs& in, double* out) { put(M44d().setScale(triple_of(in[1])) * matrix(in[0]), out); },
          {number()});
    check(Op::RotateMatrix, {16, 16, 1, 3},
          [](const Inputs& in, double* out) {
              put(M44d().setAxisAngle(triple_of(in[2]).normalized(), double{in[1][0]}) * matrix(in[0]), out);
          },
          {number()});
    check(Op::Determinant, {1, 16}, [](const Inputs& in, double* out) { *out = matrix(in[0]).determinant(); },
          {number()});
}

TEST_F(Matrices, RotateLikeRiRotate) {
    Register out(16, true, kLanes), m(16, true, kLanes), angle(1, true, kLanes), axis(3, true, kLanes);
    for (int k = 0; k < 4; ++k) m.set(0, 5 * k, 1);
    angle.set(0, 0, static_cast<float>(M_PI_2)), axis.set(0, 2, 3);
    const Kernel kernel = find_kernel(Op::RotateMatrix, std::vector{16, 16, 1, 3});
    kernel(kLanes, std::vector{out.operand(), m.operand(), angle.operand(), axis.operand()});
    EXPECT_NEAR(out.at(0, 1), 1, 1e-6) << "x goes to y";
    EXPECT_NEAR(out.at(0, 4), -1, 1e-6);
    axis.set(0, 2, 0);
    kernel(kLanes, std::vector{out.operand(), m.operand(), angle.operand(), axis.operand()});
    for (int k = 0; k < 16; ++k) EXPECT_EQ(out.at(0, k), k % 5 == 0 ? 1 : 0);
}

/// Fills a register with matrices, lane by lane.
void fill_matrices(Register& r, size_t lanes, const std::function<float()>& number) {
    for (size_t i = 0; i < lanes; ++i)
        for (int k = 0; k < 16; ++k) r.set(i, k, number());
}

M44d matrix_at(const Register& r, size_t lane) {
    M44d m;
    for (int k = 0; k < 16; ++k) m[k / 4][k % 4] = r.at(lane, k);
    return m;
}

TEST_F(Matrices, Inverses) {
    constexpr size_t kCount = 256;
    for (bool uniform : {false, true}) {
        Register m(16, uniform, kCount), a(16, false, kCount), inverse(16, false, kCount),
            quotient(16, false, kCount);
        fill_matrices(m, kCount, regular());
        fill_matrices(a, kCount, number());
        for_each_target([&] {
            find_kernel(Op::Invert, std::vector{16, 16})(kCount, std::vector{inverse.operand(), m.operand()});
            find_kernel(Op::MatrixDivide, std::vector{16, 16, 16})(
                kCount, std::vector{quotient.operand(), a.operand(), m.operand()});
            for (size_t i = 0; i < kCount; ++i) {
                const M44d expected = matrix_at(m, i).inverse();
                EXPECT_LT(largest(matrix_at(inverse, i) - expected), 2e-6);
                EXPECT_LT(largest(matrix_at(quotient, i) - matrix_at(a, i) * expected), 1e-5);
            }
        });
    }
}

TEST_F(Matrices, OfRankThreeInvertToTheIdentity) {
    Register m(16, false, 16), out(16, false, 16);
    for (size_t i = 0; i < 16; ++i)
        for (int k = 0; k < 3; ++k) m.set(i, 5 * k, 2);
    for (size_t i = 0; i < 8; ++i) m.set(i, 15, 4);
    find_kernel(Op::Invert, std::vector{16, 16})(16, std::vector{out.operand(), m.operand()});
    for (size_t i = 0; i < 16; ++i)
        for (int k = 0; k < 16; ++k)
            EXPECT_EQ(out.at(i, k), k % 5 ? 0 : i >= 8 ? 1 : k < 15 ? 0.5f : 0.25f) << i << ' ' << k;
}

TEST_F(Matrices, Transform) {
    constexpr size_t kCount = 256;
    for (bool uniform : {false, true}) {
        Register m(16, uniform, kCount), in(3, false, kCount), out(3, false, kCount);
        fill_matrices(m, kCount, regular());
        in.fill(number());
        const auto run = [&](Op op, const std::function<V3d(const M44d&, const V3d&)>& exact) {
            for_each_target([&] {
                find_kernel(op, std::vector{3, 16, 3})(kCount,
                                                       std::vector{out.operand(), m.operand(), in.operand()});
                for (size_t i = 0; i < kCount; ++i) {
                    const V3d expected = exact(matrix_at(m, i), V3d(in.at(i, 0), in.at(i, 1), in.at(i, 2)));
                    for (int k = 0; k < 3; ++k)
                        EXPECT_NEAR(out.at(i, k), expected[k], 2e-5 * std::max(1.0, expected.length()));
                }
            });
        };
        run(Op::TransformPoint, [](const M44d& x, const V3d& p) { return p * x; });
        run(Op::TransformVector, [](const M44d& x, const V3d& v) {
            V3d result;
            x.multDirMatrix(v, result);
            return result;
        });
        run(Op::TransformNormal, [](M44d x, const V3d& n) {
            for (int k = 0; k < 3; ++k) x[k][3] = x[3][k] = 0;
            x[3][3] = 1;
            V3d result;
            x.inverse().transposed().multDirMatrix(n, result);
            return result;
        });
    }
}

TEST_F(Matrices, WithoutWLeavePointsUndivided) {
    Register m(16, true, 16), in(3, false, 16), out(3, false, 16);
    m.set(0, 0, 1), m.set(0, 12, 2);
    in.fill([] { return 3.0f; });
    find_kernel(Op::TransformPoint, std::vector{3, 16, 3})(
        16, std::vector{out.operand(), m.operand(), in.operand()});
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(out.at(i, 0), 5);
}

}  // namespace
}  // namespace trapeze::vm
