/// Which lanes of a call ask, and which get what they are told: each vertex for itself, but at what a ray has
/// hit only the vertex there, for its whole grid.
#pragma once

#include <algorithm>

#include "shade/vm/machine.h"

namespace trapeze {

/// A lane that asks, and those that get the answer.
struct AskingLane {
    size_t lane = 0, first = 0, count = 1;
};

/// Calls ask(span, vertex, AskingLane) for all that run and are wanted; where the answer is `uniform`, for
/// the first that runs. The run has a batch.
template <class Ask>
void for_each_asking_lane(vm::Run& run, bool uniform, const Ask& ask) {
    const uint32_t* const mask = run.masks().all() ? nullptr : run.masks().current();
    for (const vm::GridSpan& span : run.context().batch->spans) {
        const auto count = static_cast<size_t>(span.shape.vertex_count());
        const bool one = span.hit_vertex >= 0;
        const size_t begin = one ? static_cast<size_t>(span.hit_vertex) : 0, end = one ? begin + 1 : count;
        for (size_t i = begin; i < end; ++i) {
            const size_t lane = span.first + i;
            if (mask && !mask[lane]) continue;
            if (!uniform && !span.wants(i)) continue;
            ask(span, i, one ? AskingLane{lane, span.first, count} : AskingLane{lane, lane, 1});
            if (uniform) return;
        }
    }
}

/// Sets some lanes of a component, or all where the operand is uniform.
inline void put_lanes(const vm::Operand& out, size_t first, size_t count, int component, float value) {
    float* const plane = out.data + static_cast<size_t>(component) * out.stride;
    if (out.lane_mask)
        std::fill_n(plane + first, count, value);
    else
        std::fill_n(plane, kLanes, value);
}

/// Black in all lanes that are not asked for because their vertices are not wanted: what they have must be
/// the same in every run, too.
inline void set_unwanted_lanes(vm::Run& run, std::span<const vm::Operand> outputs) {
    for (const vm::GridSpan& span : run.context().batch->spans) {
        const auto count = span.wanted ? static_cast<size_t>(span.shape.vertex_count()) : 0;
        for (size_t i = 0; i < count; ++i)
            for (const vm::Operand& out : outputs)
                for (int k = 0; out.lane_mask && !span.wants(i) && k < (out.stride ? 3 : 1); ++k)
                    out.data[static_cast<size_t>(k) * out.stride + span.first + i] = 0;
    }
}

/// Sets a colour or vector, or the first of the value's numbers where the operand is a float.
inline void put_lanes(const vm::Operand& out, size_t first, size_t count, const V3f& value) {
    for (int k = 0; k < (out.stride ? 3 : 1); ++k) put_lanes(out, first, count, k, value[k]);
}

}  // namespace trapeze
