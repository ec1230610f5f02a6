#include "pipeline/cli/support/recorded_options.h"

#include <fmt/format.h>

namespace trapeze {

std::vector<RecordedOption> recorded_options(const Arguments& a) {
    std::vector<RecordedOption> options = {
        {"scenes", a.inputs}, {"sampler", {a.sampler}}, {"seed", {std::to_string(a.seed)}}};
    const auto add_text = [&](const char* name, const std::string& text) {
        if (!text.empty()) options.push_back({name, {text}});
    };
    const auto add_switch = [&](const char* name, bool on) {
        if (on) options.push_back({name, {}});
    };
    const auto add = [&](const char* name, const auto& value, const char* format) {
        if (value) options.push_back({name, {fmt::format(fmt::runtime(format), *value)}});
    };
    const auto add_pair = [&](const char* name, const std::optional<std::pair<int, int>>& pair) {
        if (pair) options.push_back({name, {fmt::format("{}x{}", pair->first, pair->second)}});
    };
    add_text("output", a.output), add_text("aov", a.aovs), add_text("driver", a.driver);
    add_text("pattern", a.pattern), add_text("transfer", a.transfer);
    add_text("ocio", a.colors.config), add_text("display", a.colors.display);
    add_text("view", a.colors.view), add_text("look", a.colors.look);
    add_pair("resolution", a.resolution), add_pair("tiles", a.tiles);
    if (a.tiles) options.push_back({"tile", {std::to_string(a.tile_number)}});
    if (a.samples) {
        if (a.samples->least) add_pair("samples at least", a.samples->least);
        add_pair("samples", a.samples->most);
    }
    add("variance", a.variance, "{}"), add("shading-rate", a.shading_rate, "{}");
    if (a.crop) options.push_back({std::string(kCrop), {fmt::format("{}", fmt::join(*a.crop, " "))}});
    if (a.most_layers > 0) options.push_back({"max-layers", {std::to_string(a.most_layers)}});
    if (a.frames) {
        options.push_back({"frames", {}});
        for (const FrameRange& range : *a.frames)
            options.back().values.push_back(fmt::format("{}-{}x{}", range.first, range.last, range.step));
    }
    if (!a.first_rib.empty()) options.push_back({"option", a.first_rib});
    if (!a.plugins.empty()) options.push_back({"plugin", a.plugins});
    add_switch("allow-programs", a.allow_programs), add_switch("safe", a.safe);
    return options;
}

}  // namespace trapeze
