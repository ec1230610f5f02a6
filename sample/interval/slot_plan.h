/// How a pattern's samples go into slots whose bounds in time and on the lens are known beforehand.
#pragma once

#include <cstdint>
#include <vector>

#include "sample/interval/sample_slots.h"
#include "sample/patterns/interval_pattern.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {

/// What holds for all samples in a slot.
struct Slot {
    TimeSpan time;
    LensBox lens;
};

/// The slots of a pattern, made once; `slot_of` then sends the samples of any tile to them.
struct SlotPlan {
    std::vector<Slot> slots;
    std::vector<uint32_t> slot_of;  ///< [key of the pixel * samples per pixel + sample]

    SlotTable table(const std::vector<uint32_t>& key_of_pixel) const {
        return {key_of_pixel, slot_of, slots.size()};
    }
};

/// One slot for all: for what looks the same at any time through any part of the lens.
SlotPlan still_plan(int samples_per_pixel);

/// A slot for each sample of a pixel; pixels have no keys.
SlotPlan fixed_plan(const IntervalPattern& pattern);

/// A slot for each sample of a pixel, which is each region of the lens, and each of `time_slots` parts of the
/// shutter; the key of a pixel is its time shift. One part when times are the same in all pixels.
SlotPlan shuffled_plan(const StratifiedPattern& pattern, int time_slots);

}  // namespace trapeze
