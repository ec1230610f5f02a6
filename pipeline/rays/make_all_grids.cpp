#include "pipeline/rays/make_all_grids.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace trapeze {
namespace {

constexpr size_t kGrain = 16;  // subpatches
/// Of memory that a thread takes at a time.
constexpr size_t kMostChunk = size_t{1} << 20;

SubpatchExtent known_of(size_t subpatch, const Grid& grid) {
    return {static_cast<uint32_t>(subpatch), static_cast<uint32_t>(grid.bytes()), extent_of(grid)};
}

template <class Do>
void for_each(size_t count, const RenderContext& context, const Do& act) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, kGrain), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end() && !context.is_cancelled(); ++i) act(i);
    });
}

}  // namespace

AllRayGrids make_all_grids(const RayDicer& dicer, size_t most_bytes) {
    const size_t count = dicer.tessellation().subpatches().size();
    AllRayGrids all;
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
