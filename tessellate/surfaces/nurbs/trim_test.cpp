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

/// How many loops are left on the way from a point to the left.
int loops_around(const V2d& p, const std::vector<Loop>& loops) {
    int count = 0;
    for (const Loop& loop : loops)
        for (size_t k = 0; k < loop.size(); ++k) {
            const V2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
            count += (a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) < p.x;
        }
    return count;
}

/// How many faces hold a point.
int faces_at(const V2d& p, const TrimmedCells& cells) {
    int count = 0;
    size_t first = 0;
    for (const int n : cells.vertices_per_face) {
        bool inside = true;
        for (int k = 0; k < n; ++k) {
            const V2d &a = cells.points[cells.vertices[first + k]],
                      &b = cells.points[cells.vertices[first + (k + 1) % n]];
            inside = inside && (b - a).cross(p - a) >= 0;
        }
        count += inside;
        first += n;
    }
    return count;
}

double distance(const V2d& p, const V2d& a, const V2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / std::max((b - a).length2(), 1e-30), 0.0, 1.0);
    return (a + (b - a) * t - p).length();
}

/// Each of many points is held by one face or none, as the loops say; but for points on them.
void expect_even_odd(const std::vector<Loop>& loops, int n, const std::string& what) {
    for (const bool outside : {false, true}) {
        const TrimmedCells cells = trim_cells(loops, n, n, outside);
        int wrong = 0, looked_at = 0;
        for (uint32_t s = 0; s < 400; ++s) {
            const V2d p(n * static_cast<double>(unit_float(hash(s, 1))),
                        n * static_cast<double>(unit_float(hash(s, 2))));
            bool on_loop = false;
            for (const Loop& loop : loops)
                for (size_t k = 0; k < loop.size(); ++k)
                    on_loop = on_loop || distance(p, loop[k], loop[(k + 1) % loop.size()]) < 2e-3;
            if (on_loop) continue;
            ++looked_at;
            wrong += faces_at(p, cells) != ((loops_around(p, loops) % 2 == 1) != outside);
        }
        EXPECT_GT(looked_at, 100) << what;
        EXPECT_EQ(wrong, 0) << what << (outside ? ", outside" : ", inside") << " of " << looked_at;
    }
}

TEST(TrimCells, LoopsMayCrossThemselvesAndEachOther) {
    for (uint32_t seed = 0; seed < 40; ++seed) {
        std::vector<Loop> loops(1 + seed % 3);
        // Also all within a cell, and of few points, on lines and corners of cells.
        const double side = seed % 4 == 0 ? 1 : 8;
        for (uint32_t l = 0; l < loops.size(); ++l)
            for (uint32_t i = 0; i < 3 + seed % 9; ++i) {
                const auto at = [&](uint32_t axis) {
                    const double x = static_cast<double>(unit_float(hash(seed, l, i, axis)));
                    return seed % 5 == 0 ? std::round(x * 8) / 8 * side : side * x;
                };
                loops[l].push_back(V2d(at(0), at(1)));
            }
        expect_even_odd(loops, side == 1 ? 1 : 8, "seed " + std::to_string(seed));
    }
}

TEST(TrimCells, LoopsMayLieWithinEachOtherInACell) {
    std::vector<Loop> rings;
    for (int k = 0; k < 7; ++k) rings.push_back(ring(V2d(0.5, 0.5), 0.45 - 0.06 * k, 8 + k));
    for (size_t k = 1; k <= rings.size(); ++k)
        expect_even_odd({rings.begin(), rings.begin() + static_cast<std::ptrdiff_t>(k)}, 1,
                        std::to_string(k) + " rings");
    // Beside each other, each with a hole.
    expect_even_odd({ring(V2d(0.25, 0.5), 0.2, 9), ring(V2d(0.25, 0.5), 0.1, 7), ring(V2d(0.75, 0.5), 0.2, 9),
                     ring(V2d(0.75, 0.5), 0.1, 5)},
                    1, "two rings");
}

TEST(TrimCells, LoopsMayGoThroughCornersOfCells) {
    const std::vector<Loop> loops[] = {
        {{{4, 2}, {6, 4}, {4, 6}, {2, 4}}},
        {{{2, 2}, {6, 2}, {6, 6}}},
        {{{0, 0}, {8, 0}, {8, 8}}},
        {{{0, 0}, {8, 0}, {8, 8}, {0, 8}}, {{2.4, 2.4}, {4.8, 2.4}, {4.8, 4.8}}},
        {{{0.8, 0.8}, {7.2, 7.2}, {7.2, 0.8}, {0.8, 7.2}}},
        {{{0.5, 0.5}, {6.5, 6.5}, {0.5, 6.5}}},
        {{{1, 1}, {2, 2}, {3, 3}, {4, 4}, {7, 1}, {4, 4}, {3, 7}}}};
    for (size_t k = 0; k < std::size(loops); ++k) expect_even_odd(loops[k], 8, "loops " + std::to_string(k));
}

/// More crossings than are cut are survived in a time that does not grow without end.
TEST(TrimCells, ScribblesAreSurvived) {
    Loop loop;
    for (uint32_t i = 0; i < 4000; ++i)
        loop.push_back(V2d(8 * static_cast<double>(unit_float(hash(i, 1))),
                           8 * static_cast<double>(unit_float(hash(i, 2)))));
    const TrimmedCells cells = trim_cells({loop}, 8, 8, false);
    EXPECT_GT(area(cells), 0);
    EXPECT_LE(area(cells), 64 + 1e-3);
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

/// The area of all micropolygons of a plane, whose corners are handed on.
template <class Visit>
double area_of(const testing::DicedScene& diced, const Visit& visit) {
    double sum = 0;
    for (const Grid& grid : diced.grids)
        for (int v = 0; v < grid.shape.nv; ++v)
            for (int u = 0; u < grid.shape.nu; ++u) {
                V3f p[4];
                for (int i = 0; i < 4; ++i) {
                    p[i] = grid.vertex_at_key(u + (i & 1), v + (i >> 1), 0, 1);
                    visit(p[i]);
                }
                sum += 0.5 * static_cast<double>((p[3] - p[0]).cross(p[2] - p[1]).z);
            }
    return std::abs(sum);
}

/// The plane's u and v are x + 1 and y + 1.5: the border is a circle about the origin.
TEST(TrimmedPatch, TheBorderIsTheLoop) {
    for (const bool outside : {false, true}) {
        testing::TestScene scene;
        scene.keep_all().add(trimmed_plane(outside));
        const testing::DicedScene diced(scene);
        const double area = area_of(diced, [&](const V3f& corner) {
            const float r = std::hypot(corner.x, corner.y);
            if (outside)
                EXPECT_GE(r, 0.6f - 2e-4f);
            else
                EXPECT_LE(r, 0.6f + 1e-5f);
        });
        EXPECT_NEAR(area, outside ? 6 - kHalfTurn * 0.36 : kHalfTurn * 0.36, 2e-3);
    }
}

/// However long the spans between knots are, and wherever they end: a triangle of straight lines. The plane
/// is x = u / 10, y = v.
TEST(TrimmedPatch, StraightLinesStayStraightAcrossSpans) {
    for (const std::vector<float>& knots :
         {std::vector<float>{0, 0, 10, 10}, {0, 0, 1, 10, 10}, {0, 0, .5f, 2, 9, 10, 10}}) {
        NuPatch patch;
        patch.u_order = patch.v_order = 2;
        patch.u_knots = knots, patch.v_knots = {0, 0, 1, 1};
        patch.u_end = 10, patch.v_end = 1;
        TrimCurve line;
        line.order = 2;
        line.knots = {0, 0, 1, 2, 2}, line.end = 2;
        line.points = {{.5f, .1f, 1}, {9.5f, .1f, 1}, {9.5f, .9f, 1}};
        patch.trim_loops = {{line}};
        std::vector<float> P;
        const size_t columns = knots.size() - 2;
        patch.nu = static_cast<int>(columns), patch.nv = 2;
        for (int j = 0; j < 2; ++j)
            for (size_t i = 0; i < columns; ++i)
                P.insert(P.end(), {knots[i + 1] / 10, static_cast<float>(j), 0});
        ParameterList list;
        list.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
        testing::TestScene scene;
        scene.keep_all().add(testing::shape_of(patch, std::move(list)));
        const testing::DicedScene diced(scene);
        const double area = area_of(diced, [](const V3f& corner) {
            EXPECT_LE(corner.y, .1f + .8f * (corner.x - .05f) / .9f + 1e-4f);
        });
        EXPECT_NEAR(area, .36, 1e-4) << knots.size();
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
