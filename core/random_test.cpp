#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace trapeze {
namespace {

TEST(Random, UnitFloatsAreBelowOneAndEven) {
    EXPECT_EQ(unit_float(0), 0);
    EXPECT_LT(unit_float(~0u), 1);
    std::vector<int> bins(64);
    constexpr int kCount = 64000;
    for (uint32_t i = 0; i < kCount; ++i) ++bins[static_cast<size_t>(unit_float(hash(7, i)) * 64)];
    double chi_square = 0;
    for (const int n : bins) chi_square += (n - 1000.0) * (n - 1000.0) / 1000.0;
    EXPECT_LT(chi_square, 104);  // 63 degrees of freedom, one in a thousand
    EXPECT_GT(chi_square, 30);
}

TEST(Random, NeighbouringIndicesAreUnrelated) {
    double sum = 0;
    constexpr int kCount = 20000;
    for (uint32_t i = 0; i < kCount; ++i)
        sum += (unit_float(hash(1, i)) - 0.5) * (unit_float(hash(1, i + 1)) - 0.5);
    EXPECT_LT(std::abs(sum / kCount * 12), 4 / std::sqrt(kCount));  // correlation, four sigma
}

TEST(Random, OrderOfTheIndexMatters) {
    EXPECT_NE(hash(1, 2), hash(2, 1));
    EXPECT_NE(hash(1, 2, 3), hash(1, 3, 2));
    EXPECT_NE(hash(1, 2, 3, 4), hash(4, 2, 3, 1));
}

}  // namespace
}  // namespace trapeze
