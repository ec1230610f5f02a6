/// Glow over a finished picture: a part of the light of each pixel, or of what is above a threshold, is
/// spread around it by three Gaussians, so that the sum of all pixels stays what it was. Beyond its edges the
/// picture counts as mirrored: as much light comes in there as leaves it, and what is bright to the edge
/// stays so.
///
/// A pixel's new value depends on the pixels within reach alone, and its sums are of one order: a crop with a
/// margin of that reach equals the same pixels of the whole picture, bit for bit.
#pragma once

#include <vector>

#include "composite/image.h"
#include "core/scene/glow.h"

namespace trapeze {

/// The pixels that a crop of a picture needs to be made: the crop and what glows into it.
PixelRect glow_window(const Glow& glow, const Camera& camera, const PixelRect& crop);

/// First spread_row() for all rows of the image's window, then add_to_row() for all of `kept`: rows in any
/// order and from any thread, but none of the second before all of the first.
class GlowFilter {
  public:
    /// `image` has the pixels of glow_window(kept).
    GlowFilter(const Glow& glow, const Camera& camera, const PixelRect& kept, Image& image);

    /// Spreads a row's light along it.
    void spread_row(int y);
    /// Spreads it down, and changes the row's pixels in `kept`. Other pixels stay as they are.
    void add_to_row(int y);

  private:
    struct Lobe {
        std::vector<float> along, down;  ///< weights from -reach to reach; sums are 1 and the lobe's share
        std::vector<float> spread;       ///< along rows: three colours of kept's columns, rows of the window
    };
    /// What a pixel has to spread, as a share of its light.
    float share(const float* rgba) const;

    Glow glow_;
    int width_, height_;  ///< of the whole picture
    PixelRect kept_;
    Image& image_;
    std::vector<Lobe> lobes_;
};

/// Pixels of `window`, which is in the image's, alone.
void trim(const PixelRect& window, Image& image);

}  // namespace trapeze
