#include "pipeline/preview/preview_channels.h"

#include <set>

#include "composite/displays/exr_channels.h"

namespace trapeze {
namespace {

/// The channels of a file that has all that is seen.
std::vector<ExrChannel> channels_of(const Image& image, const RenderContext& context) {
    const Options& options = context.scene->options;
    DisplayPlan picture;
    picture.depth = picture.float_pixels = true;
    const AovLayout layout = aov_layout(options);
    std::vector<DisplayPlan> variables;
    for (const Display& display : options.displays) {
        Diagnostics unheard;
        auto plan = plan_display(display, options, layout, unheard);
        if (!plan || !plan->aov || plan->deep) continue;
        if (plan->layer.empty()) plan->layer = plan->aov->name;
        variables.push_back(std::move(*plan));
    }
    const OutputInfo info;
    std::vector<ExrChannel> channels;
    std::set<std::string> names;
    for (ExrChannel& channel : exr_channels({image, context, picture, info, variables}))
        if (names.insert(channel.name).second) channels.push_back(std::move(channel));
    return channels;
}

}  // namespace

std::vector<std::string> preview_channels(const Image& image, const RenderContext& context) {
    std::vector<std::string> names;
    for (ExrChannel& channel : channels_of(image, context)) names.push_back(std::move(channel.name));
    return names;
}

PixelSource preview_source(const Image& image, const RenderContext& context) {
    PixelSource source{image.window, {}};
    for (const ExrChannel& channel : channels_of(image, context))
        source.channels.push_back({channel.floats, channel.stride});
    return source;
}

}  // namespace trapeze
