/// Where the samples of pixels lie [Hou10 sec. 3.4]: jittered stratified in subpixel position, on the lens
/// and in time, each domain in as many regions as a pixel has samples.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "sample/patterns/jittered_run.h"
#include "sample/patterns/sample_pattern.h"
#include "sample/patterns/strata.h"

namespace trapeze {

/// nx * ny samples a pixel; the natural pattern of most methods. Where both a lens and motion blur, pixels
/// shift their times by a hash: otherwise a point of the lens would always go with the same time.
class StratifiedPattern final : public SamplePattern {
  public:
    explicit StratifiedPattern(const RenderContext& context);

    void make_tile(const PixelRect& pixels, SampleTile& tile) const override;
    const SampleLevels* levels() const override { return levels_ ? &*levels_ : nullptr; }
    size_t variant_of(const PixelPlace& pixel) const override {
        return levels_->variant_of(hash(pixel_hash(pixel.x, pixel.y), kVariant));
    }
    void make_levels(const PixelRect& within, std::span<const PixelPlace> pixels, int from, int to,
                     SampleTile& tile) const override;

    /// How far a pixel's times are moved along, in regions: what its neighbours do not share.
    uint32_t time_shift(int px, int py) const;
    /// Whether time shifts matter: without motion nothing looks at times, without a lens all shifts are 0.
    bool has_time_shifts() const { return motion_ && camera_.has_lens(); }
    uint32_t time_region_of(int sample, uint32_t shift) const {
        return (time_of_[static_cast<size_t>(sample)] + shift) % static_cast<uint32_t>(sample_count());
    }
    uint32_t lens_region_of(int sample) const { return lens_of_[static_cast<size_t>(sample)]; }
    /// Where sample `sample` of all pixels of a time shift looks.
    TimeSpan time_bounds(int sample, uint32_t shift) const;
    LensBox lens_bounds(int sample) const;

  private:
    /// Of the pixel's place in the picture, negative in its border; the same in all tiles that have the
    /// pixel.
    uint32_t pixel_hash(int px, int py) const;
    uint32_t time_shift_of(uint32_t pixel_hash) const;
    void make_run(const RunRegions& regions, const RunPixels& run, size_t count, size_t to, RunSamples& made,
                  SampleTile& tile) const;

    std::vector<uint32_t> lens_of_;  ///< subpixel region -> lens region, the same in all pixels
    std::vector<uint32_t> time_of_;  ///< subpixel region -> time region, before the pixel's shift
    RunRegions regions_;
    std::optional<SampleLevels> levels_;
    std::vector<RunRegions> regions_of_levels_;  ///< by SampleLevels::index()
};

}  // namespace trapeze
