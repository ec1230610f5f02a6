/// Which parts of a ray meet which level of geometry: the wider a ray has grown, the coarser
/// [Christensen03; decision 0033].
#pragma once

#include <array>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/ray_scene.h"

namespace trapeze {

/// A part of a ray's segment, by distances from its origin.
struct LevelSpan {
    int level = 0;
    float min = 0, max = 0;
};

/// The parts of a segment, from the nearest on. Each begins a little before the one in front of it ends: a
/// surface that lies a little differently on either level is met by one of them at least.
struct LevelSpans {
    std::array<LevelSpan, kMostRayLevels> span;
    int count = 0;

    const LevelSpan* begin() const { return span.data(); }
    const LevelSpan* end() const { return span.data() + count; }
};

/// The rule. It knows the ray and the camera alone: not what is in memory, nor what there is to meet.
class LevelRule {
  public:
    /// `levels`: those that there are, rising from 0.
    LevelRule(const Camera& camera, std::vector<int> levels);

    /// At least one part. Levels begin at the one that the ray has left (RaySegment::level).
    LevelSpans of(const RaySegment& ray) const;

    /// Whether there is one level alone.
    bool is_simple() const { return levels_.size() == 1; }
    /// A pixel's side at a point, camera space, as surfaces are cut (ScreenMetric): those beside an
    /// orthographic picture more and more coarsely.
    float pixel(const V3f& P) const;
    /// On the axis of the view: at a distance of 1, or in an orthographic picture, whose pixels are smallest
    /// there.
    V3f middle() const { return perspective_ ? V3f(0, 0, 1) : V3f(center_.x, center_.y, 0); }

  private:
    float begin_of(int level, const RaySegment& ray) const;

    bool perspective_;
    float pixel_;   ///< its side; for a perspective at the distance 1
    V2f center_;    ///< of an orthographic picture
    float radius_;  ///< of a circle around it
    float growth_;  ///< of a pixel's side, at most, on each unit of any way
    std::vector<int> levels_;
};

}  // namespace trapeze
