/// Pixar's stochastic rasterizer as [Hou10 sec. 5] rebuilt it, INTERVAL: the samples of a pixel are slots,
/// each with a region of the shutter and of the lens; a micropolygon has a box on the raster for each slot,
/// and is tested against the samples of that slot in the box. The samples of a slot lie side by side, so that
/// vector lanes are pixels.
///
/// pairing=fixed is the paper's form, where all pixels pair times with lens points alike. pairing=shuffled is
/// that of production renderers: pixels pair them in different ways, and there is a box for each region of
/// the lens and each part of the shutter.
///
/// No occlusion culling, as in the paper; cull=on goes through grids front to back and leaves out what lies
/// behind the hits found. What is still and seen through a pinhole has one box for all slots.
#include <algorithm>
#include <optional>

#include "sample/interval/interval_scratch.h"
#include "sample/interval/slot_plan.h"
#include "sample/interval/slot_raster.h"
#include "sample/rasterize/rasterizer.h"

namespace trapeze {
namespace {

/// Side of a tile, in pixels. Both plans are made once, for the pattern, and serve every tile.
constexpr int kIntervalTileSide = 64;

/// How many parts of the shutter have boxes of their own when pairing is shuffled. More parts have smaller
/// boxes but fewer samples in each, scattered among the pixels, and more boxes to set up: 4 were fastest of 1
/// to 64 at 60 pixels of motion, 20 of blur.
constexpr int kShuffledTimeSlots = 4;

/// Binary logarithm of a cell's side in pixels: cells of 4 x 4 pixels, one block of each slot.
constexpr int kSlotCellShift = 2;

/// Binary logarithm of a cell's side where only one of kShuffledTimeSlots pixels has its time in a slot: a
/// cell then has as many pixels as fill a block.
constexpr int kSparseCellShift = 3;

/// What can blur and what cannot is resolved in two passes over the tile's samples, sorted into different
/// slots; the hits of both are merged by depth.
class IntervalRasterizer final : public Rasterizer {
  public:
    explicit IntervalRasterizer(const VisibilityInput& input) : Rasterizer(input, kIntervalTileSide) {
        if (input.spec["pairing"] == "fixed") {
            const IntervalPattern pattern(input.context);
            still_plan_ = still_plan(pattern.sample_count());
            plan_ = fixed_plan(pattern);
        } else {
            shuffled_.emplace(input.context);
            still_plan_ = still_plan(shuffled_->sample_count());
            plan_ = shuffled_plan(*shuffled_, std::min(kShuffledTimeSlots, shuffled_->sample_count()));
        }
    }

  private:
    void raster(const SampleTile& samples, const std::vector<uint32_t>& grids, SampleScratch& scratch,
                SampleStats& stats) const override {
        IntervalScratch& own = scratch.own.of<IntervalScratch>();
        std::vector<uint32_t>&still = own.still, &blurred = own.blurred;
        still.clear();
        blurred.clear();
        for (const uint32_t index : grids) {
            // What neither moves nor can be out of focus has one box for all slots.
            const bool blurs = camera().has_lens() || (context().motion && grid(index).moves());
            (blurs ? blurred : still).push_back(index);
        }
        resolve_still(samples, own, scratch, stats);
        resolve_blurred(samples, own, scratch, stats);
    }

    void resolve_still(const SampleTile& samples, IntervalScratch& own, SampleScratch& scratch,
                       SampleStats& stats) const {
        if (own.still.empty()) return;
        // A block has the samples of one pixel, or of as few as fill it.
        const int cell_shift = samples.samples_per_pixel > 4 ? 0 : samples.samples_per_pixel > 1 ? 1 : 2;
        own.slots.build(samples, still_plan_.table({}), cell_shift, false);
        raster_slots(samples, still_plan_, own.still, false, own, scratch, stats);
    }

    void resolve_blurred(const SampleTile& samples, IntervalScratch& own, SampleScratch& scratch,
                         SampleStats& stats) const {
        if (own.blurred.empty()) return;
        std::vector<uint32_t>& keys = own.key_of_pixel;
        keys.clear();
        const bool shifted = shuffled_ && shuffled_->has_time_shifts();
        if (shifted)
            for (int y = samples.pixels.y0; y < samples.pixels.y1; ++y)
                for (int x = samples.pixels.x0; x < samples.pixels.x1; ++x)
                    keys.push_back(shuffled_->time_shift(x, y));
        const int cell_shift = shifted ? kSparseCellShift : kSlotCellShift;
        own.slots.build(samples, plan_.table(keys), cell_shift, shifted);
        raster_slots(samples, plan_, own.blurred, shifted, own, scratch, stats);
    }

    /// Slot by slot, and in each grid by grid: a slot's samples lie together in memory, and are gone through
    /// while they are in the caches.
    void raster_slots(const SampleTile& samples, const SlotPlan& plan, const std::vector<uint32_t>& grids,
                      bool sparse, IntervalScratch& own, SampleScratch& scratch, SampleStats& stats) const {
        SampleSlots& slots = own.slots;
        SlotRaster slot_raster{camera(), slots,  samples.pixels.x0, samples.pixels.y0, all_opaque(), cull(),
                               sparse,   scratch};
        for (size_t slot = 0; slot < plan.slots.size(); ++slot) {
            if (slots.is_empty(slot)) continue;
            for (const uint32_t index : grids)
                raster_grid_in_slot(slot_raster, own, samples.pixels, index, plan.slots[slot], slot, stats);
        }
        slots.merge_into(scratch.nearest);
    }

    /// A grid that is out of the tile during the slot's times and through its part of the lens costs its
    /// bound and no more.
    void raster_grid_in_slot(SlotRaster& raster, IntervalScratch& own, const PixelRect& tile, uint32_t index,
                             const Slot& at, size_t slot, SampleStats& stats) const {
        const Grid& seen = grid(index);
        std::vector<SegmentPart>& parts = own.parts;
        parts.clear();
        segment_parts(at.time, seen.key_count, parts);
        const SlotBound bound = bounds().slot_bound(index, parts, at.lens);
        PixelRect pixels = pixels_within(bound.box, tile);
        if (pixels.empty()) return;
        pixels.x0 -= tile.x0, pixels.x1 -= tile.x0, pixels.y0 -= tile.y0, pixels.y1 -= tile.y0;
        raster_grid(raster, {seen, index, bounds()[index], slot, parts, at.lens, pixels, bound.z_min},
                    own.grid, stats);
    }

    std::optional<StratifiedPattern> shuffled_;  ///< pairing=shuffled
    SlotPlan still_plan_, plan_;
};

std::string natural_pattern(const MethodSpec& method) {
    return method["pairing"] == "fixed" ? "interval" : "stratified";
}

}  // namespace

VisibilityMethod interval_method() {
    return {"interval",
            MethodKind::Rasterizer,
            {{"pairing", {"fixed", "shuffled"}}, {"cull", {"off", "on"}}},
            natural_pattern,
            [](const MethodSpec& method, const MethodSpec& pattern) {
                return pattern.name == natural_pattern(method);
            },
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<IntervalRasterizer>(input);
            }};
}

}  // namespace trapeze
