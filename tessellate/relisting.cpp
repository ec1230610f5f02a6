#include "tessellate/relisting.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace trapeze {
namespace {

/// A block ends at so many subpatches, or faces. Small ones are soon made again; each has a place to be kept.
constexpr uint32_t kSubpatchesOfBlock = 128, kFacesOfBlock = 512;
constexpr size_t kCountedPerTask = 64, kCountedAtOnce = 4096;  // faces
/// The least that a subpatch takes: what is too much by this is never listed as a whole.
constexpr size_t kBytesOfSubpatch = sizeof(Subpatch);

}  // namespace

/// What has as few subpatches as fit goes to the block before, where that has whole faces, too.
void Relisting::add(const FaceParts::Part& found) {
    Block* const last = blocks_.empty() ? nullptr : &blocks_.back();
    const auto face = static_cast<uint32_t>(found.part.face);
    const bool joins = last && last->part.depth == 0 && found.part.depth == 0 &&
                       face - static_cast<uint32_t>(last->part.face) < kFacesOfBlock &&
                       subpatches_ - last->first_subpatch + found.subpatches <= kSubpatchesOfBlock;
    if (joins)
        last->faces = face - static_cast<uint32_t>(last->part.face) + 1;
    else
        blocks_.push_back({found.part, 1, subpatches_});
    subpatches_ += found.subpatches;
}

bool Relisting::count(const RenderContext& render, size_t most_bytes) {
    const auto faces = static_cast<size_t>(context_.surface->surface().face_count());
    const size_t grain = faces < 4 * kCountedPerTask ? 1 : kCountedPerTask;
    std::vector<FaceParts> found;
    size_t largest = 0;
    for (size_t first = 0; first < faces && !render.is_cancelled(); first += kCountedAtOnce) {
        found.assign(std::min(kCountedAtOnce, faces - first), {});
        tbb::parallel_for(tbb::blocked_range<size_t>(0, found.size(), grain), [&](const auto& range) {
            find_parts(context_, static_cast<int>(first + range.begin()), kSubpatchesOfBlock,
                       std::span(found).subspan(range.begin(), range.size()));
        });
        for (const FaceParts& face : found) {
            for (const FaceParts::Part& part : face.parts) {
                add(part);
                largest = std::max(largest, size_t{part.subpatches});
            }
            micropolygons_ += face.micropolygons, culled_ += face.culled;
            limited_ |= face.limited;
        }
    }
    blocks_.shrink_to_fit();
    return largest <= kSubpatchesOfBlock || largest * kBytesOfSubpatch <= most_bytes;
}

Relisting::Place Relisting::place_of(uint32_t subpatch) const {
    const auto behind = std::ranges::upper_bound(blocks_, subpatch, {}, &Block::first_subpatch);
    const auto block = static_cast<size_t>(behind - blocks_.begin()) - 1;
    return {block, subpatch - blocks_[block].first_subpatch};
}

Splits Relisting::list(size_t number) const {
    const Block& block = blocks_[number];
    Splits splits = block.part.depth > 0 ? split_part(context_, block.part)
                                         : split_faces(context_, block.part.face,
                                                       block.part.face + static_cast<int>(block.faces));
    splits.bounds = {};
    splits.subpatches.shrink_to_fit(), splits.made_lines.shrink_to_fit(), splits.made.shrink_to_fit();
    return splits;
}

}  // namespace trapeze
