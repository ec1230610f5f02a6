/// For each pixel, sets of its samples as bits: those below any of some places on the lens' two axes and in
/// time. The samples of a box in (u, v, time) are then a few logic operations on words of 64 samples.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/samples.h"

namespace trapeze {

/// The masks of a tile; memory is reused. Layout: [pixel][axis][bin 0 to kBins][word]. Bin 0 is empty and bin
/// kBins is all, so that a range needs no special case at either end.
class SampleMasks {
  public:
    /// Parts of an axis that can be told apart.
    static constexpr int kBins = 32;
    /// Samples are binned by each axis alone; a set of bins along all three is the intersection of three
    /// masks.
    enum Axis { kU, kV, kTime, kAxes };

    /// Builds the sets of all pixels of a tile. Without a lens the axes u and v are those of the place within
    /// the pixel.
    void build(const SampleTile& samples, bool lens);

    /// The bin of a place on an axis that runs from 0 to 1.
    static int bin(float place) {
        return static_cast<int>(std::clamp(place * kBins, 0.0f, static_cast<float>(kBins - 1)));
    }
    /// Where a coordinate of the unit disk is on its axis.
    static constexpr float lens_place(float u) { return u * 0.5f + 0.5f; }

    size_t words() const { return words_; }  ///< of a set
    /// below(pixel, axis) + bin * words() is the set of samples in lower bins; bin is 0 to kBins.
    const uint64_t* below(size_t pixel, Axis axis) const {
        return masks_.data() + (pixel * kAxes + axis) * (kBins + 1) * words_;
    }

  private:
    size_t words_ = 1;
    std::vector<uint64_t> masks_;
};

}  // namespace trapeze
