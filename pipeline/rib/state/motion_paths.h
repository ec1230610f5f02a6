/// How many motion keys a moving surface wants for its points' paths, which run straight between keys, to
/// look like the curves that they stand for.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/shapes.h"
#include "pipeline/rib/state/moving_transform.h"

namespace trapeze::rib {

/// Corners of an object-space box of all keys' points; empty when nothing is known of them.
std::vector<V3f> corners_of(const std::vector<std::shared_ptr<const Shape>>& shape_keys);

/// The farthest, in pixels, that a point's chord is from its path in the middle of a segment between keys, as
/// the camera sees them. Points behind the camera do not count. `transform` is camera_from_object.
float chord_error(const MovingTransform& transform, float open, float close, int keys,
                  const std::vector<V3f>& points, const Camera& camera);

/// MovingTransform::wanted_keys(), and more until chords are within a quarter of a pixel of the paths, or
/// there are kMaxKeyCount.
int keys_for_paths(const MovingTransform& transform, float open, float close,
                   const std::vector<std::shared_ptr<const Shape>>& shape_keys, const Camera& camera);

}  // namespace trapeze::rib
