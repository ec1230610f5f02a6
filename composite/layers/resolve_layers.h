/// What one sample sees, out of its hits: colour, coverage and depth, front to back
/// [Porter84].
#pragma once

#include <span>

#include "composite/layers/hit_layers.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/rays.h"
#include "core/scene/aov.h"
#include "core/scene/depth_filter.h"
#include "core/scene/scene.h"

namespace trapeze {

/// What one sample contributes to its pixel.
struct SampleColor {
    float rgba[4] = {0, 0, 0,
                     0};  ///< colour premultiplied by opacity; alpha is the mean of the three opacities
    float depth =
        kInfinity;  ///< of the first layer that counts: not held out, nor more transparent than wanted
    uint32_t primitive =
        ~uint32_t{0};  ///< whose the first is that shows anything; all ones when there is none
};

/// Composites a sample's hits, front to back. Ci is premultiplied by Oi (RISpec 3.4), each channel has its
/// own opacity. A matte micropolygon holds out: it adds neither colour nor alpha but hides what is behind it
/// by its Oi; Matte 2 (Aqsis) adds its alpha.
///
/// Of DepthRule::midpoint the depth is infinite when one layer counts: what shadow maps want, so that no
/// surface shadows itself. Hits must not end at the first opaque one.
SampleColor resolve_layers(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids,
                           const DepthRule& rule = {});

/// Composites as above, for hits whose layers are known: hits[0] is number `first_hit` of its buffer.
SampleColor resolve_layers(std::span<const Hit> hits, const HitLayers& layers, size_t first_hit,
                           const Grids& grids, const DepthRule& rule = {});

/// What a sample has gathered of its hits so far, front to back: of a list that comes in parts.
struct LayerSum {
    V3f transmission{1}, color{0}, alpha{0};
    float depth = kInfinity;
    uint32_t primitive = ~uint32_t{0};
    uint32_t layers = 0;  ///< that count for depth
    bool has_primitive = false;
    bool is_hidden = false;  ///< hits behind change nothing any more

    SampleColor result(const DepthRule& rule) const;
};

/// Adds the next hits of a sample, to the bit as resolve_layers() composites the whole list.
void add_layers(std::span<const Hit> hits, const HitLayers& layers, size_t first_hit, const Grids& grids,
                const DepthRule& rule, LayerSum& sum);

/// How far output variables of a sample have been composited.
struct AovProgress {
    V3f transmission{1};      ///< what reaches the next hits
    float depth = kInfinity;  ///< of the first layer that shows something; infinite before there is one
};

/// Composites output variables in the same way, as aov.h says: `values` gets layout.channel_count numbers.
/// Grids that carry other channels than the layout's count as having 0 everywhere. Returns
/// AovProgress::depth.
float resolve_aovs(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, const AovLayout& layout,
                   float* values);
/// Adds the next hits of a sample.
void add_aovs(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, const AovLayout& layout,
              AovProgress& progress, float* values);

}  // namespace trapeze
