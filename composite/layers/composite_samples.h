/// Samples' layers over one another, many samples at a time [Porter84].
#pragma once

#include <cstddef>
#include <cstdint>

namespace trapeze {

/// Layers that lie in planes (HitLayers), of samples in a row.
struct LayersOfSamples {
    const uint32_t* first;       ///< sample s has layers first[s] - first[0] to first[s + 1] - first[0]
    size_t count;                ///< samples
    const float* const* planes;  ///< Ci, Oi; a number for each layer, kLayerPadding more may be read
    /// Where in the planes each layer is; null: in their order, one a sample. The n-th layers of samples in a
    /// row that have so many follow each other.
    const uint32_t* places = nullptr;
};

/// Composites each sample's layers, front to back, to the bit as resolve_layers() does where nothing is
/// matte: `rgba` are planes of `count` numbers. `nearest` gets the first layer of each sample that leaves a
/// trace, or -1.
void composite_samples(const LayersOfSamples& layers, float* const* rgba, int32_t* nearest);

}  // namespace trapeze
