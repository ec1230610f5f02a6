#include "core/task.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace trapeze {
namespace {

Task<int> sum_to(int n) {
    if (n == 0) co_return 0;
    const int before = co_await sum_to(n - 1);
    co_return before + 1;
}

/// Notes where the thread's stack is, at each depth.
Task<> note_stack(int depth, std::vector<uintptr_t>& places) {
    char here = 0;
    char* volatile place = &here;  // of this call's own, kept on the heap; what it calls is on the stack
    const auto of_stack = [](std::vector<uintptr_t>& noted) {
        volatile char on_stack = 0;
        noted.push_back(reinterpret_cast<uintptr_t>(&on_stack));
    };
    of_stack(places);
    if (depth > 0 && place) co_await note_stack(depth - 1, places);
}

Task<std::string> throws_at(int depth) {
    if (depth == 0) throw std::runtime_error("as deep as that");
    co_return co_await throws_at(depth - 1);
}

Task<> counts(int& alive) {
    struct Counted {
        int& count;
        explicit Counted(int& c) : count(c) { ++count; }
        ~Counted() { --count; }
    } counted(alive);
    co_await throws_at(3);
}

Task<std::unique_ptr<int>> makes(int value) {
    co_return std::make_unique<int>(value);
}

TEST(Task, ReturnsWhatWasMade) {
    EXPECT_EQ(*makes(7).get(), 7);
    EXPECT_EQ(sum_to(10).get(), 10);
}

TEST(Task, IsAsDeepAsMemoryReaches) {
    EXPECT_EQ(sum_to(200'000).get(), 200'000);
}

TEST(Task, TakesNoMoreOfTheStackWhereItIsDeep) {
    std::vector<uintptr_t> places;
    places.reserve(1001);
    note_stack(1000, places).get();
    ASSERT_EQ(places.size(), 1001u);
    for (const uintptr_t place : places) EXPECT_EQ(place, places[1]);
}

TEST(Task, ThrowsWhereItIsWaitedFor) {
    EXPECT_THROW(throws_at(5).get(), std::runtime_error);
    int alive = 0;
    EXPECT_THROW(counts(alive).get(), std::runtime_error);
    EXPECT_EQ(alive, 0);
}

TEST(Task, DoesNotBeginUnasked) {
    int alive = 0;
    { const Task<> never = counts(alive); }
    EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace trapeze
