#include "shade/planes/planes.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace trapeze {
namespace {

TEST(PlanePool, PlanesArePaddedAlignedAndApart) {
    PlanePool pool;
    pool.start(289);
    const Plane a = pool.take(), b = pool.take();
    EXPECT_EQ(a.size(), 304u);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(a.data()) % 64, 0u);
    EXPECT_TRUE(a.data() + a.size() <= b.data() || b.data() + b.size() <= a.data());
}

TEST(PlanePool, MemoryIsReusedAndGrows) {
    PlanePool pool;
    pool.start(100);
    const float* first = pool.take().data();
    pool.start(90);
    const Plane again = pool.take();
    EXPECT_EQ(again.data(), first);
    EXPECT_EQ(again.size(), 96u);
    pool.start(1000);
    const Plane large = pool.take();
    for (float& x : large) x = 1;
    EXPECT_EQ(large.size(), 1008u);
}

TEST(Load, LastLanesRepeatTheLastValue) {
    PlanePool pool;
    pool.start(5);
    const Plane plane = pool.take();
    load(std::vector<float>{1, 2, 3, 4, 5}, 5, plane);
    EXPECT_EQ(plane[4], 5);
    EXPECT_EQ(plane[15], 5);
    load(std::vector<float>{7}, 5, plane);
    EXPECT_EQ(plane[0], 7);
    EXPECT_EQ(plane[15], 7);
    load({}, 5, plane);
    EXPECT_EQ(plane[3], 0);
}

}  // namespace
}  // namespace trapeze
