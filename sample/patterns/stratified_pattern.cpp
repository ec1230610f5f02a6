#include "sample/patterns/stratified_pattern.h"

#include <algorithm>

#include <numeric>

#include "core/random.h"

namespace trapeze {
namespace {

/// Subpixel region -> lens region. For n x n it is Arnold's cat map, (2 x + y, x + y) modulo n, an orthogonal
/// array: each column of the pixel meets each column of the lens once, each row each row, each column
/// each row, so edges that lie along one of them see n x n regions of pixel and lens. Edges that are askew
/// see nearly as much, since no multiple of a direction is its image: the map stretches by the golden ratio.
std::vector<uint32_t> lens_permutation(int nx, int ny, uint32_t seed) {
    if (nx != ny) return hashed_permutation(static_cast<size_t>(nx) * ny, hash(seed, kLensU));
    const auto n = static_cast<uint32_t>(nx);
    std::vector<uint32_t> lens_of;
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) lens_of.push_back((x + y) % n * n + (2 * x + y) % n);
    return lens_of;
}

/// Subpixel region -> time region. For n x n each column and row of the pixel has one time in each n-th of
/// the shutter, and so have columns of the lens unless n is a multiple of 3. Else the lens' permutation with
/// its rows and columns shuffled.
std::vector<uint32_t> time_permutation(const std::vector<uint32_t>& lens_of, int nx, int ny, uint32_t seed) {
    std::vector<uint32_t> time_of;
    if (nx == ny) {
        const auto n = static_cast<uint32_t>(nx);
        uint32_t factor = 3;
        while (std::gcd(factor, n) != 1) factor += 2;
        for (uint32_t y = 0; y < n; ++y)
            for (uint32_t x = 0; x < n; ++x)
                time_of.push_back((factor * x + y) % n * n + ((factor - 1) * x + y) % n);
        return time_of;
    }
    const std::vector<uint32_t> columns = hashed_permutation(nx, hash(seed, kShuffle, 0));
    const std::vector<uint32_t> rows = hashed_permutation(ny, hash(seed, kShuffle, 1));
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x)
            time_of.push_back(lens_of[static_cast<size_t>(rows[y]) * nx + columns[x]]);
    return time_of;
}

/// The largest block of columns or rows whose turns keep cells of all levels that a pattern may have: the
/// same for any levels, and for none, since all of their samples are those of the whole pattern.
uint32_t block_of(int count) {
    const auto n = static_cast<uint32_t>(count);
    return std::min(n & -n, 1u << (SampleLevels::kMostLevels - 1));
}

}  // namespace

/// Permutations are made once, for all pixels; what differs from pixel to pixel is the jitter, the turn of
/// columns and rows, and the shift of times.
StratifiedPattern::StratifiedPattern(const RenderContext& context)
    : SamplePattern(context),
      turns_(camera_.has_lens() || motion_),
      block_x_(block_of(nx_)),
      block_y_(block_of(ny_)),
      lens_of_(lens_permutation(nx_, ny_, context.seed)),
      time_of_(time_permutation(lens_of_, nx_, ny_, context.seed)),
      regions_(nx_, ny_, camera_.has_lens(), motion_, lens_of_, time_of_) {
    regions_.outline = lens_.outline();
    // Hider "jitter" 0: samples lie at the middles of their regions of the pixel. Depth maps of one sample
    // a pixel want the depths at the middles of pixels.
    regions_.jittered = !context.scene || context.scene->options.hider_parameters.float_or("jitter", 1) != 0;
    if (context.sample_levels <= 1) return;
    levels_.emplace(PixelStrata{nx_, ny_, lens_of_, time_of_}, context.sample_levels,
                    hash(context.seed, kVariant));
    for (size_t variant = 0; variant < levels_->variants(); ++variant)
        for (int level = 0; level < levels_->count(); ++level)
            regions_of_levels_.emplace_back(regions_, levels_->added(variant, level));
}

uint32_t StratifiedPattern::pixel_hash(int px, int py) const {
    return hash(seed_, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
}

/// Without a lens, turns alone keep what is seen at a place from having always the same time.
uint32_t StratifiedPattern::time_shift_of(uint32_t pixel_hash) const {
    if (!camera_.has_lens()) return 0;
    return hash(pixel_hash, kTimeShift) % static_cast<uint32_t>(sample_count());
}

uint32_t StratifiedPattern::turn_x(uint32_t pixel_hash) const {
    return turns_ ? turn_of(hash(pixel_hash, kTurnX), static_cast<uint32_t>(nx_), block_x_) : 0;
}

uint32_t StratifiedPattern::turn_y(uint32_t pixel_hash) const {
    return turns_ ? turn_of(hash(pixel_hash, kTurnY), static_cast<uint32_t>(ny_), block_y_) : 0;
}

void StratifiedPattern::set_pixel(int px, int py, size_t slot, RunPixels& run) const {
    run.x[slot] = static_cast<float>(px), run.x_limit[slot] = last_place_of(px);
    const uint32_t own = run.hash[slot] = pixel_hash(px, py);
    run.time_shift[slot] = time_shift_of(own);
    run.turn_x[slot] = turn_x(own), run.turn_y[slot] = turn_y(own);
}

uint32_t StratifiedPattern::time_shift(int px, int py) const {
    return time_shift_of(pixel_hash(px, py));
}

TimeSpan StratifiedPattern::time_bounds(int sample, uint32_t shift) const {
    return motion_ ? time_region(time_region_of(sample, shift), sample_count()) : TimeSpan{};
}

LensBox StratifiedPattern::lens_bounds(int sample) const {
    return camera_.has_lens() ? lens_.region(lens_of_[sample], nx_, ny_) : LensBox{};
}

/// Runs of whole pixels along a row, as many as fill the lanes; a run ends with the row, and with the tile.
void StratifiedPattern::make_tile(const PixelRect& pixels, SampleTile& tile) const {
    begin_tile(pixels, tile);
    RunPixels run;
    RunSamples made;
    const auto longest = static_cast<int>(regions_.pixels);
    for (int py = pixels.y0; py < pixels.y1; ++py) {
        run.y = static_cast<float>(py), run.y_limit = last_place_of(py);
        for (int px = pixels.x0; px < pixels.x1; px += longest) {
            const int width = std::min(longest, pixels.x1 - px);
            for (int i = 0; i < width; ++i) set_pixel(px + i, py, static_cast<size_t>(i), run);
            make_run(regions_, run, static_cast<size_t>(width) * tile.samples_per_pixel,
                     tile.first_of_pixel(px, py), made, tile);
        }
    }
}

/// Pixels of a list each make runs of their own, as few as their levels have samples; in_pixel says which
/// samples of the whole pattern these are.
void StratifiedPattern::make_levels(const PixelRect& within, std::span<const PixelPlace> pixels, int from,
                                    int to, SampleTile& tile) const {
    tile.pixels = within;
    tile.listed.assign(pixels.begin(), pixels.end());
    const size_t below = from > 0 ? levels_->samples(from - 1) : 0;
    tile.samples_per_pixel = static_cast<int>(levels_->samples(to) - below);
    tile.resize(pixels.size() * static_cast<size_t>(tile.samples_per_pixel));
    tile.in_pixel.resize(tile.size());
    RunPixels run;
    RunSamples made;
    size_t at = 0;
    for (const PixelPlace& pixel : pixels) {
        run.y = static_cast<float>(pixel.y), run.y_limit = last_place_of(pixel.y);
        set_pixel(pixel.x, pixel.y, 0, run);
        const size_t variant = variant_of(pixel);
        for (int level = from; level <= to; ++level) {
            const std::span<const uint32_t> added = levels_->added(variant, level);
            make_run(regions_of_levels_[levels_->index(variant, level)], run, added.size(), at, made, tile);
            for (const uint32_t sample : added) tile.in_pixel[at++] = static_cast<uint16_t>(sample);
        }
    }
}

/// Makes `count` samples of a run in parts that fit RunSamples, and copies them to the tile from sample `to`
/// on.
void StratifiedPattern::make_run(const RunRegions& regions, const RunPixels& run, size_t count, size_t to,
                                 RunSamples& made, SampleTile& tile) const {
    for (size_t first = 0; first < count; first += RunSamples::kCount, to += RunSamples::kCount) {
        const size_t n = std::min(count - first, RunSamples::kCount);
        make_run_samples(regions, run, camera_, first, n, made);
        std::copy_n(made.x, n, tile.x.data() + to);
        std::copy_n(made.y, n, tile.y.data() + to);
        std::copy_n(made.lens_u, n, tile.lens_u.data() + to);
        std::copy_n(made.lens_v, n, tile.lens_v.data() + to);
        std::copy_n(made.time, n, tile.time.data() + to);
        interleave_rays(made, n, tile.rays.data() + to);
    }
}

}  // namespace trapeze
