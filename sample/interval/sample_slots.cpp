#include "sample/interval/sample_slots.h"

#include <algorithm>
#include <limits>

namespace trapeze {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr uint32_t kLanes = SampleBlock::kLanes;

}  // namespace

/// Cells are squares of 2^cell_shift pixels, numbered row by row, with one more for the block that keeps
/// slots apart.
void SampleSlots::build(const SampleTile& samples, const SlotTable& table, int cell_shift, bool places) {
    const auto cells_along = [cell_shift](int pixels) {
        return (pixels + (1 << cell_shift) - 1) >> cell_shift;
    };
    cell_shift_ = cell_shift;
    width_ = samples.pixels.width(), height_ = samples.pixels.height();
    cells_x_ = cells_along(width_);
    cell_count_ = static_cast<size_t>(cells_x_) * cells_along(height_) + 1;
    count_blocks(samples, table);
    fill_blocks(samples, table, places);
    fill_rest();
}

/// Calls visit(sample, x, y, index of its slot's cell) for all, cell by cell.
template <class Visit>
void SampleSlots::for_each_sample(const SampleTile& samples, const SlotTable& table, Visit&& visit) const {
    const auto per_pixel = static_cast<size_t>(samples.samples_per_pixel);
    const auto visit_pixel = [&](int x, int y, size_t cell) {
        const size_t pixel = static_cast<size_t>(y) * width_ + x;
        const uint32_t key = table.key_of_pixel.empty() ? 0 : table.key_of_pixel[pixel];
        const uint32_t* slot_of = table.slot_of.data() + key * per_pixel;
        for (size_t s = 0; s < per_pixel; ++s)
            visit(static_cast<uint32_t>(pixel * per_pixel + s), x, y, slot_of[s] * cell_count_ + cell);
    };
    const int side = 1 << cell_shift_;
    size_t cell = 0;
    for (int cell_y = 0; cell_y < height_; cell_y += side)
        for (int cell_x = 0; cell_x < width_; cell_x += side, ++cell)
            for (int y = cell_y; y < std::min(cell_y + side, height_); ++y)
                for (int x = cell_x; x < std::min(cell_x + side, width_); ++x) visit_pixel(x, y, cell);
}

/// Counts samples by slot and cell and gives each cell its blocks; next_lane_ then tells where its samples
/// go.
void SampleSlots::count_blocks(const SampleTile& samples, const SlotTable& table) {
    next_lane_.assign(table.slot_count * cell_count_, 0);
    for_each_sample(samples, table, [&](uint32_t, int, int, size_t at) { ++next_lane_[at]; });
    first_block_.resize(next_lane_.size() + 1);
    lane_counts_.clear();
    for (size_t at = 0; at < next_lane_.size(); ++at) {
        first_block_[at] = static_cast<uint32_t>(lane_counts_.size());
        for (uint32_t left = next_lane_[at]; left > 0; left -= std::min(left, kLanes))
            lane_counts_.push_back(static_cast<uint8_t>(std::min(left, kLanes)));
        // A block apart, lest equal cells of all slots fall on the same lines of a cache.
        if (at % cell_count_ == cell_count_ - 1) lane_counts_.push_back(0);
        next_lane_[at] = first_block_[at] * kLanes;
    }
    first_block_.back() = static_cast<uint32_t>(lane_counts_.size());
}

/// Copies rays to their lanes. The order of samples in a cell is that of the tile. Second pass of a counting
/// sort: each slot's cell knows where its next lane is.
void SampleSlots::fill_blocks(const SampleTile& samples, const SlotTable& table, bool places) {
    blocks_.resize(lane_counts_.size());
    samples_.resize(lane_counts_.size() * kLanes);
    places_.assign(places ? lane_counts_.size() : 0, BlockPlaces{});
    for (BlockPlaces& place : places_) std::fill_n(place.x, kLanes, -1), std::fill_n(place.y, kLanes, -1);
    for_each_sample(samples, table, [&](uint32_t sample, int x, int y, size_t at) {
        const uint32_t to = next_lane_[at]++, lane = to % kLanes;
        SampleBlock& block = blocks_[to / kLanes];
        const AxisRay& ray = samples.rays[sample];
        block.ox[lane] = ray.ox, block.oy[lane] = ray.oy, block.ux[lane] = ray.ux, block.uy[lane] = ray.uy;
        block.time[lane] = ray.time;
        samples_[to] = sample;
        if (places) places_[to / kLanes].x[lane] = x, places_[to / kLanes].y[lane] = y;
    });
}

/// Hits, and lanes without samples.
void SampleSlots::fill_rest() {
    for (size_t i = 0; i < blocks_.size(); ++i) {
        SampleBlock& block = blocks_[i];
        std::fill_n(block.depth, kLanes, kInfinite);
        std::fill_n(block.grid, kLanes, ~uint32_t{0});
        std::fill_n(block.micropolygon, kLanes, ~uint32_t{0});
        for (size_t lane = lane_counts_[i]; lane < kLanes; ++lane) {
            block.ox[lane] = block.oy[lane] = block.ux[lane] = block.uy[lane] = block.time[lane] = 0;
            block.depth[lane] = -kInfinite;
        }
    }
}

/// A sample is in one slot only, but `nearest` may hold what another pass has found for it.
void SampleSlots::merge_into(std::vector<Hit>& nearest) const {
    // Cell by cell: what all slots have of some pixels goes to one place.
    for (size_t cell = 0; cell + 1 < cell_count_; ++cell)
        for (size_t at = cell; at < next_lane_.size(); at += cell_count_)
            for (size_t i = first_block_[at]; i < first_block_[at + 1]; ++i) merge_block(i, nearest);
}

/// The nearer of a lane's hit and what the sample has already. A grid's number and a micropolygon's make the
/// packed id (MicropolygonId).
void SampleSlots::merge_block(size_t index, std::vector<Hit>& nearest) const {
    const SampleBlock& block = blocks_[index];
    for (size_t lane = 0; lane < lane_counts_[index]; ++lane) {
        if (block.depth[lane] == kInfinite) continue;
        const Hit hit{block.depth[lane], uint64_t{block.grid[lane]} << 8 | block.micropolygon[lane]};
        Hit& best = nearest[sample(index, lane)];
        if (in_front(hit, best)) best = hit;
    }
}

}  // namespace trapeze
