#include "sample/interval/slot_plan.h"

#include <algorithm>

namespace trapeze {

/// The slot's default times and lens are points at 0: for what does not blur any are as good.
SlotPlan still_plan(int samples_per_pixel) {
    return {{Slot{}}, std::vector<uint32_t>(static_cast<size_t>(samples_per_pixel), 0)};
}

/// Sample s of every pixel has the same regions (IntervalPattern), so that its slot is s and no pixel needs a
/// key.
SlotPlan fixed_plan(const IntervalPattern& pattern) {
    SlotPlan plan;
    for (int s = 0; s < pattern.sample_count(); ++s) {
        plan.slots.push_back({pattern.time_bounds(s), pattern.lens_bounds(s)});
        plan.slot_of.push_back(static_cast<uint32_t>(s));
    }
    return plan;
}

/// Slots are numbered [part of the shutter][sample, which is a region of the lens]. Which time region a
/// sample has depends on its pixel's shift, the key: every key has a row of slot_of, and each slot's span of
/// time grows to hold all samples that any key sends to it.
SlotPlan shuffled_plan(const StratifiedPattern& pattern, int time_slots) {
    const auto count = static_cast<uint32_t>(pattern.sample_count());
    const uint32_t keys = pattern.has_time_shifts() ? count : 1;
    const uint32_t parts = pattern.has_time_shifts() ? static_cast<uint32_t>(time_slots) : 1;
    SlotPlan plan;
    // Spans of time grow as samples are assigned.
    constexpr TimeSpan kNever{2, -1};
    for (uint32_t part = 0; part < parts; ++part)
        for (uint32_t s = 0; s < count; ++s)
            plan.slots.push_back({kNever, pattern.lens_bounds(static_cast<int>(s))});
    for (uint32_t key = 0; key < keys; ++key)
        for (uint32_t s = 0; s < count; ++s) {
            const TimeSpan time = pattern.time_bounds(static_cast<int>(s), key);
            const uint32_t region = parts == 1 ? 0 : pattern.time_region_of(static_cast<int>(s), key);
            const uint32_t slot = region * parts / count * count + s;
            plan.slot_of.push_back(slot);
            TimeSpan& span = plan.slots[slot].time;
            span = {std::min(span.min, time.min), std::max(span.max, time.max)};
        }
    return plan;
}

}  // namespace trapeze
