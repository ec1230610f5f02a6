/// The number of threads that a user asks for [decision 0023].
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace trapeze {

/// The number of threads that "-t N" asks for: 0 is all of the machine's, -N all but N; at least 1.
inline int thread_count(int asked) {
    const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return asked > 0 ? asked : std::max(1, all + asked);
}

/// Runs `work` with as many threads as are asked for, and no more anywhere in the process meanwhile.
template <class Work>
void on_threads(int asked, const Work& work) {
    const int threads = thread_count(asked);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads));
    tbb::task_arena(threads).execute(work);
}

}  // namespace trapeze
