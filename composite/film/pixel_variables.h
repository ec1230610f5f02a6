/// What a pixel keeps of output variables that are not filtered: one of its samples' values.
#pragma once

#include <vector>

#include "core/scene/aov.h"

namespace trapeze {

/// Serves for one pixel after another. Samples come in their order, of which the first wins where two are
/// equal.
class PixelVariables {
  public:
    explicit PixelVariables(const AovLayout& layout)
        : layout_(layout), values_(static_cast<size_t>(layout.channel_count)) {}

    /// Forgets all samples. Channels of which no sample sees anything are 0.
    void begin();
    /// Takes a sample's variables and the depth of the first layer that shows something, by which samples
    /// that see nothing are left out. Then sets the channels to 0 that are no sums, for what is added up.
    void take(float* variables, float depth);

    /// A number for each of the layout's channels; those that are sums are 0.
    const std::vector<float>& values() const { return values_; }

  private:
    const AovLayout& layout_;
    bool empty_ = true;
    float nearest_ = 0, farthest_ = 0;
    std::vector<float> values_;
};

}  // namespace trapeze
