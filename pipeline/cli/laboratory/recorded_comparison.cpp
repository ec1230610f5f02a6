#include "pipeline/cli/laboratory/recorded_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "core/simd/simd_limit.h"

namespace trapeze {
namespace {

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
