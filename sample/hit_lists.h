/// The hit buffer, made from what methods find in whatever order.
#pragma once

#include "core/hit_buffer.h"
#include "sample/visibility.h"

namespace trapeze {

/// Then one hit a sample is all there is to find.
bool every_grid_is_opaque(const Grids& grids);

/// One hit a sample at most: scratch.nearest, where kNone is no hit.
void buffer_of_nearest(const SampleScratch& scratch, size_t sample_count, HitBuffer& hits);

/// Lists in scratch.hits, of scratch.count[sample] hits from scratch.first[sample], sorted and cut.
void buffer_of_lists(const SampleScratch& scratch, size_t sample_count, HitBuffer& hits);

/// Hits in any order, scratch.hits[i] of sample scratch.hit_sample[i]: sorted, and cut at the nearest opaque
/// one, scratch.nearest[sample].
void buffer_of_loose_hits(SampleScratch& scratch, size_t sample_count, HitBuffer& hits);

}  // namespace trapeze
