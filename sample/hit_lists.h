/// The hit buffer, made from what methods find in whatever order.
#pragma once

#include "core/hit_buffer.h"
#include "sample/visibility.h"

namespace trapeze {

/// Then one hit a sample is all there is to find.
bool every_grid_is_opaque(const Grids& grids);

/// One hit a sample at most: scratch.nearest, where kNone is no hit.
void buffer_of_nearest(const SampleScratch& scratch, size_t sample_count, HitBuffer& hits);

/// Hits in any order, scratch.found: sorted, cut at the nearest opaque one, scratch.nearest[sample], and at
/// as many as the window wants. scratch.found then says which lists do not go to the end.
void buffer_of_loose_hits(SampleScratch& scratch, size_t sample_count, HitBuffer& hits);

/// Whether the lists hold all that samples see of the nearest `most` layers.
bool holds_all(const SampleScratch& scratch, const HitBuffer& hits, uint32_t most);

}  // namespace trapeze
