#include "pipeline/compare/comparison.h"

#include <algorithm>

#include "pipeline/compare/flip.h"
#include "pipeline/compare/verdict.h"

namespace trapeze {
namespace {

/// Ratios of medians, rate by rate.
void set_ratios(Comparison& comparison) {
    for (ComparedMethod& method : comparison.methods) {
        const auto peers = comparison.at(method.result.rate);
        const auto base = std::find_if(peers.begin(), peers.end(), [&](const ComparedMethod* m) {
            return m->result.method == comparison.baseline;
        });
        const double seconds = base == peers.end() ? 0 : (*base)->result.total_median();
        method.ratio = seconds > 0 ? method.result.total_median() / seconds : 0;
    }
}

}  // namespace

std::vector<const ComparedMethod*> Comparison::at(SampleRate rate) const {
    std::vector<const ComparedMethod*> found;
    for (const ComparedMethod& method : methods)
        if (method.result.rate == rate) found.push_back(&method);
    return found;
}

MethodKind kind_of(const MethodResult& result) {
    return find_named(visibility_methods(), result.sampler.method.name)->kind;
}

std::string rate_text(SampleRate rate) {
    return std::to_string(rate.x) + "x" + std::to_string(rate.y);
}

std::string baseline_of(const std::vector<Sampler>& samplers) {
    const std::string first(visibility_methods().front().name);
    std::string of_kind;
    for (const Sampler& sampler : samplers) {
        if (sampler.name() == first) return first;
        if (of_kind.empty() && sampler.method.name == first) of_kind = sampler.name();
    }
    if (!of_kind.empty()) return of_kind;
    return samplers.empty() ? std::string() : samplers.front().name();
}

std::optional<Comparison> compare(const SharedFrame& frame, const CompareSettings& settings) {
    const auto begin_stage = [&](const std::string& what) {
        if (settings.on_stage) settings.on_stage(what);
    };
    Comparison comparison;
    comparison.machine = this_machine();
    comparison.frame = frame.stats;
    comparison.blur = measure_blur(frame.context.camera, frame.grids);
    comparison.rounds = settings.measure.rounds;
    comparison.reference_side = settings.reference_side;
    comparison.baseline = baseline_of(settings.samplers);
    comparison.rates = settings.rates;

    begin_stage("measuring");
    MeasureSettings measuring = settings.measure;
    measuring.on_progress = settings.on_progress;
    for (MethodResult& result : measure(frame, settings.samplers, settings.rates, measuring))
        comparison.methods.push_back({std::move(result), 0, 0, 0, {}});
    if (frame.context.is_cancelled()) return {};

    begin_stage("reference");
    auto reference = make_reference(frame, settings.reference_side, settings.on_progress);
    if (!reference) return {};
    comparison.reference = std::move(*reference);
    const SeenPicture seen_reference = seen_picture(comparison.reference);
    for (ComparedMethod& method : comparison.methods) {
        begin_stage("picture of " + method.result.method + " at " + rate_text(method.result.rate));
        auto picture = make_picture(frame, method.result.sampler, method.result.rate, settings.on_progress,
                                    method.result.variance);
        if (!picture) return {};
        method.picture = std::move(*picture);
        method.rmse = rms_difference(method.picture.image, comparison.reference);
        method.flip = flip_difference(seen_picture(method.picture.image), seen_reference);
    }
    set_ratios(comparison);
    comparison.verdict = judge(comparison);
    comparison.verdict_without_times = judge_without_times(comparison);
    return comparison;
}

}  // namespace trapeze
