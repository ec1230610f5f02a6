#include "accel/builders/sort_by_code.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace trapeze {
namespace {

UnsetVector<CodedItem> coded(size_t count, uint64_t mask) {
    UnsetVector<CodedItem> items;
    for (uint32_t i = 0; i < count; ++i)
        items.push_back({(uint64_t{hash(1, i)} << 32 | hash(2, i)) & mask, i});
    return items;
}

class SortByCode : public ::testing::TestWithParam<size_t> {};

TEST_P(SortByCode, IsThatOfComparisonsAndKeepsTheOrderOfEqualCodes) {
    constexpr int kBits = 54;
    // All bits; codes that many items have; digits that all have in common; one code.
    for (const uint64_t mask :
         {(uint64_t{1} << kBits) - 1, uint64_t{0xf00000000f}, uint64_t{1} << 53, uint64_t{0}}) {
        UnsetVector<CodedItem> items = coded(GetParam(), mask), expected = items;
        std::ranges::stable_sort(expected, {}, &CodedItem::code);
        sort_by_code(items, kBits);
        ASSERT_EQ(items.size(), expected.size());
        for (size_t i = 0; i < items.size(); ++i) {
            ASSERT_EQ(items[i].code, expected[i].code) << i;
            ASSERT_EQ(items[i].item, expected[i].item) << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Counts, SortByCode, ::testing::Values(0, 1, 2, 1000, 65536, 65537, 300000));

}  // namespace
}  // namespace trapeze
