/// How many pixels long a piece of a surface is. Projection needs no point in front of the eye: outside the
/// view, lengths are angles seen from the eye, so that nothing near the eye plane grows beyond bounds and no
/// eye splits are needed.
#pragma once

#include <algorithm>
#include <span>

#include "core/math.h"
#include "core/scene/camera.h"

namespace trapeze {

/// A length in pixels: as it is seen, and as it would be if it were seen square on at the same distance.
struct PixelLength {
    float seen = 0, square_on = 0;
    bool in_view = true;  ///< or beside the picture, where `seen` is an angle
};

/// The least foreshortening of what may turn to the viewer: while the shutter is open, or by displacement.
inline constexpr float kLeastForeshortening = 0.25f;

/// Lengths under one camera. Of the whole picture: a crop window changes nothing.
class ScreenMetric {
  public:
    /// Keeps no reference to the camera.
    explicit ScreenMetric(const Camera& camera);

    /// The length of the piece from p to q, camera space; bounded also behind the eye and in its plane.
    PixelLength of(const V3f& p, const V3f& q) const {
        return perspective_ ? perspective_length(p, q) : orthographic_length(p, q);
    }
    /// Lengths of several pieces, from[i] to to[i], the same bits.
    void of(std::span<const V3f> from, std::span<const V3f> to, std::span<PixelLength> lengths) const;
    /// Pixels of the piece as it is seen, but not less than the least foreshortening leaves of it.
    float length(const V3f& p, const V3f& q) const {
        const PixelLength length = of(p, q);
        return std::max(length.seen, kLeastForeshortening * length.square_on);
    }

    /// What lengths in a perspective view are made of: pixels for a unit of the image plane along its axes
    /// and the larger of both, and the cosine of the angle to the image's farthest corner.
    bool is_perspective() const { return perspective_; }
    float pixels_x() const { return pixels_x_; }
    float pixels_y() const { return pixels_y_; }
    float pixels() const { return pixels_; }
    float view_cosine() const { return view_cosine_; }

  private:
    /// In view: raster distance. Else the angle at the eye, in pixels as large as at the picture's corner.
    PixelLength perspective_length(const V3f& p, const V3f& q) const;
    /// perspective_length() of up to kLanes pieces.
    void perspective_lengths(std::span<const V3f> from, std::span<const V3f> to,
                             std::span<PixelLength> lengths) const;
    /// Raster distance, shrunk outside the picture by how far outside it is.
    PixelLength orthographic_length(const V3f& p, const V3f& q) const;

    bool perspective_;
    float pixels_x_, pixels_y_, pixels_;  ///< per unit of the image plane
    float view_cosine_;                   ///< of the angle to the image's farthest corner
    V2f center_{0, 0};                    ///< of the window, orthographic
    float radius_ = 1;                    ///< of a circle around the window, orthographic
};

}  // namespace trapeze
