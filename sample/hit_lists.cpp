#include "sample/hit_lists.h"

#include <algorithm>

namespace trapeze {

bool every_grid_is_opaque(const Grids& grids) {
    return std::all_of(grids.grids.begin(), grids.grids.end(), [](const Grid& grid) { return grid.opaque; });
}

void buffer_of_nearest(const SampleScratch& scratch, size_t sample_count, HitBuffer& hits) {
    hits.hits.clear();
    hits.first.resize(sample_count + 1);
    for (size_t sample = 0; sample < sample_count; ++sample) {
        hits.first[sample] = static_cast<uint32_t>(hits.hits.size());
        if (scratch.nearest[sample].id != MicropolygonId::kNone) hits.hits.push_back(scratch.nearest[sample]);
    }
    hits.first[sample_count] = static_cast<uint32_t>(hits.hits.size());
}

void buffer_of_lists(const SampleScratch& scratch, size_t sample_count, HitBuffer& hits) {
    hits.hits.clear();
    hits.first.resize(sample_count + 1);
    for (size_t sample = 0; sample < sample_count; ++sample) {
        hits.first[sample] = static_cast<uint32_t>(hits.hits.size());
        const auto list = scratch.hits.begin() + scratch.first[sample];
        hits.hits.insert(hits.hits.end(), list, list + scratch.count[sample]);
    }
    hits.first[sample_count] = static_cast<uint32_t>(hits.hits.size());
}

/// A counting sort by sample, leaving out what an opaque hit hides; then each sample's list by depth.
void buffer_of_loose_hits(SampleScratch& scratch, size_t sample_count, HitBuffer& hits) {
    const auto visible = [&](size_t i) {
        return !in_front(scratch.nearest[scratch.hit_sample[i]], scratch.hits[i]);
    };
    hits.first.assign(sample_count + 1, 0);
    for (size_t i = 0; i < scratch.hits.size(); ++i)
        if (visible(i)) ++hits.first[scratch.hit_sample[i] + 1];
    for (size_t sample = 0; sample < sample_count; ++sample) hits.first[sample + 1] += hits.first[sample];
    hits.hits.resize(hits.first[sample_count]);
    scratch.first.assign(hits.first.begin(), hits.first.end());
    for (size_t i = 0; i < scratch.hits.size(); ++i)
        if (visible(i)) hits.hits[scratch.first[scratch.hit_sample[i]]++] = scratch.hits[i];
    for (size_t sample = 0; sample < sample_count; ++sample)
        std::sort(hits.hits.begin() + hits.first[sample], hits.hits.begin() + hits.first[sample + 1],
                  in_front);
}

}  // namespace trapeze
