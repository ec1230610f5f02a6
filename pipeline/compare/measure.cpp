#include "pipeline/compare/measure.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <tuple>

#include "pipeline/compare/frame_parts.h"
#include "pipeline/compare/occlusion_rays.h"
#include "pipeline/compare/sample_groups.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/frame/frame_memory.h"
#include "pipeline/frame/tiles/resolve_tiles.h"

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

/// Says which methods are measured in parts of the picture, and which may take more than the budget, before
/// they do.
void tell_of_memory(const SharedFrame& frame, const std::vector<Sampler>& samplers) {
    Diagnostics& diagnostics = *frame.context.diagnostics;
    const size_t grids = frame.grids.bytes();
    for (const Sampler& sampler : samplers) {
        const BuildMemory memory = sampler.build_memory();
        const std::vector<FramePart> parts = parts_of(frame, memory);
        size_t most = 0;
        for (const FramePart& part : parts) most = std::max(most, part.build_bytes);
        if (parts.size() > 1)
            diagnostics.note(
                {},
                fmt::format("{} is measured in {} parts of the picture: in one it may take {} with its "
                            "grids, more than the budget of {}",
                            sampler.name(), parts.size(),
                            mebibytes_text(static_cast<double>(grids + memory.bytes(frame.grids))),
                            mebibytes_text(static_cast<double>(frame.memory_budget))),
                "method-parts");
        if (grids + most > frame.memory_budget)
            diagnostics.warning(
                {},
                fmt::format("{} may take {} with its grids while it is built, more than the budget of {}",
                            sampler.name(), mebibytes_text(static_cast<double>(grids + most)),
                            mebibytes_text(static_cast<double>(frame.memory_budget))),
                kTooLittleMemory);
    }
}

/// Adds what was built for a part of a picture to that of others, of which one is there at a time. The cost
/// by the surface area heuristic is that of one tree.
void add_part(const BuildStats& part, BuildStats& all) {
    const uint64_t most = std::max(all.tree_bytes, part.tree_bytes);
    all += part;
    all.tree_bytes = most, all.tree_sah_cost = 0;
}

/// All methods at one sample rate.
class RateRun {
  public:
    RateRun(const SharedFrame& frame, const std::vector<Sampler>& samplers, SampleRate rate,
            const MeasureSettings& settings)
        : frame_(frame),
          context_(frame.context_at(rate)),
          bytes_each_(settings.sample_bytes / std::max<size_t>(1, samplers.size())),
          longest_turn_(settings.longest_turn) {
        if (settings.occlusion) occlusion_rays_ = occlusion_rays(frame, rate, bytes_each_);
        for (const Sampler& sampler : samplers) {
            const MethodResult& result = add(sampler, rate);
            auto& pattern = patterns_[result.pattern];
            if (!pattern) pattern = sampler.make_pattern(context_);
        }
        if (frame.adaptive_context(rate, settings.variance).sample_levels <= 1) return;
        const auto taker = std::ranges::find_if(samplers, &Sampler::takes_levels);
        if (taker == samplers.end()) return;
        MethodResult& adaptive = add(*taker, rate);
        adaptive.method += " adaptive", adaptive.variance = settings.variance;
    }

    size_t turns() const { return results_.size(); }
    /// Whether a method's last turn took longer than one may.
    bool is_too_slow(size_t method) const {
        const MethodResult& result = results_[method];
        if (longest_turn_ <= 0 || result.build_seconds.empty()) return false;
        const double occlusion = result.occlusion_seconds.empty() ? 0 : result.occlusion_seconds.back();
        return result.build_seconds.back() + result.resolve_seconds.back() + occlusion > longest_turn_;
    }
    void take_turn(size_t method) {
        MethodResult& result = results_[method];
        result.build_seconds.push_back(0), result.resolve_seconds.push_back(0);
        result.sample = {}, result.hits = 0, result.build = {};
        for (const FramePart& part : parts_[method]) {
            if (result.variance > 0)
                take_adaptive(result, part);
            else
                take_part(result, part);
        }
    }

    std::vector<MethodResult>& results() { return results_; }

  private:
    /// A part's share of a turn, which is the last of all.
    void take_part(MethodResult& result, const FramePart& part) {
        const SamplePattern& pattern = *patterns_[result.pattern];
        const auto visibility = prepare(result, part, context_);
        Stopwatch watch;
        result.tile_side = visibility->tile_side();

        SampleGroups& groups = groups_of(result, part);
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
        result.resolve_seconds.back() += seconds;
        for (const Resolver& resolver : resolvers) {
            result.sample += resolver.stats;
            result.hits += resolver.hit_count;
        }
        if (!occlusion_rays_.empty() && result.parts == 1) trace_occlusion(*visibility, result);
    }

    MethodResult& add(const Sampler& sampler, SampleRate rate) {
        MethodResult& result = results_.emplace_back();
        result.sampler = sampler;
        result.method = sampler.name();
        result.pattern = pattern_name(sampler.pattern);
        result.rate = rate;
        result.micropolygons = frame_.grids.micropolygon_count();
        result.pixels = static_cast<uint64_t>(frame_.pixels.width()) * frame_.pixels.height();
        parts_.push_back(parts_of(frame_, sampler.build_memory()));
        result.parts = parts_.back().size();
        return result;
    }

    std::unique_ptr<Visibility> prepare(MethodResult& result, const FramePart& part,
                                        const RenderContext& context) const {
        Stopwatch watch;
        auto visibility = result.sampler.prepare(context, *part.grids);
        const double prepared = watch.lap();
        const BuildStats built = visibility->build_stats();
        result.build_seconds.back() += prepared - built.setup_seconds;
        if (result.parts == 1)
            result.build = built;
        else
            add_part(built, result.build);
        return visibility;
    }

    /// In runs of some thousand rays, as many as a tile has samples.
    void trace_occlusion(const Visibility& visibility, MethodResult& result) const {
        constexpr size_t kRun = 4096;
        struct Counts {
            SampleStats stats;
            uint64_t met = 0;
        };
        tbb::enumerable_thread_specific<Counts> counts;
        std::atomic<bool> takes_them = true;
        const std::span<const SpaceRay> all = occlusion_rays_;
        Stopwatch watch;
        tbb::parallel_for(
            size_t{0}, (all.size() + kRun - 1) / kRun,
            [&](size_t run) {
                if (context_.is_cancelled() || !takes_them) return;
                const auto rays = all.subspan(run * kRun, std::min(kRun, all.size() - run * kRun));
                std::array<uint8_t, kRun> met;
                Counts& mine = counts.local();
                if (!visibility.occluded(rays, kOcclusionRange, std::span(met).first(rays.size()),
                                         mine.stats))
                    takes_them = false;
                else
                    mine.met += static_cast<uint64_t>(std::count(met.begin(), met.begin() + rays.size(), 1));
            },
            tbb::simple_partitioner());
        const double seconds = watch.lap();
        if (!takes_them) return;
        result.occlusion_seconds.push_back(seconds);
        result.occlusion = {}, result.occluded = 0;
        for (const Counts& c : counts) result.occlusion += c.stats, result.occluded += c.met;
    }

    /// As a render has it: where more samples are taken depends on what the film makes of the first ones.
    void take_adaptive(MethodResult& result, const FramePart& part) const {
        const RenderContext context = frame_.adaptive_context(result.rate, result.variance);
        const auto pattern = result.sampler.make_pattern(context);
        const auto visibility = prepare(result, part, context);
        Film film(context);
        FrameStats stats;
        resolve_tiles(context, part.pixels, *part.grids, *visibility, *pattern, film, stats, [] {},
                      {{context.most_layers}});
        result.resolve_seconds.back() += stats.seconds.trace;
        result.sample += stats.sample;
    }

    /// Methods of one pattern and tile size share their samples.
    SampleGroups& groups_of(const MethodResult& result, const FramePart& part) {
        const PixelRect& p = part.pixels;
        const auto key = std::tuple{result.pattern, result.tile_side, std::array{p.x0, p.y0, p.x1, p.y1}};
        const auto found = groups_.find(key);
        if (found != groups_.end()) return found->second;
        // Of a part they are made again for each method and turn: those of all parts would take too much.
        if (result.parts > 1) groups_.clear();
        return groups_.emplace(key, SampleGroups(p, result.tile_side, result.rate.per_pixel(), bytes_each_))
            .first->second;
    }

    const SharedFrame& frame_;
    RenderContext context_;
    size_t bytes_each_;
    double longest_turn_;
    std::vector<SpaceRay> occlusion_rays_;
    std::vector<MethodResult> results_;
    std::vector<std::vector<FramePart>> parts_;  ///< as the results
    std::map<std::string, std::unique_ptr<SamplePattern>> patterns_;
    std::map<std::tuple<std::string, int, std::array<int, 4>>, SampleGroups> groups_;
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
    tell_of_memory(frame, samplers);
    std::vector<MethodResult> all;
    for (size_t r = 0; r < rates.size(); ++r) {
        RateRun run(frame, samplers, rates[r], settings);
        const size_t turns = run.turns() * static_cast<size_t>(settings.rounds);
        for (size_t turn = 0; turn < turns; ++turn) {
            if (!run.is_too_slow(turn % run.turns())) run.take_turn(turn % run.turns());
            if (frame.context.is_cancelled()) return {};
            const double done = static_cast<double>(turn + 1) / static_cast<double>(turns);
            if (settings.on_progress)
                settings.on_progress((static_cast<double>(r) + done) / static_cast<double>(rates.size()));
        }
        std::move(run.results().begin(), run.results().end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace trapeze
