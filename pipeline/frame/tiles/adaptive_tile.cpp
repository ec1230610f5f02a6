#include "pipeline/frame/tiles/adaptive_tile.h"

#include <algorithm>
#include <cmath>

#include "core/z_order.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/frame/tiles/resolve_tiles.h"

namespace trapeze {
namespace {

/// How far around a pixel its noise is looked for: what is sharp, and what is blurred.
constexpr int kSharpReach = 1, kBlurredReach = 4;

}  // namespace

/// Pixels near each other in the list are near each other in the picture, so that neighbouring rays are.
void AdaptiveTile::list_pixels() {
    all_.clear();
    for_each_in_z_order(pixels_, [this](int x, int y) { all_.push_back({x, y}); });
}

uint64_t AdaptiveTile::add(const AdaptiveTask& task, const PixelRect& pixels, LayerPasses& passes,
                           SampleScratch& scratch, SampleStats& stats) {
    const SampleLevels& levels = *task.pattern.levels();
    pixels_ = pixels;
    list_pixels();
    gathered_.begin(pixels, levels.samples(levels.top()), task.film.rules());
    take(task, all_, 0, 0, passes, scratch, stats);
    uint64_t count = all_.size() * levels.samples(0);
    if (gathered_.shows_something()) {
        Stopwatch watch;
        estimate_noise(task);
        refined_.resize(static_cast<size_t>(levels.count()));
        for (auto& pixels_of_level : refined_) pixels_of_level.clear();
        for (const PixelPlace& pixel : all_)
            refined_[static_cast<size_t>(wanted_level(task, pixel))].push_back(pixel);
        composite_seconds_ += watch.lap();
        for (int level = 1; level <= levels.top(); ++level) {
            const std::vector<PixelPlace>& refined = refined_[static_cast<size_t>(level)];
            if (refined.empty()) continue;
            take(task, refined, 1, level, passes, scratch, stats);
            count += refined.size() * (levels.samples(level) - levels.samples(0));
        }
    }
    Stopwatch watch;
    task.film.add(gathered_);
    composite_seconds_ += watch.lap();
    return count;
}

void AdaptiveTile::count_samples(HeatMap& heat) const {
    for (const PixelPlace& pixel : all_)
        heat.samples[heat.index(pixel.x, pixel.y)] = static_cast<float>(gathered_.sample_count(pixel));
}

/// Finds what the samples of some pixels see that levels `from` to `to` add.
void AdaptiveTile::take(const AdaptiveTask& task, const std::vector<PixelPlace>& pixels, int from, int to,
                        LayerPasses& passes, SampleScratch& scratch, SampleStats& stats) {
    Stopwatch watch;
    task.pattern.make_levels(pixels_, pixels, from, to, samples_);
    pattern_seconds_ += watch.lap();
    passes.add_tile({task.visibility, task.grids, task.all_opaque, task.limits, gathered_}, samples_, scratch,
                    stats);
}

void AdaptiveTile::estimate_noise(const AdaptiveTask& task) {
    const SampleLevels& levels = *task.pattern.levels();
    const SampleDomains domains{task.context.camera.has_lens(), task.context.motion};
    noise_.resize(all_.size());
    for (const PixelPlace& pixel : all_)
        noise_[at(pixel.x, pixel.y)] =
            pixel_noise(gathered_.first_colors(pixel), gathered_.first_times(pixel), levels.samples(0),
                        levels.neighbours(task.pattern.variant_of(pixel)), domains);
}

/// The mean over pixels around one in the square; infinite where there are none.
template <class NoiseOf>
float AdaptiveTile::mean_around(const PixelPlace& pixel, int reach, const NoiseOf& noise_of) const {
    float sum = 0;
    int count = 0;
    for (int y = std::max(pixel.y - reach, pixels_.y0); y <= std::min(pixel.y + reach, pixels_.y1 - 1); ++y)
        for (int x = std::max(pixel.x - reach, pixels_.x0); x <= std::min(pixel.x + reach, pixels_.x1 - 1);
             ++x)
            if (x != pixel.x || y != pixel.y) sum += noise_of(noise_[at(x, y)]), ++count;
    return count > 0 ? sum / static_cast<float>(count) : kInfinity;
}

/// The level whose samples are nearest by ratio to what a pixel needs.
int AdaptiveTile::wanted_level(const AdaptiveTask& task, const PixelPlace& pixel) const {
    const SampleLevels& levels = *task.pattern.levels();
    const auto most = static_cast<float>(levels.samples(levels.top()));
    const float noise = mean_around(pixel, kSharpReach, [](const PixelNoise& n) { return n.sharp; }) +
                        mean_around(pixel, kBlurredReach, [](const PixelNoise& n) { return n.blurred; });
    const float needed = std::sqrt(noise * most / task.context.pixel_variance);
    int level = 0;
    // Levels are a factor of four apart.
    while (level < levels.top() && needed > 2 * static_cast<float>(levels.samples(level))) ++level;
    return level;
}

}  // namespace trapeze
