/// A tile's samples sorted for rasterizing: by slots, within which all look through one part of the lens in
/// one part of the shutter, and by place within a slot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/hit_buffer.h"
#include "core/samples.h"
#include "sample/patterns/strata.h"

namespace trapeze {

/// Rays of some samples that are close to each other, and the nearest opaque hit of each. Lanes that are no
/// samples come last; they have depth -infinity.
struct alignas(64) SampleBlock {
    static constexpr int kLanes = 16;

    float ox[kLanes], oy[kLanes], ux[kLanes], uy[kLanes], time[kLanes];
    float depth[kLanes];
    uint32_t grid[kLanes], micropolygon[kLanes];  ///< halves of the id: MicropolygonId
};

/// The pixels of a block's lanes, from the tile's corner; -1 where there is no sample.
struct alignas(64) BlockPlaces {
    int32_t x[SampleBlock::kLanes], y[SampleBlock::kLanes];
};

/// Which slot each sample of a tile goes to.
struct SlotTable {
    std::span<const uint32_t> key_of_pixel;  ///< in the order of the tile's samples; empty: 0 for all
    std::span<const uint32_t> slot_of;       ///< [key * samples per pixel + sample]
    size_t slot_count = 0;
};

/// Cells are squares of 2^cell_shift pixels anchored at the tile's corner. Blocks lie slot by slot, and
/// within a slot cell by cell: [slot][cell][block], which is the order in which a grid's micropolygons go
/// through them.
class SampleSlots {
  public:
    /// Sorts a tile's samples into slots and cells; no hits yet. `places`: whether places of lanes are kept.
    /// Memory is reused.
    void build(const SampleTile& samples, const SlotTable& table, int cell_shift, bool places);

    int cell_shift() const { return cell_shift_; }
    int cells_x() const { return cells_x_; }
    int width() const { return width_; }
    int height() const { return height_; }

    /// The blocks of a slot's cell c are cells[c] .. cells[c + 1]. Blocks of cells side by side follow.
    const uint32_t* cells(size_t slot) const { return first_block_.data() + slot * cell_count_; }
    /// A slot's cells hold where the blocks of each begin, so one without blocks ends where it begins.
    bool is_empty(size_t slot) const { return cells(slot)[0] == cells(slot)[cell_count_ - 1]; }

    /// Changed by rasterizing: the nearest hit of each lane so far is in it.
    SampleBlock& block(size_t index) { return blocks_[index]; }
    const BlockPlaces& places(size_t index) const { return places_[index]; }
    /// Index in the tile of a lane's sample.
    uint32_t sample(size_t index, size_t lane) const { return samples_[index * SampleBlock::kLanes + lane]; }
    int lane_count(size_t index) const { return lane_counts_[index]; }

    /// Replaces hits of samples, by index, that are behind those found here.
    void merge_into(std::vector<Hit>& nearest) const;

  private:
    /// First of two passes over the samples: how many each cell has, so that places can be taken without a
    /// search.
    void count_blocks(const SampleTile& samples, const SlotTable& table);
    void fill_blocks(const SampleTile& samples, const SlotTable& table, bool places);
    /// Lanes of a block that no sample takes are filled so that nothing is hit there.
    void fill_rest();
    void merge_block(size_t index, std::vector<Hit>& nearest) const;
    template <class Visit>
    void for_each_sample(const SampleTile& samples, const SlotTable& table, Visit&& visit) const;

    int cell_shift_ = 0, cells_x_ = 0, width_ = 0, height_ = 0;
    size_t cell_count_ = 0;              ///< and one past, that takes no samples
    std::vector<uint32_t> first_block_;  ///< [slot * cell_count_ + cell], and the end
    std::vector<uint32_t> next_lane_;    ///< [slot * cell_count_ + cell]
    std::vector<SampleBlock> blocks_;
    std::vector<uint32_t> samples_;  ///< [block * kLanes + lane]
    std::vector<BlockPlaces> places_;
    std::vector<uint8_t> lane_counts_;
};

}  // namespace trapeze
