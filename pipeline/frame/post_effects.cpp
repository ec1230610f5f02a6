#include "pipeline/frame/post_effects.h"

#include <tbb/parallel_for.h>

#include "pipeline/frame/glow_picture.h"

namespace trapeze {
namespace {

/// Runs the imager shader over all pixels, a row at a time in parallel.
void run_imager(const Imager& imager, Image& image) {
    if (!imager.is_there()) return;
    const PixelRect& window = image.window;
    tbb::parallel_for(window.y0, window.y1, [&](int y) {
        imager.run(window.x0, y, window.width(), image.rgba.data() + 4 * image.index(window.x0, y));
    });
}

}  // namespace

PostEffects::PostEffects(const RenderContext& asked, const Access& access)
    : asked_(asked),
      imager_(asked, access),
      glow_(imager_.is_own_glow() ? std::nullopt : find_glow(asked.scene->options, asked.diagnostics)),
      context_(with_glow_margin(asked, glow_)) {}

bool PostEffects::apply(Image& image) const {
    // Light glows before Exposure's gamma, and imagers come after that.
    if (glow_) glow_picture(*glow_, context_, asked_.camera.crop, image);
    if (context_.is_cancelled()) return false;
    run_imager(imager_, image);
    return true;
}

}  // namespace trapeze
