/// A pixel's samples in levels, for pixels that stop where few are enough. Each level has four times the
/// samples of the one below, and holds them: one in each cell of a grid over the pixel, and as nearly as can
/// be in each cell of one over the lens and in each of equal parts of the shutter. So any level alone is
/// nearly as good a pattern, and all of them are the whole one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trapeze {

/// Two samples of a first level by their places in added().
struct SamplePair {
    uint16_t a = 0, b = 0;
};

/// Which regions of the pixel, the lens and the shutter its samples have.
struct PixelStrata {
    int nx = 1, ny = 1;                    ///< regions of the pixel along each side; samples run row by row
    const std::vector<uint32_t>& lens_of;  ///< sample -> region of the lens' square, rows of nx
    const std::vector<uint32_t>& time_of;  ///< sample -> region of the shutter
};

/// The levels of a pattern. Pixels take different ones of the samples into their lower levels, or none would
/// ever look at the regions that are left out: there are variants, of which each region is in equally many.
class SampleLevels {
  public:
    static constexpr int kMostLevels = 3;

    /// nx and ny are multiples of 2^(levels - 1).
    SampleLevels(const PixelStrata& strata, int levels, uint32_t seed);

    int count() const { return levels_; }
    int top() const { return levels_ - 1; }
    /// Samples of a pixel at a level.
    size_t samples(int level) const { return all_ >> 2 * (top() - level); }
    size_t variants() const { return size_t{1} << 2 * top(); }
    /// The variant of a pixel, by random bits of its own.
    size_t variant_of(uint32_t bits) const { return bits & (variants() - 1); }
    /// The samples that a level has beyond the one below, ascending.
    std::span<const uint32_t> added(size_t variant, int level) const { return added_[index(variant, level)]; }
    /// Numbers what added() tells apart, from 0 on.
    size_t index(size_t variant, int level) const {
        return variant * static_cast<size_t>(levels_) + static_cast<size_t>(level);
    }

    /// Samples of a first level that are neighbours in the pixel, on the lens, or in time.
    struct Neighbours {
        std::vector<SamplePair> pixel, lens, time;
    };
    const Neighbours& neighbours(size_t variant) const { return neighbours_[variant]; }

  private:
    int levels_;
    size_t all_;
    std::vector<std::vector<uint32_t>> added_;  ///< by variant, level
    std::vector<Neighbours> neighbours_;        ///< by variant
};

}  // namespace trapeze
