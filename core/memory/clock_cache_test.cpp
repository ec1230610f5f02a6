#include "core/memory/clock_cache.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace trapeze {
namespace {

struct Thing {
    size_t number;
    size_t bytes() const { return 10; }
};
std::shared_ptr<const Thing> thing(size_t number) {
    return std::make_shared<Thing>(Thing{number});
}

TEST(ClockCache, MakesThingsOnceWhileTheyFit) {
    ClockCache<Thing> cache(5, 50);
    int made = 0;
    for (int time = 0; time < 3; ++time)
        for (size_t i = 0; i < 5; ++i) EXPECT_EQ(cache.get(i, [&] { return ++made, thing(i); })->number, i);
    EXPECT_EQ(made, 5);
    EXPECT_TRUE(cache.has(4));
}

/// What has been asked for since the hand came by stays.
TEST(ClockCache, ForgetsWhatNobodyAsksFor) {
    ClockCache<Thing> cache(10, 30);
    const size_t places = cache.bytes();
    int made = 0;
    const auto get = [&](size_t i) { return cache.get(i, [&] { return ++made, thing(i); }); };
    for (size_t i = 0; i < 10; ++i) get(0), get(i);
    EXPECT_EQ(cache.bytes(), places + 30);
    const int before = made;
    get(0);
    EXPECT_LE(made, before + 1);
    // What is held is there, forgotten or not.
    const std::shared_ptr<const Thing> held = get(3);
    for (size_t i = 4; i < 10; ++i) get(i);
    EXPECT_EQ(held->number, 3u);
}

TEST(ClockCache, IsSharedByThreads) {
    ClockCache<Thing> cache(100, 200);
    const size_t places = cache.bytes();
    {
        std::vector<std::jthread> threads;
        for (size_t thread = 0; thread < 4; ++thread)
            threads.emplace_back([&cache, thread] {
                for (size_t k = 0; k < 5000; ++k) {
                    const size_t i = (k + thread * 11) * 37 % 100;
                    EXPECT_EQ(cache.get(i, [&] { return thing(i); })->number, i);
                }
            });
    }
    EXPECT_LE(cache.bytes(), places + 300) << "one in the making for each thread, besides what is kept";
}

}  // namespace
}  // namespace trapeze
