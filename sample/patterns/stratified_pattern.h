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

/// nx * ny samples a pixel; the natural pattern of most methods. Which regions of the pixel, the lens and the
/// shutter go together is the same in all pixels, but for two things, or what one sees through a part of a
/// pixel would always be seen through the same part of the lens, at the same time, and no number of samples
/// would make the picture right: each pixel turns its columns and rows (strata.h), and, where there is a
/// lens, shifts its times, both by a hash.
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
    /// How a pixel turns its columns and its rows.
    uint32_t turn_x(uint32_t pixel_hash) const;
    uint32_t turn_y(uint32_t pixel_hash) const;
    /// Where sample `sample` of all pixels of a time shift looks.
    TimeSpan time_bounds(int sample, uint32_t shift) const;
    LensBox lens_bounds(int sample) const;

  private:
    /// Of the pixel's place in the picture, negative in its border; the same in all tiles that have the
    /// pixel.
    uint32_t pixel_hash(int px, int py) const;
    uint32_t time_shift_of(uint32_t pixel_hash) const;
    /// What a pixel of a run does not share with others.
    void set_pixel(int px, int py, size_t slot, RunPixels& run) const;
    void make_run(const RunRegions& regions, const RunPixels& run, size_t count, size_t to, RunSamples& made,
                  SampleTile& tile) const;

    bool turns_;                     ///< lens or times matter, and pixels turn their columns and rows
    uint32_t block_x_, block_y_;     ///< of turns: what a level's samples are one each of stays together
    std::vector<uint32_t> lens_of_;  ///< subpixel region before its turn -> lens region
    std::vector<uint32_t> time_of_;  ///< subpixel region before its turn -> time region, before its shift
    RunRegions regions_;
    std::optional<SampleLevels> levels_;
    std::vector<RunRegions> regions_of_levels_;  ///< by SampleLevels::index()
};

}  // namespace trapeze
