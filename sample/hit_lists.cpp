#include "sample/hit_lists.h"

#include <algorithm>

namespace trapeze {

/// Asked once when a method is prepared. The answer chooses between two forms of resolve(): the nearest hit
/// alone, or lists.
bool every_grid_is_opaque(const Grids& grids) {
    return std::all_of(grids.grids.begin(), grids.grids.end(), [](const Grid& grid) { return grid.opaque; });
}

/// Samples without a hit get an empty range, so that `first` always has an entry for each sample and one for
/// the end.
void buffer_of_nearest(const SampleScratch& scratch, size_t sample_count, HitBuffer& hits) {
    hits.hits.clear();
    hits.first.resize(sample_count + 1);
    for (size_t sample = 0; sample < sample_count; ++sample) {
        hits.first[sample] = static_cast<uint32_t>(hits.hits.size());
        if (scratch.nearest[sample].id != MicropolygonId::kNone) hits.hits.push_back(scratch.nearest[sample]);
    }
    hits.first[sample_count] = static_cast<uint32_t>(hits.hits.size());
}

namespace {

/// Leaves of each sorted list as many hits as are wanted, and says where lists end. In place: lists only move
/// towards the front. Where a list was cut, the next pass asks for what is behind its last hit.
void cut_lists(SampleScratch& scratch, size_t sample_count, HitBuffer& hits) {
    LooseHits& found = scratch.found;
    const uint32_t most = found.window().most;
    if (most == kAllLayers && !found.is_cut()) return;
    uint32_t kept = 0;
    for (size_t sample = 0; sample < sample_count; ++sample) {
        const uint32_t begin = hits.first[sample], count = hits.first[sample + 1] - begin,
                       wanted = std::min(count, most);
        hits.first[sample] = kept;
        // Past an opaque hit there is nothing.
        if (count > 0 && hits.hits[begin + count - 1] == scratch.nearest[sample]) found.close(sample);
        if (count > wanted) found.cut(static_cast<uint32_t>(sample), hits.hits[begin + wanted - 1]);
        std::copy_n(hits.hits.begin() + begin, wanted, hits.hits.begin() + kept);
        kept += wanted;
    }
    hits.first[sample_count] = kept;
    hits.hits.resize(kept);
}

}  // namespace

/// A counting sort by sample, leaving out what an opaque hit hides; then each sample's list by depth. Lists
/// of a sample are short, so that sorting each costs less than one sort of all by sample and depth.
void buffer_of_loose_hits(SampleScratch& scratch, size_t sample_count, HitBuffer& hits) {
    const std::span<const LooseHits::Entry> found = scratch.found.entries();
    const auto visible = [&](const LooseHits::Entry& entry) {
        return !in_front(scratch.nearest[entry.sample], entry.hit());
    };
    hits.first.assign(sample_count + 1, 0);
    for (const LooseHits::Entry& entry : found)
        if (visible(entry)) ++hits.first[entry.sample + 1];
    for (size_t sample = 0; sample < sample_count; ++sample) hits.first[sample + 1] += hits.first[sample];
    hits.hits.resize(hits.first[sample_count]);
    scratch.next.assign(hits.first.begin(), hits.first.end());
    for (const LooseHits::Entry& entry : found)
        if (visible(entry)) hits.hits[scratch.next[entry.sample]++] = entry.hit();
    for (size_t sample = 0; sample < sample_count; ++sample)
        std::sort(hits.hits.begin() + hits.first[sample], hits.hits.begin() + hits.first[sample + 1],
                  in_front);
    cut_lists(scratch, sample_count, hits);
}

/// Lists that are cut may still be enough, where the caller wants no more layers than they hold.
bool holds_all(const SampleScratch& scratch, const HitBuffer& hits, uint32_t most) {
    if (!scratch.found.is_cut()) return true;
    for (size_t s = 0; s < hits.size(); ++s)
        if (scratch.found.cut_at(s) != kBehindAll && hits.of(s).size() < most) return false;
    return true;
}

}  // namespace trapeze
