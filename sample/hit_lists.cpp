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

}  // namespace trapeze
