/// Shapes given at the times of a motion block, resolved to the even keys of the shutter.
#pragma once

#include <memory>
#include <vector>

#include "core/scene/shapes.h"

namespace trapeze::rib {

/// Shapes do not change once they are made, so that poses, objects and scenes may share one.
using ShapePointer = std::shared_ptr<const Shape>;

/// Place `key` of `keys` even ones in the shutter, in seconds of the scene.
float key_time(float open, float close, int key, int keys);

/// Whether all of them have one topology and the same variables. At least one. Values may differ, and the
/// order of variables.
bool can_deform(const std::vector<ShapePointer>& shapes);

/// Gives shapes what they lack of the first one's variables, but for positions. Whether any did.
bool give_missing_variables(std::vector<ShapePointer>& shapes);

/// Colours ("Cs", "Os") do not move: what the surface has as the shutter opens is shaded. Poses that have
/// other ones than that which the shutter opens with are given its own. Whether some do not stay the same.
bool use_colors_at_open(std::vector<ShapePointer>& shapes, const std::vector<float>& times, float open);

/// The shapes at so many even times of the shutter (keys_for_poses()). Before the first time and after the
/// last a shape stays as it is.
std::vector<ShapePointer> shapes_at_keys(const std::vector<ShapePointer>& shapes,
                                         const std::vector<float>& times, float open, float close, int keys);

}  // namespace trapeze::rib
