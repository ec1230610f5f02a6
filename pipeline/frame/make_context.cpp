#include "pipeline/frame/make_context.h"

#include <algorithm>
#include <utility>

#include "composite/displays/display_plan.h"
#include "core/scene/adaptive_sampling.h"
#include "core/scene/layer_limit.h"
#include "pipeline/frame/open_colors.h"

namespace trapeze {

RenderContext make_context(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
    RenderContext context;
    context.scene = &scene;
    context.camera = make_camera(scene.options);
    if (settings.tile) context.camera.crop = part_of(context.camera.crop, *settings.tile);
    const AdaptiveSampling sampling = adaptive_sampling(scene.options);
    context.samples_x = sampling.samples_x, context.samples_y = sampling.samples_y;
    context.sample_levels = sampling.levels, context.pixel_variance = sampling.variance;
    context.seed = settings.seed;
    context.most_layers = layer_limit(scene.options);
    context.motion =
        std::ranges::any_of(scene.primitives,
                            [](const Primitive& primitive) { return primitive.key_count() > 1; }) ||
        std::ranges::any_of(scene.clipping_planes,
                            [](const ClippingPlane& plane) { return plane.keys.size() > 1; });
    context.float_colors = holds_more_than_halves(scene.options);
    OpenedColors opened = open_colors(scene.options, settings.colors, *settings.access, diagnostics);
    context.colors = std::move(opened.colors), context.lacks_colors = opened.failed;
    context.diagnostics = &diagnostics;
    context.cancelled = settings.cancelled;
    return context;
}

}  // namespace trapeze
