/// The samples of INTERLEAVEUVT [Fatahalian09, as Hou10 sec. 5 describes it]: without jitter, from one set of
/// tuples (place in the pixel, lens point, time) for the whole picture. The set is k * k groups of as many
/// tuples as a pixel has samples. Each pixel of a tile of k x k has one of the groups. A hash of the tile
/// says which pixel has which, so that the repetition is hard to see.
///
/// Groups are stratified as far as their number of tuples goes, in place, lens and time each, and all tuples
/// together as far as theirs does. Within regions they are spread as in correlated multi-jittering
/// [Kensler13]: no two of them have the same x or y, u or v.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sample/patterns/sample_pattern.h"

namespace trapeze {

/// What all samples of one kind in the picture share: where in the pixel, through which lens point, when.
struct SampleTuple {
    float x, y;            ///< from the pixel's corner, in [0, 1)
    float lens_u, lens_v;  ///< in the unit disk; 0 without a lens
    float time;            ///< in [0, 1); 0 without motion
};

/// Makes its tuples once, from the context's seed; a pixel's samples depend on the pixel and the seed alone.
class InterleavedPattern final : public SamplePattern {
  public:
    static constexpr int kMaxSide = 4;
    /// For the pixels of a tile, row by row; the first side() * side() count.
    using Groups = std::array<uint8_t, kMaxSide * kMaxSide>;

    /// `side` is k, 1 to kMaxSide.
    InterleavedPattern(const RenderContext& context, int side);

    void make_tile(const PixelRect& pixels, SampleTile& tile) const override;

    int side() const { return side_; }
    int group_count() const { return side_ * side_; }
    /// Of all groups, the samples of each one after another.
    int tuple_count() const { return group_count() * sample_count(); }

    /// Sample s of a pixel that has group g is tuple g * sample_count() + s.
    const SampleTuple& tuple(int index) const { return tuples_[static_cast<size_t>(index)]; }

    /// The groups of the pixels of pattern tile (tx, ty), which has the pixels from (tx, ty) * side() on,
    /// negative ones too; every group has one of them.
    Groups groups_of_tile(int tx, int ty) const;

    /// Raster coordinate, x or y, that a fraction within a pixel stands for.
    static float coordinate(int pixel, float fraction);

  private:
    void make_tuples();
    void make_pixel(int px, int py, int group, SampleTile& tile) const;

    int side_;
    std::vector<SampleTuple> tuples_;
};

}  // namespace trapeze
