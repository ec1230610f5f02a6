#include "pipeline/cli/support/recorded_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "core/simd/simd_limit.h"

namespace trapeze {
namespace {

/// The one option of several values: "0 .5 0 1".
constexpr std::string_view kCrop = "crop";

std::string list_of_samplers(const std::vector<Sampler>& samplers) {
    std::string list;
    for (const Sampler& sampler : samplers) list += (list.empty() ? "" : " ") + sampler.name();
    return list;
}

std::string list_of_rates(const std::vector<SampleRate>& rates) {
    std::string list;
    for (const SampleRate& rate : rates) list += (list.empty() ? "" : ",") + rate_text(rate);
    return list;
}

}  // namespace

std::vector<RecordedOption> recorded_options(const Arguments& a, const CompareSettings& settings) {
    std::vector<RecordedOption> options = {{"samplers", {list_of_samplers(settings.samplers)}},
                                           {"samples", {list_of_rates(settings.rates)}},
                                           {"reference", {std::to_string(settings.reference_side)}},
                                           {"repeat", {std::to_string(settings.measure.rounds)}},
                                           {"seed", {std::to_string(a.seed)}}};
    if (!a.pattern.empty()) options.push_back({"pattern", {a.pattern}});
    if (a.variance) options.push_back({"variance", {fmt::format("{}", *a.variance)}});
    if (a.resolution)
        options.push_back({"resolution", {fmt::format("{}x{}", a.resolution->first, a.resolution->second)}});
    if (a.crop) options.push_back({std::string(kCrop), {fmt::format("{}", fmt::join(*a.crop, " "))}});
    if (a.shading_rate) options.push_back({"shading-rate", {fmt::format("{}", *a.shading_rate)}});
    if (!a.first_rib.empty()) options.push_back({"option", a.first_rib});
    // Methods that look at a vector of things at once count more tests than a narrower one has.
    options.push_back({"simd", {std::string(simd_limit())}});
    return options;
}

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

std::optional<std::vector<std::string>> words_of(const std::vector<RecordedOption>& options,
                                                 std::string* error) {
    std::vector<std::string> words;
    for (const RecordedOption& option : options) {
        if (std::ranges::find(kReplayedOptions, option.name) == kReplayedOptions.end()) {
            *error = "\"options\" has \"" + option.name + "\", which a replay does not know";
            return {};
        }
        if (option.values.empty()) {
            *error = "\"options\" has \"" + option.name + "\" without a value";
            return {};
        }
        for (const std::string& value : option.values) {
            if (option.name != kCrop) {
                words.push_back("--" + option.name + "=" + value);
                continue;
            }
            words.push_back("--crop");
            std::istringstream edges(value);
            for (std::string edge; edges >> edge;) words.push_back(edge);
        }
    }
    return words;
}

}  // namespace trapeze
