#include "composite/displays/exr_channels.h"

#include <algorithm>

namespace trapeze {
namespace {

/// Values of a display's channels, in the order of channel_names().
std::vector<ExrChannel> values_of(const Image& image, const Options& options, const DisplayPlan& plan) {
    using Type = ExrChannel::Type;
    const Type type = plan.float_pixels ? Type::Float : Type::Half;
    std::vector<ExrChannel> channels;
    const auto add = [&channels](Type of, const float* values, size_t stride) {
        channels.push_back({{}, of, values, nullptr, stride});
    };
    if (plan.rgb)
        for (size_t c = 0; c < 3; ++c) add(type, image.rgba.data() + c, 4);
    if (plan.alpha) add(type, image.rgba.data() + 3, 4);
    if (plan.depth) add(Type::Float, image.z.data(), 1);
    if (plan.id) channels.push_back({{}, Type::Uint, nullptr, image.id.data(), 1});
    if (plan.matte) {
        const std::vector<MatteLayer> layers = matte_layers(options);
        const auto place = std::find(layers.begin(), layers.end(), *plan.matte) - layers.begin();
        for (int i = 0; i < kMatteFloats; ++i)
            add(Type::Float, image.mattes.data() + kMatteFloats * place + i,
                static_cast<size_t>(image.matte_floats));
    }
    if (plan.aov)
        for (int c = 0; c < plan.aov->channels; ++c)
            add(type, image.aovs.data() + plan.aov->offset + c, static_cast<size_t>(image.aov_channels));
    return channels;
}

}  // namespace

std::vector<ExrChannel> exr_channels(const PictureToWrite& picture) {
    const bool has_layers = !picture.further.empty();
    std::vector<ExrChannel> all;
    const auto add = [&](const DisplayPlan& plan) {
        const std::vector<std::string> names = channel_names(plan, has_layers);
        std::vector<ExrChannel> channels = values_of(picture.image, picture.context.scene->options, plan);
        for (size_t i = 0; i < channels.size(); ++i) {
            channels[i].name = names[i];
            all.push_back(std::move(channels[i]));
        }
    };
    add(picture.plan);
    for (const DisplayPlan& plan : picture.further) add(plan);
    return all;
}

}  // namespace trapeze
