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
    float front = 0, back = 0;  ///< solid angles that either side hides
    float counts = 1;           ///< how much it adds to what is hidden
    V3f color{0, 0, 0};
    /// Of what is behind it, what it hides: then it covers solid angles larger by this.
    float opacity = 1;
};

class SurfelRaster {
  public:
    /// Pixels that are filled together.
    static constexpr int kLanes = 8;
    using Lanes = std::array<float, kLanes>;

    /// Forgets everything. `normal` has unit length. Without `clamp` everything counts, also behind others.
    void start(const V3f& normal, const SkyPart& sky, bool clamp);

    /// Adds a thing that is so small that its outline is of no matter. `way`: of unit length. Things are to
    /// be added from the nearest to the farthest where `counts`, colours or opacities differ.
    void add_small(const V3f& way, const SeenSurface& thing);
    /// Adds a disc; `normal` has unit length, or none where it faces the place. Only whether the thing has a
    /// front or a back matters, not how large they are.
    void add_disc(const V3f& way, const V3f& normal, float radius, const SeenSurface& thing);
    /// Adds a piece of surface. `ways`: from the place to its corners; `area`: what it covers. Pieces that
    /// share edges leave nothing open between them.
    void add_quad(const SurfelQuad& ways, float area, const SeenSurface& thing);

    float hidden() const { return hidden_; }     ///< part of the sky
    const V3f& light() const { return light_; }  ///< the mean of the colours, black where there is nothing
    /// Directions in which something of the sky is left, and how much of all of it that is.
    void open_parts(std::vector<V3f>& ways, std::vector<float>& parts) const;
    /// The mean direction in which nothing is, not normalised.
    V3f open_way() const;

  private:
    using PixelParts = std::array<float, SkyPart::kPixels>;
    /// What one side of things hides that light passes. Pieces of one surface lie beside each other, whatever
    /// they are: what they cover adds up to a whole pixel, a layer. What comes then is a layer behind it.
    struct Layers {
        PixelParts covered;        ///< by anything, up to 1
        PixelParts reaches;        ///< what whole layers let through
        PixelParts begun, hiding;  ///< of the last layer: what is covered, and what that hides

        void start();
        void add(size_t pixel, float share, float opacity);
        float hidden(size_t pixel) const { return 1 - reaches[pixel] * (1 - hiding[pixel]); }
    };
    void cover(int first, const float* shares, float front, float back, const SeenSurface& thing,
               Lanes& sums);
    void cover_opaque(int first, const float* shares, float front, float back, Lanes& sums);
    void cover_in_layers(int first, const float* shares, float front, float back, float opacity, Lanes& sums);
    float hidden_by_layers(size_t pixel) const;
    float hidden_at(size_t pixel) const;
    void take(float part, const SeenSurface& thing);
    V3f to_raster(const V3f& way) const { return {way.dot(across_), way.dot(along_), way.dot(normal_)}; }

    V3f across_, along_, normal_;
    const SkyPart* sky_ = nullptr;
    bool clamp_ = true;
    PixelParts front_, back_;  ///< parts of pixels that opaque things cover
    Layers front_layers_, back_layers_;
    bool has_layers_ = false;  ///< else nothing lets light through
    float hidden_ = 0;
    V3f light_{0, 0, 0};
};

}  // namespace trapeze
