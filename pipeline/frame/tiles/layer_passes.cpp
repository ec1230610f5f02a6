#include "pipeline/frame/tiles/layer_passes.h"

#include <algorithm>
#include <numeric>

#include "pipeline/frame/cost/stopwatch.h"
#include "sample/hit_lists.h"

namespace trapeze {
namespace {

/// What a hit takes: 16 in the list as it is found, 16 in that in order and as much when it grows, 8 for half
/// as many in a bundle's lists, 24 where its colour is interpolated.
constexpr size_t kBytesPerHit = 80;
constexpr size_t kLeastRoom = 64;

/// Samples that go through passes together find this many layers in each pass, where there is room: few
/// samples and many layers take the fewest rays. But no bundle is worth while of much fewer rays.
constexpr size_t kLayersAtOnce = 64, kLeastGroup = 1024;

/// Leaves the first hits of each list, as many as a sample may still see.
template <class MostOf>
void shorten_lists(HitBuffer& hits, const MostOf& most_of) {
    uint32_t kept = 0;
    for (size_t s = 0; s < hits.size(); ++s) {
        const uint32_t begin = hits.first[s], count = std::min(hits.first[s + 1] - begin, most_of(s));
        hits.first[s] = kept;
        std::copy_n(hits.hits.begin() + begin, count, hits.hits.begin() + kept);
        kept += count;
    }
    hits.first.back() = kept;
    hits.hits.resize(kept);
}

}  // namespace

LayerLimits LayerLimits::of(uint32_t most, size_t bytes, int threads) {
    return {most, std::max(kLeastRoom, bytes / static_cast<size_t>(std::max(1, threads)) / kBytesPerHit)};
}

void LayerPasses::add_tile(const LayerTask& task, const SampleTile& samples, SampleScratch& scratch,
                           SampleStats& stats) {
    const size_t count = samples.size();
    const LayerLimits& limits = task.limits;
    // Opaque grids give a hit for each sample, whatever is asked for.
    const bool bounded = !task.all_opaque;
    const bool begins_whole = !bounded || count <= limits.room / 2;
    if (begins_whole) {
        scratch.window = bounded ? LayerWindow{{}, limits.most, limits.room} : LayerWindow{};
        find(task, samples, scratch, stats);
        if (!bounded || holds_all(scratch, hits_, limits.most)) {
            Stopwatch watch;
            if (limits.most != kAllLayers) shorten_lists(hits_, [&](size_t) { return limits.most; });
            task.sink.add(samples, hits_, task.grids);
            costs_.composite_seconds += watch.lap();
            return;
        }
    }
    Stopwatch watch;
    task.sink.begin_stack(count, stack_);
    resume_.assign(count, kInFrontOfAll);
    behind_.assign(count, kBehindAll);
    taken_.assign(count, 0);
    if (begins_whole) {
        group_.resize(count);
        std::iota(group_.begin(), group_.end(), 0u);
        add_to_stack(task, samples, scratch, group_);
        for (const uint32_t s : group_) behind_[s] = kBehindAll;
    }
    costs_.composite_seconds += watch.lap();
    find_rest(task, samples, scratch, stats);
    watch.lap();
    task.sink.add(samples, stack_);
    costs_.composite_seconds += watch.lap();
}

/// One pass.
void LayerPasses::find(const LayerTask& task, const SampleTile& samples, SampleScratch& scratch,
                       SampleStats& stats) {
    Stopwatch watch;
    task.visibility.resolve(samples, hits_, scratch, stats);
    costs_.trace_seconds += watch.lap();
    costs_.shows_something = costs_.shows_something || !hits_.hits.empty();
    costs_.list_bytes = std::max<uint64_t>(costs_.list_bytes, scratch.found.bytes() + scratch.own_list_bytes +
                                                                  hits_.hits.capacity() * sizeof(Hit));
}

/// Adds what was found of some samples to the stack. Leaves in `which` those that see something behind it,
/// and puts into resume_ and behind_ where they go on.
void LayerPasses::add_to_stack(const LayerTask& task, const SampleTile& samples, const SampleScratch& scratch,
                               std::vector<uint32_t>& which) {
    shorten_lists(hits_, [&](size_t s) { return task.limits.most - taken_[s]; });
    stack_.add(samples, hits_, task.grids, which);
    const auto is_done = [&](uint32_t s) {
        taken_[s] += static_cast<uint32_t>(hits_.of(s).size());
        const bool done = taken_[s] >= task.limits.most || stack_.is_hidden(s);
        resume_[s] = behind_[s] = done ? kBehindAll : scratch.found.cut_at(s);
        return resume_[s] == kBehindAll;
    };
    which.erase(std::remove_if(which.begin(), which.end(), is_done), which.end());
}

/// Passes for a group of samples at a time, until none sees anything more. Samples that are done make place
/// for others. Where lists are walked to their ends groups become as small as lists are long.
void LayerPasses::find_rest(const LayerTask& task, const SampleTile& samples, SampleScratch& scratch,
                            SampleStats& stats) {
    const size_t half = task.limits.room / 2;  // the other half is for what is found too far behind
    size_t group_size = std::min(half, std::max(kLeastGroup, half / kLayersAtOnce));
    group_.clear(), put_off_.clear();
    const auto take_in = [this](uint32_t sample) {
        group_.push_back(sample);
        behind_[sample] = resume_[sample];
    };
    for (uint32_t next = 0;;) {
        for (; !put_off_.empty() && group_.size() < group_size; put_off_.pop_back()) take_in(put_off_.back());
        for (; next < samples.size() && group_.size() < group_size; ++next)
            if (resume_[next] != kBehindAll) take_in(next);
        std::sort(group_.begin(), group_.end());
        if (group_.empty()) return;
        const auto most = static_cast<uint32_t>(std::min<size_t>(task.limits.most, half / group_.size()));
        scratch.window = {behind_, most, task.limits.room};
        find(task, samples, scratch, stats);
        ++costs_.further_passes;
        Stopwatch watch;
        add_to_stack(task, samples, scratch, group_);
        costs_.composite_seconds += watch.lap();
        if (group_.empty() || !task.visibility.walks_whole_lists()) continue;
        group_size = std::max<size_t>(1, group_size / 2);
        for (; group_.size() > group_size; group_.pop_back()) {
            put_off_.push_back(group_.back());
            behind_[group_.back()] = kBehindAll;
        }
    }
}

}  // namespace trapeze
