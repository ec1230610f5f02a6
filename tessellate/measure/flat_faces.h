/// Micropolygons of flat faces may be larger than a pixel where only rays of shaders meet them: these shade
/// what they meet anew, at its own place (dice_point()), and a plane is the same however it is cut. Only
/// values that hits take from the corners of micropolygons limit the size: a face that is not linear is cut
/// until triangles have them nearly where they are.
#pragma once

#include <array>

#include "tessellate/measure/screen_metric.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// Sides of micropolygons of flat faces are so many times as long at most.
inline constexpr float kLargestFlatTimes = 16;

/// How many times as long as `fine` micropolygons' sides of a surface may be: kLargestFlatTimes where its
/// faces are flat and their edges straight at all times, else 1. `fine`: the wished length in pixels.
float flat_times(const PlacedSurface& surface, const ScreenMetric& metric, float fine);

/// Whether a shape has variables within its faces that hits take from the corners of micropolygons.
bool has_corner_values(const Shape& shape);

/// How flat faces are cut.
class FlatCuts {
  public:
    FlatCuts() = default;
    /// `fine`: the wished length of sides in pixels if faces were not flat; they are `times` as long.
    /// `has_values`: has_corner_values() of the shape. The metric outlives this.
    FlatCuts(const ScreenMetric& metric, float fine, float times, bool has_values)
        : metric_(&metric), times_(times), fine_(fine), has_values_(has_values) {}

    bool are_wanted() const { return times_ > 1; }
    /// Whether segments() may want more of a face than its size does.
    bool may_cut(const Surface& surface, int face) const {
        return are_wanted() && has_values_ && !surface.is_linear(face);
    }
    /// Segments along u and v of a rectangle that wants `segments` for its size; more than kMaxGridSide
    /// where it has to be split. Corners in camera space: 00, 10, 01, 11.
    std::array<int, 2> segments(const std::array<V3f, 4>& corners, std::array<int, 2> segments) const;
    /// Those that its size would want if it were not flat.
    std::array<int, 2> fine_segments(const std::array<V3f, 4>& corners) const;

  private:
    const ScreenMetric* metric_ = nullptr;
    float times_ = 1, fine_ = 1;
    bool has_values_ = false;
};

/// Of a face's corners, 00, 10, 01, 11.
inline constexpr std::array<V2f, 4> kFaceCorners{V2f(0, 0), V2f(1, 0), V2f(0, 1), V2f(1, 1)};

}  // namespace trapeze
