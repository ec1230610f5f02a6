/// Triangles of polygons with holes: they cover the polygon, once, with all of its points, and anything at
/// all ends.
#include "tessellate/topology/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace trapeze {
namespace {

/// A polygon with holes: loops one after the other, the outline first.
struct Loops {
    std::vector<V2d> points;
    std::vector<int> sizes;

    void add(std::vector<V2d> loop) {
        sizes.push_back(static_cast<int>(loop.size()));
        points.insert(points.end(), loop.begin(), loop.end());
    }
};

double cross(const V2d& a, const V2d& b, const V2d& c) {
    return (b - a).cross(c - a);
}

double signed_area(std::span<const V2d> loop) {
    double sum = 0;
    for (size_t i = 0; i < loop.size(); ++i) sum += loop[i].cross(loop[(i + 1) % loop.size()]);
    return sum / 2;
}

/// The outline's area less that of the holes.
double area_of(const Loops& loops) {
    double sum = 0;
    size_t first = 0;
    for (size_t i = 0; i < loops.sizes.size(); ++i) {
        const double a = std::abs(signed_area(std::span(loops.points).subspan(first, loops.sizes[i])));
        sum += i == 0 ? a : -a;
        first += loops.sizes[i];
    }
    return sum;
}

/// Sides belong to one triangle, diagonals to two that run along them either way.
void expect_closed(const Loops& loops, const std::vector<std::array<int, 3>>& triangles) {
    std::map<std::pair<int, int>, int> uses;
    for (const auto& t : triangles)
        for (int i = 0; i < 3; ++i) {
            ++uses[{t[i], t[(i + 1) % 3]}];
            --uses[{t[(i + 1) % 3], t[i]}];
        }
    size_t first = 0;
    const bool turned = signed_area(std::span(loops.points).first(loops.sizes[0])) < 0;
    for (size_t l = 0; l < loops.sizes.size(); ++l) {
        const auto loop = std::span(loops.points).subspan(first, loops.sizes[l]);
        // Holes run against the outline.
        const bool against = l > 0 && (signed_area(loop) < 0) == turned;
        for (int i = 0; i < loops.sizes[l]; ++i) {
            int a = static_cast<int>(first) + i, b = static_cast<int>(first) + (i + 1) % loops.sizes[l];
            if (against) std::swap(a, b);
            --uses[{a, b}];
            ++uses[{b, a}];
        }
        first += loops.sizes[l];
    }
    for (const auto& [edge, count] : uses) EXPECT_EQ(count, 0) << edge.first << " to " << edge.second;
}

/// The triangles cover the polygon once: their number, areas without overlap, and sides that match.
void expect_covered(const Loops& loops, double tolerance = 1e-9) {
    const auto triangles = triangulate(loops.points, loops.sizes);
    ASSERT_EQ(triangles.size(), loops.points.size() + 2 * (loops.sizes.size() - 1) - 2);
    double covered = 0;
    const double sign = signed_area(std::span(loops.points).first(loops.sizes[0])) < 0 ? -1 : 1;
    for (const auto& t : triangles) {
        const double area = sign * cross(loops.points[t[0]], loops.points[t[1]], loops.points[t[2]]) / 2;
        EXPECT_GE(area, -tolerance);
        covered += area;
    }
    EXPECT_NEAR(covered, area_of(loops), tolerance * (1 + area_of(loops)));
    expect_closed(loops, triangles);
}

/// A star-shaped polygon about a centre, without crossings.
std::vector<V2d> star(std::mt19937& random, V2d centre, double radius, int count) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<V2d> loop;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * (i + 0.8 * unit(random)) / count;
        const double r = radius * (0.3 + 0.7 * unit(random));
        loop.push_back(centre + V2d(std::cos(angle), std::sin(angle)) * r);
    }
    return loop;
}

TEST(Triangulate, ConvexAndConcave) {
    Loops square;
    square.add({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    expect_covered(square);
    Loops arrow;
    arrow.add({{0, 0}, {2, 2}, {0, 1}, {-2, 2}});
    expect_covered(arrow);
    Loops clockwise;
    clockwise.add({{-2, 2}, {0, 1}, {2, 2}, {0, 0}});
    expect_covered(clockwise);
    Loops comb;
    std::vector<V2d> teeth;
    for (int i = 0; i < 20; ++i) teeth.insert(teeth.end(), {V2d(i, 0), V2d(i + 0.5, 10)});
    teeth.insert(teeth.end(), {V2d(20, 0), V2d(20, -1), V2d(0, -1)});
    comb.add(teeth);
    expect_covered(comb);
}

TEST(Triangulate, RandomPolygonsWithHoles) {
    std::mt19937 random(7);
    for (int round = 0; round < 400; ++round) {
        Loops loops;
        loops.add(star(random, {0, 0}, 10, 3 + round % 40));
        // Holes in cells that lie inside the outline's inscribed circle.
        if (loops.sizes[0] >= 24)
            for (int i = 0; i < round % 5; ++i) {
                auto hole = star(random, V2d(-1.2 + 0.6 * i, 0.3 * (i % 2)), 0.25, 3 + (round + i) % 9);
                if (round & 1) std::reverse(hole.begin(), hole.end());
                loops.add(hole);
            }
        if (round & 2) std::reverse(loops.points.begin(), loops.points.begin() + loops.sizes[0]);
        expect_covered(loops);
        if (HasFailure()) FAIL() << "round " << round;
    }
}

TEST(Triangulate, HolesInAGridAlignWithEachOther) {
    // Rays from a hole to the left meet corners exactly.
    Loops loops;
    loops.add({{0, 0}, {9, 0}, {9, 9}, {0, 9}});
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const double x = 1 + 2 * i, y = 1 + 2 * j;
            loops.add({{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}});
        }
    expect_covered(loops);
}

TEST(Triangulate, CollinearAndCoincidentPointsStay) {
    Loops line;  // a square with points along its sides
    std::vector<V2d> loop;
    for (int i = 0; i < 8; ++i) loop.emplace_back(i, 0);
    for (int i = 0; i < 8; ++i) loop.emplace_back(8, i);
    for (int i = 0; i < 8; ++i) loop.emplace_back(8 - i, 8);
    for (int i = 0; i < 8; ++i) loop.emplace_back(0, 8 - i);
    line.add(loop);
    line.add({{2, 2}, {3, 2}, {4, 2}, {4, 3}, {4, 4}, {3, 4}, {2, 4}, {2, 3}});
    expect_covered(line);

    Loops twice;
    twice.add({{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}, {1, 1}, {0, 1}});
    expect_covered(twice);

    Loops keyhole;  // a hole joined to the outline by the drawing itself
    keyhole.add({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}});
    const auto triangles = triangulate(keyhole.points, keyhole.sizes);
    double covered = 0;
    for (const auto& t : triangles)
        covered += cross(keyhole.points[t[0]], keyhole.points[t[1]], keyhole.points[t[2]]) / 2;
    EXPECT_NEAR(covered, 15, 1e-12);
}

TEST(Triangulate, RandomPolygonsOnSmallIntegers) {
    // Many points on lines and on each other: orthogonal outlines of random columns.
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        std::vector<V2d> loop;
        const int columns = 1 + static_cast<int>(random() % 12);
        for (int i = 0; i <= columns; ++i) loop.emplace_back(i, 0);
        for (int i = columns; i-- > 0;) {
            const double top = 1 + static_cast<double>(random() % 4);
            loop.emplace_back(i + 1, top);
            loop.emplace_back(i, top);
        }
        Loops loops;
        loops.add(loop);
        expect_covered(loops);
        if (HasFailure()) FAIL() << "round " << round;
    }
}

TEST(Triangulate, AnythingEnds) {
    std::mt19937 random(11);
    for (int round = 0; round < 500; ++round) {
        // Crossing loops, on few places, some with infinities and NaN.
        Loops loops;
        const int count = 1 + static_cast<int>(random() % 4);
        for (int l = 0; l < count; ++l) {
            std::vector<V2d> loop;
            const int size = 1 + static_cast<int>(random() % 20);
            for (int i = 0; i < size; ++i)
                loop.emplace_back(static_cast<double>(random() % 7), static_cast<double>(random() % 7));
            if (round % 10 == 9) loop[0].x = round % 20 == 9 ? NAN : INFINITY;
            loops.add(loop);
        }
        const auto triangles = triangulate(loops.points, loops.sizes);
        if (loops.sizes[0] < 3) {
            EXPECT_TRUE(triangles.empty());
            continue;
        }
        EXPECT_GE(static_cast<int>(triangles.size()), loops.sizes[0] - 2);
        for (const auto& t : triangles)
            for (int i : t) ASSERT_TRUE(i >= 0 && i < static_cast<int>(loops.points.size()));
    }
}

TEST(Triangulate, ManyPoints) {
    std::mt19937 random(5);
    Loops loops;
    loops.add(star(random, {0, 0}, 1, 20000));
    expect_covered(loops);
}

}  // namespace
}  // namespace trapeze
