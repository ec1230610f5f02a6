#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "shade/vm/kernel_harness.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

V3d triple(const std::vector<float>& x) {
    return {x[0], x[1], x[2]};
}

void put(const V3d& v, double* out) {
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
}

TEST(Geometry, Products) {
    Numbers numbers;
    const auto near_one = [&] { return numbers.below(9) ? numbers.between(-2, 2) : 0.0f; };
    const auto check = [&](Op op, std::vector<int> widths, const LaneFunction& exact) {
        SCOPED_TRACE(testing::Message() << "op " << int(op));
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

TEST(Geometry, NothingHasNoDirection) {
    Register out(3, false, 16), in(3, false, 16);
    in.set(3, 1, 1e-30f);
    find_kernel(Op::Normalize, std::vector{3, 3})(16, std::vector{out.operand(), in.operand()});
    for (size_t i = 0; i < 16; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(out.at(i, k), 0) << i;
}

}  // namespace
}  // namespace trapeze::vm
