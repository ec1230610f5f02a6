#include "pipeline/compare/measure.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "pipeline/compare/sample_groups.h"
#include "pipeline/frame/stopwatch.h"

namespace trapeze {
namespace {

/// What a thread needs to resolve tiles.
struct Resolver {
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
    uint64_t hit_count = 0;
};

std::string pattern_name(const MethodSpec& pattern) {
    return spec_text(pattern, find_named(sample_patterns(), pattern.name)->options);
}

/// All methods at one sample rate.
class RateRun {
  public:
    RateRun(const SharedFrame& frame, const std::vector<Sampler>& samplers, SampleRate rate,
            size_t sample_bytes)
        : frame_(frame),
          context_(frame.context_at(rate)),
          bytes_each_(sample_bytes / std::max<size_t>(1, samplers.size())) {
        for (const Sampler& sampler : samplers) {
            MethodResult& result = results_.emplace_back();
            result.sampler = sampler;
            result.method = sampler.name();
            result.pattern = pattern_name(sampler.pattern);
            result.rate = rate;
            result.micropolygons = frame.grids.micropolygon_count();
            auto& pattern = patterns_[result.pattern];
            if (!pattern) pattern = sampler.make_pattern(context_);
        }
    }

    void take_turn(size_t method) {
        MethodResult& result = results_[method];
        const SamplePattern& pattern = *patterns_[result.pattern];
        Stopwatch watch;
        const auto visibility = result.sampler.prepare(context_, frame_.grids);
        const double prepared = watch.lap();
        result.build = visibility->build_stats();
        result.build_seconds.push_back(prepared - result.build.setup_seconds);
        result.tile_side = visibility->tile_side();

        SampleGroups& groups = groups_of(result);
        tbb::enumerable_thread_specific<Resolver> resolvers;
        double seconds = 0;
        for (size_t g = 0; g < groups.count() && !context_.is_cancelled(); ++g) {
            const auto tiles = groups.make(g, pattern);
            watch.lap();
            const auto resolve = [&](size_t i) {
                if (context_.is_cancelled()) return;
                Resolver& resolver = resolvers.local();
                visibility->resolve(tiles[i], resolver.hits, resolver.scratch, resolver.stats);
                resolver.hit_count += resolver.hits.hits.size();
            };
            // Tiles differ in cost by ten and more: one at a time.
            tbb::parallel_for(size_t{0}, tiles.size(), resolve, tbb::simple_partitioner());
            seconds += watch.lap();
        }
        result.resolve_seconds.push_back(seconds);
        result.sample = {}, result.hits = 0;
        for (const Resolver& resolver : resolvers) {
            result.sample += resolver.stats;
            result.hits += resolver.hit_count;
        }
    }

    std::vector<MethodResult>& results() { return results_; }

  private:
    /// Methods of one pattern and tile size share their samples.
    SampleGroups& groups_of(const MethodResult& result) {
        const auto key = std::pair{result.pattern, result.tile_side};
        const auto found = groups_.find(key);
        if (found != groups_.end()) return found->second;
        return groups_
            .emplace(key, SampleGroups(frame_.pixels, result.tile_side, result.rate.per_pixel(), bytes_each_))
            .first->second;
    }

    const SharedFrame& frame_;
    RenderContext context_;
    size_t bytes_each_;
    std::vector<MethodResult> results_;
    std::map<std::string, std::unique_ptr<SamplePattern>> patterns_;
    std::map<std::pair<std::string, int>, SampleGroups> groups_;
};

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const size_t middle = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<double> MethodResult::total_seconds() const {
    std::vector<double> sums;
    for (size_t i = 0; i < build_seconds.size(); ++i) sums.push_back(build_seconds[i] + resolve_seconds[i]);
    return sums;
}

double MethodResult::total_median() const {
    return median(total_seconds());
}

MethodResult::Spread MethodResult::total_spread() const {
    const std::vector<double> sums = total_seconds();
    if (sums.empty()) return {};
    const auto [least, most] = std::minmax_element(sums.begin(), sums.end());
    return {*least, *most};
}

std::vector<MethodResult> measure(const SharedFrame& frame, const std::vector<Sampler>& samplers,
                                  const std::vector<SampleRate>& rates, const MeasureSettings& settings) {
    std::vector<MethodResult> all;
    const size_t turns = rates.size() * samplers.size() * static_cast<size_t>(settings.rounds);
    size_t done = 0;
    for (const SampleRate& rate : rates) {
        RateRun run(frame, samplers, rate, settings.sample_bytes);
        for (int round = 0; round < settings.rounds; ++round)
            for (size_t method = 0; method < samplers.size(); ++method) {
                run.take_turn(method);
                if (frame.context.is_cancelled()) return {};
                if (settings.on_progress)
                    settings.on_progress(static_cast<double>(++done) / static_cast<double>(turns));
            }
        std::move(run.results().begin(), run.results().end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace trapeze
