#include "core/scene/aov.h"

#include <cctype>

namespace trapeze {

const Aov* AovLayout::find(const DisplayVariable& variable) const& {
    const int channels = component_count(variable.type);
    const bool is_color = variable.type == ValueType::Color;
    for (const Aov& aov : aovs)
        if (aov.name == variable.name && aov.channels == channels && aov.is_color == is_color &&
            aov.filter == variable.filter)
            return &aov;
    return nullptr;
}

AovLayout aov_layout(const Options& options) {
    AovLayout layout;
    for (const Display& display : options.displays) {
        if (!display.variable || is_depth(*display.variable) || layout.find(*display.variable)) continue;
        if (display.has_driver("null")) continue;  // nobody sees it
        const int channels = component_count(display.variable->type);
        if (layout.channel_count + channels > kMostAovChannels) continue;
        layout.aovs.push_back({display.variable->name, channels, layout.channel_count,
                               display.variable->filter, display.variable->type == ValueType::Color});
        layout.channel_count += channels;
    }
    return layout;
}

bool can_name_channels(std::string_view name) {
    constexpr size_t kLongest = 200;  // characters; OpenEXR's names have at most 255, with prefix and suffix
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == ':'; };
    return !name.empty() && name.size() <= kLongest && std::all_of(name.begin(), name.end(), fits);
}

bool is_depth(const DisplayVariable& variable) {
    return variable.name == "z" && variable.type == ValueType::Float;
}

}  // namespace trapeze
