/// How many motion keys a moving surface wants for its points' paths, which run straight between keys, to
/// look like the curves that they stand for.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/shapes.h"
#include "pipeline/rib/state/moving_transform.h"

namespace trapeze::rib {

/// Corners of an object-space box of all keys' points; empty when nothing is known of them.
std::vector<V3f> corners_of(std::span<const std::shared_ptr<const Shape>> shape_keys);

/// Corners of a box of all ways that points go between two neighbours of the shape's keys, in object space;
/// empty where they do not move.
std::vector<V3f> ways_of(std::span<const std::shared_ptr<const Shape>> shape_keys);

/// Points of an object, and how they move within it.
struct PointPaths {
    std::vector<V3f> points;  ///< corners_of()
    std::vector<V3f> ways;    ///< ways_of()
    int shape_keys = 1;
};

/// The farthest, in pixels, that a point's chord is from its path in the middle of a segment between keys, or
/// at one of `times`, as the camera sees them. Points behind the camera do not count. `transform` is
/// camera_from_object.
float chord_error(const MovingTransform& transform, float open, float close, int keys,
                  const PointPaths& paths, const std::vector<float>& times, const Camera& camera);

/// How many even keys of the shutter poses of a shape at other times want: 1 where nothing moves within the
/// shutter; where keys do not meet the times at least 17, and more until points are within a quarter of a
/// pixel of their paths at these times, or there are kMaxKeyCount. `transform` is camera_from_object.
int keys_for_poses(std::span<const std::shared_ptr<const Shape>> shapes, const std::vector<float>& times,
                   const MovingTransform& transform, float open, float close, const Camera& camera);

/// MovingTransform::wanted_keys(), and more until chords are within a quarter of a pixel of the paths, or
/// there are kMaxKeyCount. What bends paths is a rotation, the product of several motions, or of one and the
/// shape's own; and times that keys do not meet cut them short.
int keys_for_paths(const MovingTransform& transform, float open, float close,
                   std::span<const std::shared_ptr<const Shape>> shape_keys, const Camera& camera);

}  // namespace trapeze::rib
