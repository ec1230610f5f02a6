#include "composite/film/pixel_samples.h"

#include <algorithm>

#include "composite/film/film_part.h"
#include "composite/layers/composite_samples.h"

namespace trapeze {

PixelSamples::PixelSamples(const FilmRules& rules, size_t count)
    : rules_(rules),
      channels_(static_cast<size_t>(rules.aovs->channel_count)),
      colors_(4, count),
      has_hits_(count),
      depths_(count, kInfinity),
      primitives_(count, kNoPrimitive),
      variables_(channels_ * count),
      variables_depths_(channels_ > 0 ? count : 0),
      first_layer_(count + 1),
      nearest_(count) {}

void PixelSamples::set_color(size_t sample, const float* rgba, float depth, uint32_t primitive,
                             bool has_hits) {
    for (size_t c = 0; c < 4; ++c) colors_[c][sample] = rgba[c];
    depths_[sample] = depth;
    if (rules_.wants_primitives) primitives_[sample] = primitive;
    has_hits_[sample] = has_hits;
    sees_something_ |= has_hits;
}

void PixelSamples::see(const FilmPart& part, size_t first) {
    sees_something_ = false;
    part.interpolate(first, first + count(), hit_layers_);
    if (part.stack || !hit_layers_.all_plain())
        see_one_by_one(part, first);
    else if (hit_layers_.all_cover())
        see_covered(part, first);
    else if (!rules_.depth_rule.is_plain())
        see_one_by_one(part, first);
    else
        see_plain_layers(part, first);
    if (channels_ > 0 || rules_.layers.want_layers()) see_extras(part, first);
}

void PixelSamples::see_one_by_one(const FilmPart& part, size_t first) {
    for (size_t s = 0; s < count(); ++s) {
        const bool has_hits = part.has_hits(first + s);
        const SampleColor color =
            has_hits ? part.color(first + s, hit_layers_, rules_.depth_rule) : SampleColor{};
        set_color(s, color.rgba, color.depth, color.primitive, has_hits);
    }
}

/// Layers that hold nothing out, over one another.
void PixelSamples::see_plain_layers(const FilmPart& part, size_t first) {
    const uint32_t* const first_hit = part.hits.first.data() + first;
    const Hit* const hits = part.hits.hits.data() + first_hit[0];
    const float* planes[kLayerPlanes];
    for (size_t k = 0; k < kLayerPlanes; ++k) planes[k] = hit_layers_.plane(k);
    float* const rgba[4] = {colors_[0], colors_[1], colors_[2], colors_[3]};
    composite_samples({first_hit, count(), planes, hit_layers_.places().data()}, rgba, nearest_.data());
    sees_something_ = first_hit[count()] > first_hit[0];
    for (size_t s = 0; s < count(); ++s) {
        has_hits_[s] = first_hit[s + 1] > first_hit[s];
        const bool leaves_trace = nearest_[s] >= 0;
        depths_[s] = leaves_trace ? hits[nearest_[s]].depth : kInfinity;
        if (rules_.wants_primitives)
            primitives_[s] =
                leaves_trace ? part.grids.grids[MicropolygonId::unpack(hits[nearest_[s]].id).grid].primitive
                             : kNoPrimitive;
    }
}

/// Each sample sees one surface that hides all else.
void PixelSamples::see_covered(const FilmPart& part, size_t first) {
    const std::span hits(part.hits.hits.data() + part.hits.first[first], count());
    for (size_t c = 0; c < 3; ++c) std::copy_n(hit_layers_.plane(c), count(), colors_[c]);
    std::fill_n(colors_[3], count(), 1.0f);
    std::ranges::fill(has_hits_, uint8_t{1});
    sees_something_ = true;
    // "midpoint" wants a second surface.
    const bool has_depth = !rules_.depth_rule.midpoint;
    for (size_t s = 0; s < count(); ++s) depths_[s] = has_depth ? hits[s].depth : kInfinity;
    if (!rules_.wants_primitives) return;
    for (size_t s = 0; s < count(); ++s)
        primitives_[s] = part.grids.grids[MicropolygonId::unpack(hits[s].id).grid].primitive;
}

/// Finds variables and layers.
void PixelSamples::see_extras(const FilmPart& part, size_t first) {
    layers_.clear();
    for (size_t s = 0; s < count(); ++s) {
        if (channels_ > 0 && has_hits(s))
            variables_depths_[s] = part.variables(first + s, *rules_.aovs, &variables_[channels_ * s]);
        if (rules_.layers.want_layers() && has_hits(s)) part.see(first + s, layers_);
        first_layer_[s + 1] = layers_.size();
    }
}

void PixelSamples::begin() {
    sees_something_ = false;
    layers_.clear();
}

void PixelSamples::set(size_t sample, const SeenSample& seen) {
    set_color(sample, seen.rgba, seen.depth, seen.primitive, seen.has_hits);
    if (channels_ > 0 && seen.has_hits) {
        std::copy_n(seen.variables, channels_, &variables_[channels_ * sample]);
        variables_depths_[sample] = seen.variables_depth;
    }
    layers_.insert(layers_.end(), seen.layers.begin(), seen.layers.end());
    first_layer_[sample + 1] = layers_.size();
}

SeenSample PixelSamples::of(size_t sample) const {
    SeenSample seen;
    for (size_t c = 0; c < 4; ++c) seen.rgba[c] = colors_[c][sample];
    seen.depth = depths_[sample], seen.primitive = primitive(sample), seen.has_hits = has_hits(sample);
    seen.layers = layers(sample);
    if (channels_ > 0 && seen.has_hits)
        seen.variables = variables(sample), seen.variables_depth = variables_depth(sample);
    return seen;
}

}  // namespace trapeze
