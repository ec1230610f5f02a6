#include "core/memory/large_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace trapeze {
namespace {

TEST(LargePages, AlignsMemory) {
    for (const size_t bytes : {size_t{1}, size_t{1000}, kLargePage - 1, kLargePage, 3 * kLargePage + 5}) {
        void* const memory = large_memory(bytes);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(memory) % (bytes < kLargePage ? 64 : kLargePage), 0u);
        auto* const all = static_cast<std::byte*>(memory);
        all[0] = all[bytes - 1] = std::byte{1};
        std::free(memory);
    }
}

TEST(LargePages, KeepsValuesWhereAVectorGrows) {
    UnsetVector<uint32_t> values;
    for (uint32_t i = 0; i < 3000000; ++i) values.push_back(i * 3);
    values.resize(4000000);
    values.back() = 7;
    for (uint32_t i = 0; i < 3000000; ++i) ASSERT_EQ(values[i], i * 3);
    EXPECT_EQ(values.back(), 7u);
}

TEST(LargePages, ThrowsWhereThereIsNoMemory) {
    LargePages<uint64_t> pages;
    EXPECT_THROW(pages.allocate(std::numeric_limits<size_t>::max() / 4), std::bad_alloc);
    EXPECT_THROW(large_memory(std::numeric_limits<size_t>::max() / 4), std::bad_alloc);
    EXPECT_THROW(large_memory(std::numeric_limits<size_t>::max() - 1), std::bad_alloc);
}

}  // namespace
}  // namespace trapeze
