#include "pipeline/frame/glow_picture.h"

#include <tbb/parallel_for.h>

#include "composite/filters/exposure.h"
#include "composite/filters/glow_filter.h"

namespace trapeze {

RenderContext with_glow_margin(const RenderContext& context, const std::optional<Glow>& glow) {
    RenderContext grown = context;
    if (glow) grown.camera.crop = glow_window(*glow, context.camera, context.camera.crop);
    return grown;
}

void glow_picture(const Glow& glow, const RenderContext& context, const PixelRect& crop, Image& image) {
    if (crop.empty()) return;
    GlowFilter filter(glow, context.camera, crop, image);
    const PixelRect& window = image.window;
    tbb::parallel_for(window.y0, window.y1, [&](int y) {
        if (!context.is_cancelled()) filter.spread_row(y);
    });
    const float inverse_gamma = inverse_of_gamma(context.scene->options.exposure_gamma);
    tbb::parallel_for(crop.y0, crop.y1, [&](int y) {
        if (context.is_cancelled()) return;
        filter.add_to_row(y);
        for (int x = crop.x0; x < crop.x1; ++x)
            apply_gamma(inverse_gamma, &image.rgba[4 * image.index(x, y)]);
    });
    trim(crop, image);
}

}  // namespace trapeze
