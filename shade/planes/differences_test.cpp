#include "shade/planes/differences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace trapeze {
namespace {

struct Surface {
    GridShape shape{8, 8};
    PlanePool pool;
    Plane3 P, N;

    explicit Surface(const std::function<V3f(float, float)>& position) {
        pool.start(shape.vertex_count());
        P = pool.take3(), N = pool.take3();
        for (int k = 0; k < 3; ++k) fill(7, N[k]);
        for (int j = 0; j <= shape.nv; ++j)
            for (int i = 0; i <= shape.nu; ++i)
                set(i, j, position(static_cast<float>(i) / 8, static_cast<float>(j) / 8));
    }
    void set(int i, int j, const V3f& p) {
        for (int k = 0; k < 3; ++k) P[k][shape.row_index(i, j)] = p[k];
    }
    V3f normal(int i, int j) const {
        const int at = shape.row_index(i, j);
        return {N.x[at], N.y[at], N.z[at]};
    }
};

V3f sphere(float u, float v) {
    const float theta = v * 1.5f, phi = u;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), 5 + std::cos(theta)};
}

TEST(Difference, IsTheStepToTheNextVertex) {
    const GridShape shape{4, 3};
    PlanePool pool;
    pool.start(shape.vertex_count());
    const Plane value = pool.take(), out = pool.take();
    for (int j = 0; j <= 3; ++j)
        for (int i = 0; i <= 4; ++i)
            value[shape.row_index(i, j)] = 3 * static_cast<float>(i) + 0.5f * static_cast<float>(j);
    difference(shape, GridAxis::U, value, out);
    for (int i = 0; i < shape.vertex_count(); ++i) EXPECT_EQ(out[i], 3);
    difference(shape, GridAxis::V, value, out);
    for (int i = 0; i < shape.vertex_count(); ++i) EXPECT_EQ(out[i], 0.5f);
}

TEST(FindNormals, OfAPlaneAndReversed) {
    Surface plane([](float u, float v) { return V3f(u, v, 2); });
    find_normals(plane.shape, plane.P, false, plane.N);
    for (int j = 0; j <= 8; ++j)
        for (int i = 0; i <= 8; ++i) EXPECT_EQ(plane.normal(i, j), V3f(0, 0, 1));
    find_normals(plane.shape, plane.P, true, plane.N);
    EXPECT_EQ(plane.normal(3, 4), V3f(0, 0, -1));
}

TEST(FindNormals, OfASphereWithItsPole) {
    Surface ball(sphere);
    find_normals(ball.shape, ball.P, false, ball.N);
    for (int j = 0; j <= 8; ++j)
        for (int i = 0; i <= 8; ++i) {
            const V3f outward = sphere(static_cast<float>(i) / 8, static_cast<float>(j) / 8) - V3f(0, 0, 5);
            // The tangents' order makes the normals point inside.
            EXPECT_GT(std::fabs(ball.normal(i, j).dot(outward)), 0.97f) << i << ' ' << j;
            EXPECT_EQ(std::signbit(ball.normal(i, j).dot(outward)),
                      std::signbit(ball.normal(4, 4).dot(V3f(sphere(0.5f, 0.5f) - V3f(0, 0, 5)))));
        }
}

TEST(FindNormals, BordersSnappedToACoarserRate) {
    Surface plane([](float u, float v) { return V3f(u, v, 2); });
    for (int i = 0; i <= 8; ++i) plane.set(i, 0, V3f(i < 5 ? 0.0f : 1.0f, 0, 2));
    find_normals(plane.shape, plane.P, false, plane.N);
    for (int j = 0; j <= 8; ++j)
        for (int i = 0; i <= 8; ++i) EXPECT_GT(plane.normal(i, j).z, 0.999f) << i << ' ' << j;
}

TEST(FindNormals, APointOrALineKeepsWhatThereWas) {
    Surface point([](float, float) { return V3f(1, 2, 3); });
    find_normals(point.shape, point.P, false, point.N);
    EXPECT_EQ(point.normal(4, 4), V3f(7));
    Surface line([](float u, float v) { return V3f(u + v, 2 * (u + v), 3 * (u + v)); });
    find_normals(line.shape, line.P, false, line.N);
    EXPECT_EQ(line.normal(4, 4), V3f(7));
}

}  // namespace
}  // namespace trapeze
