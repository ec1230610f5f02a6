/// The orientation-aware order: 5D Morton codes of orientation and centroid [Hou10 sec. 3.3].
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "accel/builders/sah_topology.h"

namespace trapeze {

/// Shirley and Chiu's low distortion map of a hemisphere to the unit square; a direction and its opposite are
/// the same orientation.
V2f square_from_direction(const V3f& unit);

/// 12 bits a dimension, interleaved, orientation in the more significant place of every five.
uint64_t orientation_morton_code(const V3f& direction, const V3f& centroid, const Box3f& centroids);

/// Sorts items by their codes within the box of their centroids, equal codes by id. Where all directions are
/// equal it is the order of space alone.
void sort_by_orientation(std::span<SahItem> items, const std::function<V3f(uint32_t id)>& direction);

}  // namespace trapeze
