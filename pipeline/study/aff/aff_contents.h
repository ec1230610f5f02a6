/// What an AFF file and those that it includes say, of which AffScene makes triangles at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/study/aff/aff_transforms.h"

namespace trapeze {

struct AffCamera {
    V3f from{0, 0, 0};
    V3f at{0, 0, -1};  ///< in the middle of the picture
    V3f up{0, 1, 0};   ///< neither of length 1 nor across the view, in general
    float angle =
        45;  ///< degrees of the whole field of view, from the upper to the lower edge of the picture
    float hither = 1;               ///< distance of the near plane
    int width = 800, height = 600;  ///< pixels, which are squares
};

/// Triangles one after the other that are in the same transform.
struct AffRun {
    int transform;
    size_t begin, end;
};

/// A triangle whose corners move in their transform's space. Times never fall from key to key.
struct AffMovingTriangle {
    size_t triangle;
    int transform;
    std::vector<double> times;
    std::vector<V3f> corners;  ///< three a time

    /// Corner 0 to 2 at a time: straight from key to key; before the first and after the last one as there.
    V3f corner_at(double time, size_t corner) const;
};

struct AffContents {
    AffCamera camera;
    double first_time = 0, last_time = 0;
    int frames = 1;
    AffTransforms transforms;
    std::vector<V3f> corners;  ///< three a triangle, in its transform's space; of moving ones those of a key
    std::vector<AffRun> runs;  ///< of all triangles
    std::vector<AffMovingTriangle> moving;
    std::optional<AffAnimation> camera_animation;
};

}  // namespace trapeze
