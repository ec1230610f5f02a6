/// Glow in a frame: which pixels it needs, and its filter over the finished film.
#pragma once

#include "composite/image.h"
#include "core/scene/glow.h"
#include "core/scene/render_context.h"

namespace trapeze {

/// The context of a render with the margin around its crop that glows into it. Without `glow` it is the same.
RenderContext with_glow_margin(const RenderContext& context, const std::optional<Glow>& glow);

/// Lets a picture with that margin glow, applies Exposure's gamma, which such a film leaves to this, and
/// trims it to `crop`.
void glow_picture(const Glow& glow, const RenderContext& context, const PixelRect& crop, Image& image);

}  // namespace trapeze
