/// What the film gets of samples: hits, or what these have been made into.
#pragma once

#include "composite/layers/hit_layers.h"
#include "composite/layers/layer_stack.h"
#include "composite/layers/resolve_layers.h"
#include "composite/layers/seen_layers.h"
#include "core/hit_buffer.h"
#include "core/samples.h"

namespace trapeze {

/// Samples of some pixels and what they see.
struct FilmPart {
    PixelRect pixels;
    const SampleTile& samples;
    const HitBuffer& hits;
    const Grids& grids;
    const LayerStack* stack = nullptr;  ///< instead of hits and grids

    size_t first_of(int px, int py) const { return samples.first_of_pixel(px, py); }
    bool has_hits(size_t sample) const { return stack ? stack->has_hits(sample) : !hits.of(sample).empty(); }
    /// The layers of some samples in a row; a stack has had them.
    void interpolate(size_t begin, size_t end, HitLayers& layers) const {
        if (!stack) layers.interpolate(samples, hits, begin, end, grids);
    }
    /// Of a sample that has hits.
    SampleColor color(size_t sample, const HitLayers& layers, const DepthRule& rule) const {
        if (stack) return stack->color(sample);
        return resolve_layers(hits.of(sample), layers, hits.first[sample], grids, rule);
    }
    /// Output variables of a sample that has hits; returns the depth of the first layer that shows something.
    float variables(size_t sample, const AovLayout& layout, float* values) const {
        if (!stack) return resolve_aovs(samples.rays[sample], hits.of(sample), grids, layout, values);
        std::copy_n(stack->aovs(sample), layout.channel_count, values);
        return stack->aov_depth(sample);
    }
    /// Appends the layers of a sample that has hits.
    void see(size_t sample, std::vector<SeenLayer>& layers) const {
        V3f transmission(1);
        if (!stack) return see_layers(samples.rays[sample], hits.of(sample), grids, transmission, layers);
        const std::vector<SeenLayer>& seen = stack->layers(sample);
        layers.insert(layers.end(), seen.begin(), seen.end());
    }
    bool hits_anything() const {
        if (stack) return true;
        if (hits.hits.empty() || hits.size() != samples.size()) return false;
        for (int y = pixels.y0; y < pixels.y1; ++y)
            if (hits.first[first_of(pixels.x1, y)] > hits.first[first_of(pixels.x0, y)]) return true;
        return false;
    }
};

/// Samples whose hits have been made into layers.
inline FilmPart part_of_stack(const SampleTile& samples, const LayerStack& stack) {
    static const HitBuffer kNoHits;
    static const Grids kNoGrids;
    return {samples.pixels, samples, kNoHits, kNoGrids, &stack};
}

}  // namespace trapeze
