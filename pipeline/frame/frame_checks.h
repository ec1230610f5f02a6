/// What may be wrong with a frame, and how that is told.
#pragma once

#include <cstddef>
#include <optional>

#include "composite/image.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/render_settings.h"
#include "sample/visibility.h"

namespace trapeze {

/// The visibility method and the pattern that the settings name; nothing, after an error, where there are
/// none such, or where the context asks for adaptive sampling, which they cannot do.
std::optional<Sampler> sampler_for(const RenderContext& context, const RenderSettings& settings);

/// Warns of a region that may take more bytes than the budget, before it does: it is a single tile.
void check_region_memory(const RenderContext& context, const PixelRect& pixels, size_t used, size_t budget);

/// Notes what mattes of a picture have left out, if anything.
void note_matte_loss(const RenderContext& context, const Image& image);

}  // namespace trapeze
