/// The order of a few items along an axis, and the place in it where a node is split at the least cost: for
/// small nodes, of which most trees are made, where bins cost more than sorting.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "accel/builders/sah_bins.h"

namespace trapeze::sah {

/// Items of a small part in the order of their centroids along an axis; equal ones keep the order that they
/// came in, so that the order is total. At most kMostSwept, so that nothing is allocated.
class AxisOrder {
  public:
    AxisOrder(std::span<const SahItem> part, int axis) : part_(part) {
        for (size_t i = 0; i < part.size(); ++i) {
            const float at = part[i].centroid()[axis];
            place_[i].at = at >= kLeast ? at : kLeast;  // NaN has a place too
            place_[i].item = static_cast<uint32_t>(i);
        }
        std::sort(place_.begin(), place_.begin() + static_cast<std::ptrdiff_t>(part.size()));
    }
    const SahItem& operator[](size_t i) const { return part_[place_[i].item]; }

    /// Tries a split between each two neighbours, where bins try only at planes. node_cost: of visiting the
    /// node.
    void consider(int axis, double node_cost, Split& best) const {
        std::array<double, SahOptions::kMostSwept> cost_above;
        Bin above;
        for (size_t i = part_.size() - 1; i > 0; --i) {
            above.add((*this)[i]);
            cost_above[i] = above.cost();
        }
        Bin below;
        for (size_t i = 1; i < part_.size(); ++i) {
            below.add((*this)[i - 1]);
            const double cost = node_cost + below.cost() + cost_above[i];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }

  private:
    static constexpr float kLeast = std::numeric_limits<float>::lowest();
    std::span<const SahItem> part_;
    /// Compared by coordinate, then by item: hence the total order.
    struct Place {
        float at;
        uint32_t item;
        auto operator<=>(const Place&) const = default;
    };
    std::array<Place, SahOptions::kMostSwept> place_;
};

}  // namespace trapeze::sah
