#include "composite/film/pixel_variables.h"

#include <algorithm>

namespace trapeze {

void PixelVariables::begin() {
    empty_ = true;
    std::fill(values_.begin(), values_.end(), 0.0f);
}

void PixelVariables::take(float* variables, float depth) {
    const bool sees = depth < kInfinity;
    const bool is_nearest = empty_ || depth < nearest_, is_farthest = empty_ || depth > farthest_;
    for (const Aov& aov : layout_.aovs) {
        if (aov.is_summed()) continue;
        const bool takes = aov.filter == VariableFilter::Nearest ? is_nearest : is_farthest;
        for (int c = aov.offset; c < aov.offset + aov.channels; ++c) {
            float& kept = values_[static_cast<size_t>(c)];
            const float value = variables[c];
            variables[c] = 0;
            if (!sees) continue;
            if (aov.is_of_one_surface())
                kept = takes ? value : kept;
            else if (aov.filter == VariableFilter::Min)
                kept = empty_ ? value : std::min(kept, value);
            else
                kept = empty_ ? value : std::max(kept, value);
        }
    }
    if (!sees) return;
    if (is_nearest) nearest_ = depth;
    if (is_farthest) farthest_ = depth;
    empty_ = false;
}

}  // namespace trapeze
