/// Which of many rays go nearly alike.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/wide/wide_tree.h"

namespace trapeze {

/// Rays in groups, each with one main axis and sense, and with slopes and origins that differ little.
class RayGroups {
  public:
    /// The most rays of a group.
    static constexpr size_t kMost = 64;

    /// Groups rays that come in the order of their origins, more or less. Those whose directions are no
    /// numbers or have no length are in none.
    void group(std::span<const RangedRay> rays);

    /// Calls visit(numbers of rays) group by group.
    template <class Visit>
    void for_each(const Visit& visit) const {
        size_t first = 0;
        for (const uint32_t end : ends_)
            for (; first < end; first += std::min(kMost, end - first))
                visit(std::span(order_).subspan(first, std::min(kMost, end - first)));
    }

  private:
    void group_run(std::span<const RangedRay> rays, uint32_t first);

    std::vector<uint32_t> cells_,
        starts_;  ///< of the run that is grouped: each ray's cell, where cells begin
    std::vector<uint32_t> order_, ends_;
};

}  // namespace trapeze
