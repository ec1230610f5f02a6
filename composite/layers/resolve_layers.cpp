#include "composite/layers/resolve_layers.h"

#include <algorithm>

#include "composite/layers/walk_layers.h"

namespace trapeze {
namespace {

/// The grid of a hit that hides everything behind it, whatever its colour; else null.
const Grid* covering_grid(const Hit& hit, const Grids& grids) {
    const uint32_t number = MicropolygonId::unpack(hit.id).grid;
    if (number >= grids.grids.size()) return nullptr;
    const Grid& grid = grids.grids[number];
    return grid.opaque && !grid.matte ? &grid : nullptr;
}
/// What a sample sees that sees such a grid: what resolve_layers() makes of it, to the bit.
SampleColor covered(const Hit& hit, const Grid& grid, const V3f& color) {
    return {{color.x, color.y, color.z, 1}, hit.depth, grid.primitive};
}

/// Whether a layer counts for the id: matte ones and those that leave no trace do not.
bool shows(const Grid& grid, const Layer& layer) {
    return !grid.matte && (layer.opacity != V3f(0) || layer.color != V3f(0));
}
bool has_depth(const Layer& layer, const DepthRule& rule) {
    const V3f &has = layer.opacity, &least = rule.least_opacity;
    return least == V3f(0) || (has.x >= least.x && has.y >= least.y && has.z >= least.z);
}

/// Adds a layer's values, weighed by what reaches it.
void add_aovs_of_hit(const AxisRay& ray, const Grid& grid, const MicropolygonId& id, const AovLayout& layout,
                     const AovProgress& progress, float* values) {
    // A grid that is not smooth shows the values of each micropolygon's first corner.
    QuadWeights weights{{1, 0, 0, 0}};
    if (grid.smooth) weights = hit_weights(ray, grid.quad(id.u, id.v, ray.time));
    const int corners = grid.smooth ? 4 : 1;
    const V3f& transmission = progress.transmission;
    const bool is_first = progress.depth >= kInfinity;
    const float mean = mean_of_channels(transmission);
    for (const Aov& aov : layout.aovs) {
        if (aov.is_of_one_surface() && !is_first) continue;
        for (int c = 0; c < aov.channels; ++c) {
            const float* plane = grid.aov_plane(aov.offset + c);
            float value = 0;
            for (int corner = 0; corner < corners; ++corner)
                value += weights.w[corner] *
                         plane[grid.shape.row_index(id.u + (corner & 1), id.v + (corner >> 1))];
            const float reaching = aov.is_of_one_surface()             ? 1
                                   : aov.channels == 3 && aov.is_color ? transmission[c]
                                                                       : mean;
            values[aov.offset + c] += reaching * value;
        }
    }
}

/// Adds hits to a sum. `layer_of(i, grid, id)`: hit i's layer.
template <class LayerOf>
void add(std::span<const Hit> hits, const Grids& grids, const DepthRule& rule, const LayerOf& layer_of,
         LayerSum& sum) {
    for (size_t i = 0; i < hits.size() && !sum.is_hidden; ++i) {
        const Hit& hit = hits[i];
        const MicropolygonId id = MicropolygonId::unpack(hit.id);
        if (id.grid >= grids.grids.size()) continue;
        const Grid& grid = grids.grids[id.grid];
        const Layer layer = layer_of(i, grid, id);
        for (int c = 0; c < 3; ++c) {
            const float opacity = hiding(layer, c);
            if (!grid.matte) sum.color[c] += sum.transmission[c] * layer.color[c];
            if (grid.matte != 1) sum.alpha[c] += sum.transmission[c] * opacity;
            sum.transmission[c] *= 1 - opacity;
        }
        if (shows(grid, layer)) {
            if (!sum.has_primitive) sum.primitive = grid.primitive, sum.has_primitive = true;
            if (has_depth(layer, rule) && ++sum.layers <= 2) {
                if (sum.layers == 1) sum.depth = hit.depth;
                if (sum.layers == 2 && rule.midpoint) sum.depth = (sum.depth + hit.depth) / 2;
            }
        }
        // "midpoint" still wants the depth of a second layer.
        sum.is_hidden = sum.transmission == V3f(0) && (!rule.midpoint || sum.layers >= 2);
    }
}

template <class LayerOf>
SampleColor resolve(std::span<const Hit> hits, const Grids& grids, const DepthRule& rule,
                    const LayerOf& layer_of) {
    if (!hits.empty() && rule.is_plain())
        if (const Grid* grid = covering_grid(hits.front(), grids))
            return covered(hits.front(), *grid,
                           layer_of(0, *grid, MicropolygonId::unpack(hits.front().id)).color);
    LayerSum sum;
    add(hits, grids, rule, layer_of, sum);
    return sum.result(rule);
}

/// Finds the layers of a HitBuffer's hits, from number `first_hit` on.
auto layers_from(const HitLayers& layers, size_t first_hit) {
    return
        [&layers, first_hit](size_t i, const Grid&, const MicropolygonId&) { return layers[first_hit + i]; };
}

}  // namespace

SampleColor LayerSum::result(const DepthRule& rule) const {
    SampleColor sample;
    sample.depth = rule.midpoint && layers == 1 ? kInfinity : depth;
    sample.primitive = primitive;
    for (int c = 0; c < 3; ++c) sample.rgba[c] = color[c];
    sample.rgba[3] = mean_of_channels(alpha);
    return sample;
}

SampleColor resolve_layers(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids,
                           const DepthRule& rule) {
    return resolve(hits, grids, rule, [&ray](size_t, const Grid& grid, const MicropolygonId& id) {
        return layer_at(ray, grid, id);
    });
}

SampleColor resolve_layers(std::span<const Hit> hits, const HitLayers& layers, size_t first_hit,
                           const Grids& grids, const DepthRule& rule) {
    return resolve(hits, grids, rule, layers_from(layers, first_hit));
}

void add_layers(std::span<const Hit> hits, const HitLayers& layers, size_t first_hit, const Grids& grids,
                const DepthRule& rule, LayerSum& sum) {
    add(hits, grids, rule, layers_from(layers, first_hit), sum);
}

float resolve_aovs(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, const AovLayout& layout,
                   float* values) {
    std::fill_n(values, layout.channel_count, 0.0f);
    AovProgress progress;
    add_aovs(ray, hits, grids, layout, progress, values);
    return progress.depth;
}

void add_aovs(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, const AovLayout& layout,
              AovProgress& progress, float* values) {
    walk_layers(ray, hits, grids, progress.transmission,
                [&](const Hit& hit, const MicropolygonId& id, const Grid& grid, const Layer& layer) {
                    if (!shows(grid, layer)) return;
                    if (grid.aov_channels == layout.channel_count)
                        add_aovs_of_hit(ray, grid, id, layout, progress, values);
                    progress.depth = std::min(progress.depth, hit.depth);
                });
}

}  // namespace trapeze
