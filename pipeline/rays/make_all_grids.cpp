#include "pipeline/rays/make_all_grids.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace trapeze {
namespace {

constexpr size_t kGrain = 16;  // subpatches
/// Subpatches that are known together where lists are short of memory.
constexpr size_t kRun = 4;
/// Of memory that a thread takes at a time.
constexpr size_t kMostChunk = size_t{1} << 20;

RunExtent known_of(size_t subpatch, const Grid& grid) {
    return {{static_cast<uint32_t>(subpatch), 1}, static_cast<uint32_t>(grid.bytes()), extent_of(grid)};
}

template <class Do>
void for_each(size_t count, const RenderContext& context, const Do& act) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, kGrain), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end() && !context.is_cancelled(); ++i) act(i);
    });
}

/// Subpatches of each primitive, a few in a row.
std::vector<SubpatchRun> runs_of(const Tessellation& tessellation) {
    std::vector<SubpatchRun> runs;
    for (size_t i = 0; i < tessellation.subpatch_count();) {
        const size_t end = tessellation.end_of_primitive(i);
        for (; i < end; i += kRun)
            runs.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(std::min(kRun, end - i))});
        i = end;
    }
    return runs;
}

/// Where lists of subpatches do not fit, what is known of each would not either.
std::vector<RunExtent> find_extents_of_runs(const RayDicer& dicer) {
    const std::vector<SubpatchRun> runs = runs_of(dicer.tessellation());
    std::vector<RunExtent> extents(runs.size());
    for_each(runs.size(), dicer.context(), [&](size_t r) {
        for (size_t i = runs[r].first; i < runs[r].first + runs[r].count; ++i) {
            GridArena passing(1);
            const RunExtent one = known_of(i, dicer.make(i, passing));
            if (i == runs[r].first)
                extents[r] = one;
            else
                extents[r].extent = united(extents[r].extent, one.extent), extents[r].bytes += one.bytes;
        }
        extents[r].run = runs[r];
    });
    return extents;
}

}  // namespace

AllRayGrids make_all_grids(const RayDicer& dicer, size_t most_bytes) {
    const size_t count = dicer.tessellation().subpatch_count();
    AllRayGrids all;
    if (dicer.tessellation().makes_lists_again()) {
        all.are_kept = false, all.extents = find_extents_of_runs(dicer);
        return all;
    }
    all.grids.resize(count), all.extents.resize(count);
    tbb::enumerable_thread_specific<GridArena> arenas(
        [&] { return GridArena(std::clamp(most_bytes / 32, size_t{1}, kMostChunk)); });
    std::atomic<size_t> bytes{0};
    std::atomic<bool> too_much{false};
    for_each(count, dicer.context(), [&](size_t i) {
        if (too_much.load(std::memory_order_relaxed)) {
            GridArena passing(1);
            all.extents[i] = known_of(i, dicer.make(i, passing));
            return;
        }
        all.grids[i] = dicer.make(i, arenas.local());
        if (bytes.fetch_add(all.grids[i].bytes()) + all.grids[i].bytes() > most_bytes) too_much.store(true);
    });
    if (too_much) {
        for_each(count, dicer.context(), [&](size_t i) {
            if (all.grids[i].positions) all.extents[i] = known_of(i, all.grids[i]);
        });
        all.are_kept = false;
        all.grids = {};
        return all;
    }
    all.extents = {};
    for (GridArena& arena : arenas) all.arenas.push_back(std::move(arena));
    return all;
}

}  // namespace trapeze
