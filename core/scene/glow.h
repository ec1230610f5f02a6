/// Glow: light around what is bright, as lenses, eyes and film spread it. Imager "glow" asks for it; it is no
/// shader, since it looks at neighbours.
#pragma once

#include <optional>

#include "core/diagnostics.h"
#include "core/scene/scene.h"

namespace trapeze {

struct Glow {
    float amount = .2f;   ///< the share of light that is spread, above 0 to 1
    float size = .02f;    ///< of the widest part: its standard deviation, as a share of the picture's width
    float threshold = 0;  ///< what a pixel's brightest channel has above this is spread
    float pixel_aspect = 1;

    /// At most this: the work of a pixel grows with it.
    static constexpr float kMostSize = .1f;
    static constexpr float kMostPixels = 256;

    /// Standard deviation of the widest part, in pixels along x (or y) of a picture so wide.
    float pixels_x(int picture_width) const;
    float pixels_y(int picture_width) const;
};

/// What the options' Imager "glow" asks for, if it spreads anything. Values out of range are reported,
/// if `diagnostics` is not null, and clamped.
std::optional<Glow> find_glow(const Options& options, Diagnostics* diagnostics);

}  // namespace trapeze
