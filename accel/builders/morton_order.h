/// The orientation-aware order of grids: 5D Morton codes of orientation and centroid [Hou10 sec. 3.3].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"

namespace trapeze {

/// Shirley and Chiu's low distortion map of a hemisphere to the unit square; a direction and its opposite are
/// the same orientation.
V2f square_from_direction(const V3f& unit);

/// 12 bits a dimension, interleaved, orientation in the more significant place of every five.
uint64_t orientation_morton_code(const GridSummary& grid, const Box3f& centroids);

/// Sorts indices of grids by their codes within the box of their centroids, equal codes by index.
void sort_by_orientation(std::span<uint32_t> order, std::span<const GridSummary> grids);

}  // namespace trapeze
