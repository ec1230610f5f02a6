/// Trim loops: what is kept of cells has the right area for loops of every shape, pieces share their borders,
/// and the border of a diced patch is the loop.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/leak_harness.h"
#include "tessellate/surfaces/nurbs/trim_cells.h"
#include "tessellate/surfaces/nurbs/trimmed_patch.h"

namespace trapeze {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
using Loop = std::vector<V2d>;

/// A regular polygon about a centre.
Loop ring(const V2d& centre, double radius, int points) {
    Loop loop;
    for (int i = 0; i < points; ++i) {
        const double a = 2 * kHalfTurn * i / points;
        loop.push_back(centre + V2d(std::cos(a), std::sin(a)) * radius);
    }
    return loop;
}

/// The area of all faces; negative for faces that run the wrong way.
double area(const TrimmedCells& cells) {
    double sum = 0;
    size_t first = 0;
    for (const int n : cells.vertices_per_face) {
        for (int k = 0; k < n; ++k) {
            const V2d& a = cells.points[cells.vertices[first + k]];
            const V2d& b = cells.points[cells.vertices[first + (k + 1) % n]];
            sum += (a.x * b.y - a.y * b.x) / 2;
        }
        first += n;
    }
    return sum;
}

double area(const Loop& loop) {
    double sum = 0;
    for (size_t k = 0; k < loop.size(); ++k) sum += loop[k].cross(loop[(k + 1) % loop.size()]) / 2;
    return std::abs(sum);
}

TEST(TrimCells, KeepWhatAnOddNumberOfLoopsHolds) {
    const Loop big = ring(V2d(4.1, 3.9), 3.3, 77), small = ring(V2d(3.7, 4.2), 1.2, 31);
    const Loop tiny = ring(V2d(4.5, 4.5), 0.2, 9), outside = ring(V2d(20, 20), 3, 20);
    const Loop whole{{0, 0}, {8, 0}, {8, 8}, {0, 8}}, on_lines{{2, 2}, {6, 2}, {6, 5}, {2, 5}};
    const struct {
        std::vector<Loop> loops;
        double area;
    } rows[] = {{{big}, area(big)},
                {{big, small}, area(big) - area(small)},
                {{big, small, tiny}, area(big) - area(small) + area(tiny)},
                {{small, outside}, area(small)},
                {{tiny}, area(tiny)},
                {{whole}, 64},
                {{whole, big, small}, 64 - area(big) + area(small)},
                {{whole, tiny}, 64 - area(tiny)},
                {{on_lines}, 12}};
    for (const auto& row : rows)
        for (const bool backwards : {false, true}) {
            std::vector<Loop> loops = row.loops;
            if (backwards)
                for (Loop& loop : loops) std::reverse(loop.begin(), loop.end());
            EXPECT_NEAR(area(trim_cells(loops, 8, 8, false)), row.area, 1e-3);
            EXPECT_NEAR(area(trim_cells(loops, 8, 8, true)), 64 - row.area, 1e-3);
        }
}

TEST(TrimCells, LoopsOfEveryShapeKeepTheirArea) {
    for (uint32_t seed = 0; seed < 60; ++seed) {
        // A star with random spikes, which do not cross.
        Loop loop;
        const int n = 5 + static_cast<int>(hash(seed, 1) % 60);
        for (int i = 0; i < n; ++i) {
            const double a = 2 * kHalfTurn * i / n,
                         r = 0.5 + 6 * static_cast<double>(unit_float(hash(seed, i, 2)));
            loop.push_back(V2d(7.5, 7.5) + V2d(std::cos(a), std::sin(a)) * r);
        }
        const TrimmedCells cells = trim_cells({loop}, 15, 15, false);
        EXPECT_NEAR(area(cells), area(loop), 2e-3) << seed;
        EXPECT_NEAR(area(trim_cells({loop}, 15, 15, true)), 225 - area(loop), 2e-3) << seed;
    }
}

TEST(TrimCells, LoopsThatCrossThemselvesAreSurvived) {
    for (uint32_t seed = 0; seed < 100; ++seed) {
        Loop loop;
        for (uint32_t i = 0; i < 3 + seed; ++i)
            loop.push_back(V2d(14 * static_cast<double>(unit_float(hash(seed, i, 1))) - 3,
                               14 * static_cast<double>(unit_float(hash(seed, i, 2))) - 3));
        const TrimmedCells cells = trim_cells({loop, loop}, 8, 8, seed % 2 == 0);
        size_t first = 0;
        for (size_t face = 0; face < cells.cells.size(); ++face)
            for (int k = 0; k < cells.vertices_per_face[face]; ++k) {
                const V2d& p = cells.points[cells.vertices[first++]];
                EXPECT_NEAR(p.x, cells.cells[face].i + 0.5, 0.5 + 1e-9);
                EXPECT_NEAR(p.y, cells.cells[face].j + 0.5, 0.5 + 1e-9);
            }
        ASSERT_EQ(first, cells.vertices.size());
    }
}

NuPatch plane_patch() {
    NuPatch patch;
    patch.u_knots = {0, 0, 2, 2}, patch.v_knots = {0, 0, 3, 3};
    patch.u_end = 2, patch.v_end = 3;
    return patch;
}

/// A circle of four rational quarters in the patch's parameters.
std::vector<TrimCurve> circle(float u, float v, float r) {
    TrimCurve curve;
    curve.order = 3;
    curve.knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    curve.end = 4;
    const float d = std::sqrt(0.5f);
    const float x[9] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[9] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    for (int i = 0; i < 9; ++i) {
        const float w = i % 2 ? d : 1.0f;
        curve.points.push_back(V3f(u + r * x[i], v + r * y[i], 1) * w);
    }
    return {curve};
}

TEST(TrimmedPatch, LoopsAreFlattenedFinely) {
    NuPatch patch = plane_patch();
    patch.trim_loops = {circle(1, 1.5f, 0.6f)};
    const auto loops = flattened_loops(patch);
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_GT(loops[0].size(), 40u);
    EXPECT_LT(loops[0].size(), 2000u);
    for (const V2d& p : loops[0]) EXPECT_NEAR(V2d(2 * p.x - 1, 3 * p.y - 1.5).length(), 0.6, 1e-6);
    EXPECT_NEAR(area(loops[0]) * 6, kHalfTurn * 0.36, 1e-3);
}

std::shared_ptr<const Shape> trimmed_plane(bool outside) {
    NuPatch patch = plane_patch();
    patch.trim_loops = {circle(1, 1.5f, 0.6f)};
    patch.trim_outside = outside;
    ParameterList list;
    list.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                {-1, -1.5f, 0, 1, -1.5f, 0, -1, 1.5f, 0, 1, 1.5f, 0}));
    return testing::shape_of(patch, std::move(list));
}

/// The plane's u and v are x + 1 and y + 1.5: the border is a circle about the origin.
TEST(TrimmedPatch, TheBorderIsTheLoop) {
    for (const bool outside : {false, true}) {
        testing::TestScene scene;
        scene.keep_all().add(trimmed_plane(outside));
        const testing::DicedScene diced(scene);
        double sum = 0;
        for (const Grid& grid : diced.grids)
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u) {
                    V3f p[4];
                    for (int i = 0; i < 4; ++i) {
                        p[i] = grid.vertex_at_key(u + (i & 1), v + (i >> 1), 0, 1);
                        const float r = std::hypot(p[i].x, p[i].y);
                        if (outside)
                            EXPECT_GE(r, 0.6f - 2e-4f);
                        else
                            EXPECT_LE(r, 0.6f + 1e-5f);
                    }
                    sum += 0.5 * static_cast<double>((p[3] - p[0]).cross(p[2] - p[1]).z);
                }
        EXPECT_NEAR(std::abs(sum), outside ? 6 - kHalfTurn * 0.36 : kHalfTurn * 0.36, 2e-3);
    }
}

/// Sides of micropolygons that have no neighbour are on the circle or on the patch's rim.
TEST(TrimmedPatch, PiecesJoinWithoutGaps) {
    testing::TestScene scene;
    scene.keep_all().add(trimmed_plane(true));
    const testing::DicedScene diced(scene);
    std::map<std::array<float, 4>, int> sides;
    for (const Grid& grid : diced.grids) {
        const auto add = [&](int i, int j, int i2, int j2) {
            V3f a = grid.vertex_at_key(i, j, 0, 1), b = grid.vertex_at_key(i2, j2, 0, 1);
            if (a == b) return;
            if (a.x > b.x || (a.x == b.x && a.y > b.y)) std::swap(a, b);
            ++sides[{a.x, a.y, b.x, b.y}];
        };
        const int nu = grid.shape.nu, nv = grid.shape.nv;
        for (int i = 0; i < nu; ++i) add(i, 0, i + 1, 0), add(i, nv, i + 1, nv);
        for (int j = 0; j < nv; ++j) add(0, j, 0, j + 1), add(nu, j, nu, j + 1);
    }
    int open = 0;
    for (const auto& [side, count] : sides) {
        if (count % 2 == 0) continue;
        ++open;
        const float x = (side[0] + side[2]) / 2, y = (side[1] + side[3]) / 2;
        const float to_rim = std::min(1 - std::abs(x), 1.5f - std::abs(y));
        EXPECT_LT(std::min(std::abs(std::hypot(x, y) - 0.6f), to_rim), 1e-3f) << x << " " << y;
    }
    EXPECT_GT(open, 50);
}

}  // namespace
}  // namespace trapeze
