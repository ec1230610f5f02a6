/// The sky over a point as a small raster, in which near things hide those behind them [Christensen08].
///
/// The hemisphere is seen from above, as a disc: a direction (x, y, z) with z along the normal is at (x, y).
/// A pixel's area is then the part of the sky that it stands for, by the cosine.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"
#include "core/scene/surfels.h"

namespace trapeze {

/// Which part of the sky counts, and how much of it each pixel is.
class SkyPart {
  public:
    /// `angle`: from the normal to the rim, radians; beyond a right angle nothing is seen. `uniform`: all
    /// solid angles alike, else by the cosine.
    SkyPart(float angle, bool uniform);

    static constexpr int kSide = 16;  ///< pixels
    static constexpr int kPixels = kSide * kSide;

    /// Of a pixel, the parts of all pixels' sum.
    float weight(int pixel) const { return weights_[static_cast<size_t>(pixel)]; }
    const float* weights() const { return weights_.data(); }
    int pixels_seen() const { return seen_; }  ///< those of any weight

  private:
    std::array<float, kPixels> weights_;
    int seen_ = 0;
};

/// What is in the way of light from a direction.
struct SeenSurface {
    float front = 0, back = 0;  ///< solid angles of either side
    float counts = 1;           ///< how much it adds to what is hidden
    V3f color{0, 0, 0};
};

class SurfelRaster {
  public:
    /// Pixels that are filled together.
    static constexpr int kLanes = 8;
    using Lanes = std::array<float, kLanes>;

    /// Forgets everything. `normal` has unit length. Without `clamp` everything counts, also behind others.
    void start(const V3f& normal, const SkyPart& sky, bool clamp);

    /// Adds a thing that is so small that its outline is of no matter. `way`: of unit length. Things are to
    /// be added from the nearest to the farthest where `counts` or colours differ.
    void add_small(const V3f& way, const SeenSurface& thing);
    /// Adds a disc; `normal` has unit length, or none where it faces the place. Only whether the thing has a
    /// front or a back matters, not how large they are.
    void add_disc(const V3f& way, const V3f& normal, float radius, const SeenSurface& thing);
    /// Adds a piece of surface. `ways`: from the place to its corners; `area`: what it hides, less than it
    /// has where light shines through. Pieces that share edges leave nothing open between them.
    void add_quad(const SurfelQuad& ways, float area, const SeenSurface& thing);

    float hidden() const { return hidden_; }     ///< part of the sky
    const V3f& light() const { return light_; }  ///< the mean of the colours, black where there is nothing
    /// Directions in which something of the sky is left, and how much of all of it that is.
    void open_parts(std::vector<V3f>& ways, std::vector<float>& parts) const;
    /// The mean direction in which nothing is, not normalised.
    V3f open_way() const;

  private:
    void cover(int first, const float* shares, float front, float back, Lanes& sums);
    void take(float part, const SeenSurface& thing);
    V3f to_raster(const V3f& way) const { return {way.dot(across_), way.dot(along_), way.dot(normal_)}; }

    V3f across_, along_, normal_;
    const SkyPart* sky_ = nullptr;
    bool clamp_ = true;
    std::array<float, SkyPart::kPixels> front_, back_;  ///< covered parts of pixels
    float hidden_ = 0;
    V3f light_{0, 0, 0};
};

}  // namespace trapeze
