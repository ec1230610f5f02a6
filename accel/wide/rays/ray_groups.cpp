#include "accel/wide/rays/ray_groups.h"

#include <utility>

namespace trapeze {
namespace {

/// About so many rays should be in a cell of directions if they go everywhere on one side of a plane.
constexpr size_t kRaysOfCell = 24;
constexpr uint32_t kMostCellsOfSide = 32;
/// The most rays of a run.
constexpr size_t kMostOfRun = 16384;

/// Cells along a side of a face of the cube of directions.
uint32_t cells_of_side(size_t rays) {
    const size_t cells = rays / (3 * kRaysOfCell);
    uint32_t side = 1;
    while (side < kMostCellsOfSide && (2 * side) * (2 * side) <= 2 * cells) side *= 2;
    return side;
}

/// The first rays that begin close to each other: as far as the next origin lies beside the box of those
/// before by no more than the box is long.
size_t run_length(std::span<const RangedRay> rays) {
    V3f low = rays[0].ray.origin, high = low;
    bool is_point = true;
    for (size_t i = 1; i < std::min(rays.size(), kMostOfRun); ++i) {
        const V3f& at = rays[i].ray.origin;
        if (at == rays[i - 1].ray.origin) continue;
        V3f beside, size = high - low;
        for (int k = 0; k < 3; ++k) beside[k] = std::max({low[k] - at[k], at[k] - high[k], 0.0f});
        if (!is_point && !(beside.length2() <= 4 * size.length2())) return i;
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
        is_point = false;
    }
    return std::min(rays.size(), kMostOfRun);
}

}  // namespace

void RayGroups::group(std::span<const RangedRay> rays) {
    order_.resize(rays.size());
    ends_.clear();
    for (uint32_t first = 0; first < rays.size();) {
        const size_t length = run_length(rays.subspan(first));
        group_run(rays.subspan(first, length), first);
        first += static_cast<uint32_t>(length);
    }
}

/// Sorts rays by the cells of their directions. `first`: the number of the first.
void RayGroups::group_run(std::span<const RangedRay> rays, uint32_t first) {
    const uint32_t side = cells_of_side(rays.size()), none = 6 * side * side;
    const float half = 0.5f * static_cast<float>(side);
    cells_.resize(rays.size());
    starts_.assign(none + 1, 0);
    for (size_t i = 0; i < rays.size(); ++i) {
        const TurnedRay ray = axis_ray(rays[i].ray);
        const float u = half + half * ray.ray.ux, v = half + half * ray.ray.uy;
        uint32_t cell = none;
        if (u >= 0 && v >= 0) {  // not what is no number
            const uint32_t face = 2 * static_cast<uint32_t>(ray.z_plane) + (ray.depth_sign < 0);
            cell = (face * side + std::min(side - 1, static_cast<uint32_t>(v))) * side +
                   std::min(side - 1, static_cast<uint32_t>(u));
        }
        cells_[i] = cell;
        ++starts_[cell];
    }
    uint32_t sum = ends_.empty() ? 0 : ends_.back();
    for (uint32_t cell = 0; cell < none; ++cell) {
        sum += std::exchange(starts_[cell], sum);
        if (sum != starts_[cell]) ends_.push_back(sum);
    }
    for (uint32_t i = 0; i < rays.size(); ++i)
        if (cells_[i] != none) order_[starts_[cells_[i]]++] = first + i;
}

}  // namespace trapeze
