/// What all binary trees are held to: the same tree whatever the number of threads.
#pragma once

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <vector>

#include "accel/paper/top_level.h"

namespace trapeze::testing {

/// build(): a tree's TopLevel. Links and boxes are compared bit for bit.
template <class Build>
void expect_same_from_any_threads(const Build& build) {
    std::vector<TopLevel> tops;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                          static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] { tops.push_back(build()); });
    }
    for (const size_t other : {1, 2}) {
        ASSERT_EQ(tops[0].nodes.size(), tops[other].nodes.size());
        for (size_t i = 0; i < tops[0].nodes.size(); ++i)
            ASSERT_EQ(tops[0].nodes[i].link.value, tops[other].nodes[i].link.value);
        for (size_t i = 0; i < tops[0].boxes.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                ASSERT_EQ(tops[0].boxes[i].low[k], tops[other].boxes[i].low[k]);
                ASSERT_EQ(tops[0].boxes[i].high[k], tops[other].boxes[i].high[k]);
            }
    }
}

}  // namespace trapeze::testing
