#include "shade/vm/kernels/neighbours.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using testing::for_each_target;
using testing::KernelNumbers;
using testing::Register;
using testing::same_float;

/// Several grids side by side, whose lanes are u and v at their vertices.
class SmallBatch {
  public:
    SmallBatch() {
        for (const auto& [nu, nv] : {std::pair{16, 16}, {1, 1}, {5, 3}, {1, 16}, {16, 2}}) {
            GridSpan span;
            span.first = vertices;
            span.shape = {static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
            span.reverse_orientation = spans.size() == 2;
            vertices += static_cast<size_t>(span.shape.vertex_count());
            spans.push_back(span);
        }
        lanes = padded_size(vertices);
    }

    /// A register with value(u, v, k) at each vertex, u and v from 0 to 1 over each grid.
    Register make(int width, const std::function<float(float, float, int)>& value) const {
        Register r(width, false, lanes);
        for_vertices([&](const GridSpan& span, int i, int j, size_t lane) {
            const float u = static_cast<float>(i) / span.shape.nu, v = static_cast<float>(j) / span.shape.nv;
            for (int k = 0; k < width; ++k) r.set(lane, k, value(u, v, k));
        });
        for (size_t lane = vertices; lane < lanes; ++lane)
            for (int k = 0; k < width; ++k) r.set(lane, k, r.at(vertices - 1, k));
        return r;
    }

    template <class Visit>
    void for_vertices(const Visit& visit) const {
        for (const GridSpan& span : spans)
            for (int j = 0; j <= span.shape.nv; ++j)
                for (int i = 0; i <= span.shape.nu; ++i)
                    visit(span, i, j, span.first + static_cast<size_t>(span.shape.row_index(i, j)));
    }

    std::vector<GridSpan> spans;
    size_t vertices = 0, lanes = 0;
};

void expect_last_repeated(const SmallBatch& batch, const Register& r) {
    for (size_t lane = batch.vertices; lane < batch.lanes; ++lane)
        for (int k = 0; k < r.width(); ++k)
            EXPECT_TRUE(same_float(r.at(lane, k), r.at(batch.vertices - 1, k)));
}

/// Over two steps, or one at the border, of any value.
double difference(const std::function<double(int)>& value, int i, int last) {
    const int a = std::max(i - 1, 0), b = std::min(i + 1, last);
    return (value(b) - value(a)) / (b - a);
}

TEST(Neighbours, DerivativesAreDifferencesOverTheParameters) {
    const SmallBatch batch;
    KernelNumbers numbers;
    Register u = batch.make(1, [](float x, float, int) { return x * 0.25f + 3; });
    Register v = batch.make(1, [](float, float y, int) { return 1 - y * 2; });
    for (int width : {1, 3}) {
        Register value = batch.make(width, [&](float, float, int) { return numbers.between(-2, 2); });
        Register du(width, false, batch.lanes), dv(width, false, batch.lanes),
            both(width, false, batch.lanes);
        for_each_target([&] {
            derivative_u(batch.spans, batch.lanes, width, value.operand(), u.operand(), v.operand(),
                         du.operand());
            derivative_v(batch.spans, batch.lanes, width, value.operand(), u.operand(), v.operand(),
                         dv.operand());
            derivative(batch.spans, batch.lanes, width, value.operand(), u.operand(), u.operand(),
                       v.operand(), both.operand());
            batch.for_vertices([&](const GridSpan& span, int i, int j, size_t lane) {
                for (int k = 0; k < width; ++k) {
                    const auto at = [&](int a, int b) {
                        return value.at(span.first + static_cast<size_t>(span.shape.row_index(a, b)), k);
                    };
                    const double along_u = difference([&](int a) { return at(a, j); }, i, span.shape.nu);
                    const double along_v = difference([&](int b) { return at(i, b); }, j, span.shape.nv);
                    EXPECT_NEAR(du.at(lane, k), along_u * span.shape.nu * 4, 2e-3);
                    EXPECT_NEAR(dv.at(lane, k), along_v * span.shape.nv / -2, 1e-4);
                    EXPECT_NEAR(both.at(lane, k), du.at(lane, k), 1e-6) << "u does not change along v";
                }
            });
            expect_last_repeated(batch, du), expect_last_repeated(batch, dv),
                expect_last_repeated(batch, both);
        });
    }
}

/// A border row whose vertices lie at every third one's place, and a border column at every second one's: all
/// derivatives of a linear value are as they are elsewhere.
TEST(Neighbours, DerivativesAtSnappedBordersAreThoseOfTheSurface) {
    const SmallBatch batch;
    Register u(1, false, batch.lanes), v(1, false, batch.lanes), value(1, false, batch.lanes),
        du(1, false, batch.lanes), dv(1, false, batch.lanes);
    batch.for_vertices([&](const GridSpan& span, int i, int j, size_t lane) {
        if (j == 0 && span.shape.nu > 3) i -= i % 3;
        if (i == 0 && span.shape.nv > 2) j -= j % 2;
        const float x = static_cast<float>(i) / span.shape.nu, y = static_cast<float>(j) / span.shape.nv;
        u.set(lane, 0, x), v.set(lane, 0, y), value.set(lane, 0, 5 * x - 3 * y);
    });
    for_each_target([&] {
        derivative_u(batch.spans, batch.lanes, 1, value.operand(), u.operand(), v.operand(), du.operand());
        derivative_v(batch.spans, batch.lanes, 1, value.operand(), u.operand(), v.operand(), dv.operand());
        batch.for_vertices([&](const GridSpan& span, int i, int j, size_t lane) {
            EXPECT_NEAR(du.at(lane, 0), 5, 1e-3) << i << ' ' << j << " of " << int(span.shape.nu);
            EXPECT_NEAR(dv.at(lane, 0), -3, 1e-3) << i << ' ' << j << " of " << int(span.shape.nv);
        });
    });
}

TEST(Neighbours, SpansWithStepsAreDifferentiatedAlongTheirAxes) {
    SmallBatch batch;
    for (GridSpan& span : batch.spans) span.steps = {0.25f, 0.5f};
    Register place = batch.make(1, [](float, float, int) { return 3.0f; });
    Register value = batch.make(2, [](float u, float v, int k) { return k == 0 ? 5 * u : 5 * u - 3 * v; });
    Register du(2, false, batch.lanes), dv(2, false, batch.lanes);
    for_each_target([&] {
        derivative_u(batch.spans, batch.lanes, 2, value.operand(), place.operand(), place.operand(),
                     du.operand());
        derivative_v(batch.spans, batch.lanes, 2, value.operand(), place.operand(), place.operand(),
                     dv.operand());
        batch.for_vertices([&](const GridSpan& span, int, int, size_t lane) {
            EXPECT_NEAR(du.at(lane, 1), 5.0f / span.shape.nu / 0.25f, 1e-4);
            EXPECT_NEAR(dv.at(lane, 1), -3.0f / span.shape.nv / 0.5f, 1e-4);
            EXPECT_EQ(dv.at(lane, 0), 0);
        });
    });
}

TEST(Neighbours, DerivativesAddBothDirections) {
    const SmallBatch batch;
    Register num = batch.make(1, [](float x, float y, int) { return 6 * x + 4 * y; });
    Register den = batch.make(1, [](float x, float y, int) { return 2 * x - y; }), out(1, false, batch.lanes);
    Register u = batch.make(1, [](float x, float, int) { return x; });
    Register v = batch.make(1, [](float, float y, int) { return y; });
    derivative(batch.spans, batch.lanes, 1, num.operand(), den.operand(), u.operand(), v.operand(),
               out.operand());
    for (size_t i = 0; i < batch.lanes; ++i) EXPECT_NEAR(out.at(i, 0), 3 - 4, 1e-4);
}

/// A denominator that goes along one parameter alone but for its last places, on grids with snapped borders.
TEST(Neighbours, DerivativesDoNotDivideByRounding) {
    const SmallBatch batch;
    for (const bool along_u : {true, false}) {
        Register u(1, false, batch.lanes), v(1, false, batch.lanes), num(1, false, batch.lanes),
            den(1, false, batch.lanes), out(1, false, batch.lanes);
        batch.for_vertices([&](const GridSpan& span, int i, int j, size_t lane) {
            if (j == 0 && span.shape.nu > 3) i -= i % 3;
            if (i == 0 && span.shape.nv > 2) j -= j % 2;
            const float x = static_cast<float>(i) / span.shape.nu, y = static_cast<float>(j) / span.shape.nv;
            const float last_places = 1 + static_cast<float>((i * 5 + j * 3) % 4) * 0x1p-23f;
            u.set(lane, 0, x), v.set(lane, 0, y), num.set(lane, 0, 8 * x - 6 * y);
            den.set(lane, 0, (3 + (along_u ? x : y)) * last_places);
        });
        for_each_target([&] {
            derivative(batch.spans, batch.lanes, 1, num.operand(), den.operand(), u.operand(), v.operand(),
                       out.operand());
            batch.for_vertices([&](const GridSpan& span, int i, int j, size_t lane) {
                EXPECT_NEAR(out.at(lane, 0), along_u ? 8 : -6, 1e-3)
                    << i << ' ' << j << " of " << int(span.shape.nu);
            });
        });
    }
}

TEST(Neighbours, UniformValuesDoNotChange) {
    const SmallBatch batch;
    Register value(3, true, kLanes), u = batch.make(1, [](float x, float, int) { return x; });
    Register still = batch.make(1, [](float, float, int) { return 2.0f; }), out(3, false, batch.lanes);
    value.fill([] { return 5.0f; });
    derivative_u(batch.spans, batch.lanes, 3, value.operand(), u.operand(), still.operand(), out.operand());
    for (float x : out.planes()) EXPECT_EQ(x, 0);
    derivative_u(batch.spans, batch.lanes, 1, u.operand(), still.operand(), still.operand(), out.operand());
    for (size_t i = 0; i < batch.lanes; ++i) EXPECT_EQ(out.at(i, 0), 0) << "over a difference of 0";
}

TEST(Neighbours, AreasAreThoseOfMicropolygons) {
    const SmallBatch batch;
    Register P = batch.make(3, [](float x, float y, int k) {
        return k == 0 ? 4 * x + 100 : k == 1 ? 3 * y : 0;
    });
    Register out(1, false, batch.lanes);
    for_each_target([&] {
        areas(batch.spans, batch.lanes, P.operand(), out.operand());
        batch.for_vertices([&](const GridSpan& span, int, int, size_t lane) {
            EXPECT_NEAR(out.at(lane, 0) * span.shape.nu * span.shape.nv, 12, 1e-3);
        });
        expect_last_repeated(batch, out);
    });
}

TEST(Neighbours, NormalsOfASphereWithPoles) {
    const SmallBatch batch;
    const auto sphere = [](float x, float y, int k) {
        const double a = x * 2.0, b = y * M_PI_2;
        // The last row is one point.
        const double radius = y == 1 ? 0 : std::cos(b);
        return static_cast<float>(k == 0   ? radius * std::cos(a)
                                  : k == 1 ? radius * std::sin(a)
                                           : std::sin(b));
    };
    Register P = batch.make(3, sphere), N(3, false, batch.lanes);
    for_each_target([&] {
        calculate_normals(batch.spans, batch.lanes, P.operand(), N.operand());
        batch.for_vertices([&](const GridSpan& span, int, int, size_t lane) {
            const V3f n(N.at(lane, 0), N.at(lane, 1), N.at(lane, 2));
            EXPECT_NEAR(n.length(), 1, 1e-6);
            if (span.shape.nu < 16 || span.shape.nv < 16) return;
            const V3f p(P.at(lane, 0), P.at(lane, 1), P.at(lane, 2));
            EXPECT_GT(n.dot(p), 0.98f) << p;
        });
        expect_last_repeated(batch, N);
        // The third grid's orientation is reversed.
        EXPECT_GT(N.at(batch.spans[1].first, 0), 0);
        EXPECT_LT(N.at(batch.spans[2].first, 0), 0);
    });
}

TEST(Neighbours, PointsInOnePlaceHaveNoNormal) {
    const SmallBatch batch;
    Register P = batch.make(3, [](float, float, int) { return 7.0f; }), N(3, false, batch.lanes);
    N.fill([] { return 9.0f; });
    calculate_normals(batch.spans, batch.lanes, P.operand(), N.operand());
    for (float x : N.planes()) EXPECT_EQ(x, 0);
}

TEST(Neighbours, BorderSnappedToOneCornerTakesNormalsFromInside) {
    const SmallBatch batch;
    // The first column's vertices lie on two points.
    Register P = batch.make(3, [](float x, float y, int k) {
        return k == 0 ? x : k == 1 ? (x == 0 ? (y < 0.7f ? 0.0f : 1.0f) : y) : 0.0f;
    });
    Register N(3, false, batch.lanes);
    calculate_normals(batch.spans, batch.lanes, P.operand(), N.operand());
    batch.for_vertices([&](const GridSpan& span, int, int, size_t lane) {
        if (span.shape.nu == 1) return;
        EXPECT_EQ(N.at(lane, 2), span.reverse_orientation ? -1 : 1) << lane;
    });
}

TEST(Neighbours, FilteredStepsAreSharesOfIntervals) {
    const SmallBatch batch;
    Register x = batch.make(1, [](float u, float v, int) { return u - 2 * v; }), width(1, false, batch.lanes);
    Register edge(1, true, kLanes), out(1, false, batch.lanes), x2(1, false, batch.lanes);
    edge.set(0, 0, 0.1f);
    for_each_target([&] {
        filter_widths(batch.spans, batch.lanes, x.operand(), width.operand());
        filter_step(batch.lanes, edge.operand(), x.operand(), width.operand(), 2, out.operand());
        batch.for_vertices([&](const GridSpan& span, int, int, size_t lane) {
            const double wide = 1.0 / span.shape.nu + 2.0 / span.shape.nv;
            EXPECT_NEAR(width.at(lane, 0), wide, 1e-5);
            const double share = (x.at(lane, 0) - 0.1) / (2 * wide) + 0.5;
            EXPECT_NEAR(out.at(lane, 0), std::clamp(share, 0.0, 1.0), 1e-5);
        });
        x2.fill([] { return 0.5f; });
        filter_step_between(batch.lanes, edge.operand(), x.operand(), x2.operand(), out.operand());
        for (size_t lane = 0; lane < batch.lanes; ++lane) {
            const double a = std::min(x.at(lane, 0), 0.5f), b = std::max(x.at(lane, 0), 0.5f);
            const double share = a == b ? 1 : std::clamp((b - 0.1) / (b - a), 0.0, 1.0);
            EXPECT_NEAR(out.at(lane, 0), share, 1e-5) << a << ' ' << b;
        }
        width.fill([] { return 0.0f; });
        filter_step(batch.lanes, edge.operand(), x.operand(), width.operand(), 1, out.operand());
        for (size_t lane = 0; lane < batch.lanes; ++lane)
            EXPECT_EQ(out.at(lane, 0), x.at(lane, 0) < 0.1f ? 0 : 1);
    });
}

TEST(Neighbours, GiveTheSameBitsOnAllTargets) {
    const SmallBatch batch;
    KernelNumbers numbers;
    Register P = batch.make(3, [&](float, float, int) { return numbers.moderate(); });
    Register u = batch.make(1, [&](float, float, int) { return numbers.moderate(); });
    Register v = batch.make(1, [&](float, float, int) { return numbers.moderate(); });
    const auto run = [&] {
        std::vector<Register> out(5, Register(3, false, batch.lanes));
        derivative_u(batch.spans, batch.lanes, 3, P.operand(), u.operand(), v.operand(), out[0].operand());
        derivative(batch.spans, batch.lanes, 3, P.operand(), u.operand(), u.operand(), v.operand(),
                   out[1].operand());
        areas(batch.spans, batch.lanes, P.operand(), out[2].operand());
        calculate_normals(batch.spans, batch.lanes, P.operand(), out[3].operand());
        filter_widths(batch.spans, batch.lanes, u.operand(), out[4].operand());
        return out;
    };
    const std::vector<Register> first = run();
    for_each_target([&] {
        const std::vector<Register> again = run();
        for (size_t r = 0; r < first.size(); ++r)
            for (size_t i = 0; i < first[r].planes().size(); ++i) {
                ASSERT_TRUE(same_float(first[r].planes()[i], again[r].planes()[i])) << r << ' ' << i;
                ASSERT_TRUE(std::isfinite(first[r].planes()[i])) << r << ' ' << i;
            }
    });
}

}  // namespace
}  // namespace trapeze::vm
