#include "pipeline/frame/frame_checks.h"

#include <fmt/format.h>

#include <string>

#include "composite/mattes/matte_layers.h"
#include "pipeline/frame/frame_memory.h"

namespace trapeze {

std::optional<Sampler> sampler_for(const RenderContext& context, const RenderSettings& settings) {
    std::string wrong;
    std::optional<Sampler> sampler = choose_sampler(settings.sampler, settings.pattern, &wrong);
    if (!sampler) {
        context.diagnostics->error({}, wrong);
        return {};
    }
    if (context.sample_levels > 1 && !sampler->takes_levels()) {
        context.diagnostics->error(
            {},
            "adaptive sampling needs a method that takes samples one by one, as raytrace "
            "does, and the pattern stratified; \"" +
                sampler->name() + "\" with \"" + sampler->pattern.name + "\" takes them all");
        return {};
    }
    return sampler;
}

void check_region_memory(const RenderContext& context, const PixelRect& pixels, size_t used, size_t budget) {
    if (used <= budget) return;
    context.diagnostics->warning(
        {},
        fmt::format("a region of {}x{} pixels may take {} for grids and tree, more "
                    "than its {} of the memory budget",
                    pixels.width(), pixels.height(), mebibytes_text(static_cast<double>(used)),
                    mebibytes_text(static_cast<double>(budget))),
        "memory-budget");
}

void note_matte_loss(const RenderContext& context, const Image& image) {
    if (!(image.matte_loss > 0)) return;
    context.diagnostics->note({},
                              fmt::format("pixels meet more than {} names: mattes have left out up to {:.2g} "
                                          "of a pixel",
                                          kMatteRanks, image.matte_loss),
                              "matte-loss");
}

}  // namespace trapeze
