#include "tessellate/topology/point_lanes.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "core/random.h"
#include "core/simd/targets_harness.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {
namespace {

using testing::for_each_target;

/// Of all sizes, some of which have no direction or no end.
std::vector<V3f> vectors(size_t count, uint32_t seed) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<V3f> made;
    for (uint32_t i = 0; i < count; ++i) {
        const auto number = [&](uint32_t k) { return 2 * unit_float(hash(seed, 3 * i + k)) - 1; };
        const float scale = i % 5 == 3 ? 1e-30f : i % 5 == 4 ? 1e30f : 1;
        made.push_back(V3f(number(0), number(1), number(2)) * scale);
    }
    if (count > 6) made[1] = V3f(0, 0, 0), made[4].y = kInfinity, made[6].z = -0.0f;
    return made;
}

void expect_same(const V3f& got, const V3f& expected) {
    for (int k = 0; k < 3; ++k) {
        if (std::isnan(expected[k])) {
            EXPECT_TRUE(std::isnan(got[k]));
            continue;
        }
        EXPECT_EQ(std::bit_cast<uint32_t>(got[k]), std::bit_cast<uint32_t>(expected[k])) << got << expected;
    }
}

TEST(PointLanes, AreAsPointByPointOnEveryInstructionSet) {
    M44f m;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j) m[i][j] = unit_float(hash(3, static_cast<uint32_t>(4 * i + j))) - 0.4f;
    for_each_target([&] {
        for (size_t count = 0; count < 40; ++count) {
            const std::vector<V3f> a = vectors(count, 1), b = vectors(count, 2);
            std::vector<V3f> points(count + 1, V3f(7)), turned = a;
            Triples planes, normals;
            planes.resize(count), normals.resize(count);
            transform_points(m, a, points.data());
            transform_vectors(m, turned);
            to_planes(a, 3, planes);
            unit_normals(a, b, normals);
            for (size_t i = 0; i < count; ++i) {
                expect_same(points[i], transform_point(m, a[i]));
                expect_same(turned[i], transform_vector(m, a[i]));
                expect_same(planes.at(i), a[i] * 3.0f);
                expect_same(normals.at(i), unit_normal(a[i], b[i]));
            }
            EXPECT_EQ(points[count], V3f(7)) << "nothing behind the last";
        }
    });
}

}  // namespace
}  // namespace trapeze
