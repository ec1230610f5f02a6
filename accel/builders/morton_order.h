/// The orientation-aware order: 5D Morton codes [Morton66] of orientation and centroid [Hou10 sec. 3.3].
/// Where all boxes overlap, as in hair, neighbours in this order at least run alike, so that oriented boxes
/// about them are thin.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "accel/builders/sah_topology.h"

namespace trapeze {

/// Shirley and Chiu's low distortion map of a hemisphere to the unit square [0,1]^2 [Shirley97]; equal solid
/// angles get equal areas. A direction and its opposite are the same orientation. Any NaN gives the middle.
V2f square_from_direction(const V3f& unit);

/// The 60-bit code of a unit direction and a centroid, whose place is taken relative to the box `centroids`:
/// 12 bits a dimension, interleaved, orientation in the more significant place of every five.
uint64_t orientation_morton_code(const V3f& direction, const V3f& centroid, const Box3f& centroids);

/// Sorts items by their codes within the box of their centroids, equal codes by id. direction(id) is a unit
/// vector; where all directions are equal it is the order of space alone.
void sort_by_orientation(std::span<SahItem> items, const std::function<V3f(uint32_t id)>& direction);

}  // namespace trapeze
