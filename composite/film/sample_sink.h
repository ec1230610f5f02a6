/// Where samples go with what they see.
#pragma once

#include <cstddef>

#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/samples.h"

namespace trapeze {

class LayerStack;

/// Takes samples whose hits are found at once, or in parts through a stack.
class SampleSink {
  public:
    virtual ~SampleSink() = default;

    virtual void add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) = 0;
    /// Samples whose hits have come in parts: to a stack that was begun by begin_stack().
    virtual void add(const SampleTile& samples, const LayerStack& stack) = 0;
    virtual void begin_stack(size_t sample_count, LayerStack& stack) const = 0;
};

}  // namespace trapeze
