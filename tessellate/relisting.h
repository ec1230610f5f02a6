/// Lists of a primitive's subpatches that are made again when they are asked for, where all lists together
/// take more memory than there is. What rays of shaders meet is listed so; the camera's regions are planned
/// from whole lists.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/render_context.h"
#include "tessellate/split.h"

namespace trapeze {

/// How one primitive is split, so that any of its faces can be split again with the same result, and how many
/// subpatches they have. What the context points to outlives this, but for its measure.
class Relisting {
  public:
    /// Splits do not depend on estimates of faces (FaceEstimate), which are not kept.
    explicit Relisting(const SplitContext& context) : measure_(*context.measure), context_(context) {
        context_.measure = &measure_, context_.estimates = {};
    }
    Relisting(const Relisting&) = delete;
    Relisting& operator=(const Relisting&) = delete;

    /// Splits all faces, in parallel, and keeps how many subpatches there are. False where some block takes
    /// more than `most_bytes` to list; nothing may be asked then. Stops where the render is cancelled.
    bool count(const RenderContext& render, size_t most_bytes);

    uint32_t subpatch_count() const { return subpatches_; }
    uint64_t micropolygon_count() const { return micropolygons_; }
    uint64_t culled_count() const { return culled_; }
    bool is_limited() const { return limited_; }  ///< Splits::limited

    size_t block_count() const { return blocks_.size(); }
    /// The block of a subpatch, below subpatch_count(), and where in its list that is.
    struct Place {
        size_t block, at;
    };
    Place place_of(uint32_t subpatch) const;
    /// Splits what a block holds.
    Splits list(size_t block) const;

    size_t bytes() const { return sizeof(*this) + blocks_.capacity() * sizeof(Block); }

  private:
    /// A few faces in a row, or a part of one, with lists of their own.
    struct Block {
        FacePart part;  ///< of the first face; of more than one they are whole
        uint32_t faces, first_subpatch;
    };
    void add(const FaceParts::Part& found);

    LineMeasure measure_;
    SplitContext context_;
    std::vector<Block> blocks_;
    uint32_t subpatches_ = 0;
    uint64_t micropolygons_ = 0, culled_ = 0;
    bool limited_ = false;
};

}  // namespace trapeze
