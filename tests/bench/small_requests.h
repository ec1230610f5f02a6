/// RIB of many small requests, kind by kind: where what a request costs counts, and not its numbers.
#pragma once

#include <string>
#include <vector>

namespace trapeze::bench {

/// A few megabytes of what may stand in a world.
struct SmallRequests {
    const char* name;
    std::string (*text)();
};

const std::vector<SmallRequests>& small_request_kinds();

}  // namespace trapeze::bench
