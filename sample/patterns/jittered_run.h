/// Jittered samples of pixels next to each other in a row, many at once: the vector code of
/// StratifiedPattern. Same values on every instruction set, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/camera.h"
#include "sample/patterns/lens_outline.h"

namespace trapeze {

/// What a random number of a sample is for: part of what is hashed, so that each use has a number of its own.
enum SampleDimension : uint32_t {
    kSubpixelX,
    kSubpixelY,
    kLensU,
    kLensV,
    kTime,
    kTimeShift,
    kShuffle,
    kVariant,
    kTurnX,
    kTurnY
};

/// Pixels of a run: so many that few samples a pixel also fill vectors.
inline constexpr size_t kMaxRunPixels = 64;

/// The regions of a run's samples, the same in all runs. Padded to whole vectors.
struct RunRegions {
    int nx = 1, ny = 1;
    bool lens = false, motion = false;
    LensOutline outline{Aperture{}};           ///< of the lens; empty: a disk
    bool jittered = true;                      ///< in the subpixel; else in its middle
    size_t pixels = 1;                         ///< of a whole run
    std::vector<uint32_t> index;               ///< within the pixel
    std::vector<uint32_t> pixel;               ///< within the run
    std::vector<uint32_t> column, row;         ///< of the pixel, before its turn
    std::vector<float> lens_column, lens_row;  ///< of the lens' square
    std::vector<uint32_t> time;                ///< before the pixel's shift

    /// `lens_of` and `time_of` tell each subpixel region's.
    RunRegions(int columns, int rows, bool has_lens, bool has_motion, const std::vector<uint32_t>& lens_of,
               const std::vector<uint32_t>& time_of);
    /// Some of a pixel's samples; runs are of a pixel each.
    RunRegions(const RunRegions& whole, std::span<const uint32_t> samples);
    int samples_per_pixel() const { return nx * ny; }
};

/// What a run's pixels do not share: hashes, shifts of time, turns of columns and rows (strata.h), places on
/// the raster.
struct RunPixels {
    uint32_t hash[kMaxRunPixels], time_shift[kMaxRunPixels];
    uint32_t turn_x[kMaxRunPixels], turn_y[kMaxRunPixels];
    float x[kMaxRunPixels], x_limit[kMaxRunPixels];  ///< left edge; the greatest place before the right one
    float y = 0, y_limit = 0;
};

/// Samples in planes. Rays start at z = 0.
struct RunSamples {
    static constexpr size_t kCount = 256, kPadding = 64;

    alignas(64) float x[kCount + kPadding], y[kCount + kPadding];
    alignas(64) float lens_u[kCount + kPadding], lens_v[kCount + kPadding], time[kCount + kPadding];
    alignas(64) float ox[kCount + kPadding], oy[kCount + kPadding];
    alignas(64) float ux[kCount + kPadding], uy[kCount + kPadding];
};

/// Makes samples first .. first + count - 1 of a run, at most RunSamples::kCount.
void make_run_samples(const RunRegions& regions, const RunPixels& pixels, const Camera& camera, size_t first,
                      size_t count, RunSamples& out);

/// Writes the rays of the first `count` samples as AxisRays, which hold their numbers side by side.
void interleave_rays(const RunSamples& samples, size_t count, AxisRay* rays);

}  // namespace trapeze
