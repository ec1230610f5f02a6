#include "composite/film/film.h"

#include <algorithm>
#include <cmath>

#include "composite/film/film_part.h"
#include "composite/film/gathered_samples.h"
#include "composite/film/pixel_depth.h"
#include "composite/film/pixel_sums.h"
#include "composite/film/pixel_variables.h"
#include "composite/film/tile_sums.h"
#include "composite/filters/exposure.h"
#include "core/scene/deep_pictures.h"

namespace trapeze {
namespace {

/// A rectangle with x more columns and y more rows on either side.
PixelRect grown(const PixelRect& r, int x, int y) {
    return {r.x0 - x, r.y0 - y, r.x1 + x, r.y1 + y};
}

/// depth_filter() with a warning where the name is not known.
DepthFilter depth_filter_of(const RenderContext& context) {
    const DepthFilter filter = depth_filter(context.scene->options);
    const std::string name = depth_filter_name(context.scene->options);
    if (filter == DepthFilter::Min && name != "min" && context.diagnostics)
        context.diagnostics->warning(
            {}, "Hider \"depthfilter\" \"" + name + "\" is not supported; min is used", "depthfilter");
    return filter;
}

bool wants_ids(const Options& options) {
    return std::any_of(options.displays.begin(), options.displays.end(),
                       [](const Display& display) { return display.mode == "id"; });
}

}  // namespace

Film::Film(const RenderContext& context, bool record_ids, bool leave_gamma)
    : aovs_(aov_layout(context.scene->options)),
      kernel_(context.scene->options.filter, context.diagnostics),
      depth_filter_(depth_filter_of(context)) {
    const Options& options = context.scene->options;
    gain_ = options.exposure_gain;
    inverse_gamma_ = leave_gamma ? 1.0f : inverse_of_gamma(options.exposure_gamma);

    if (const std::vector<MatteLayer> layers = matte_layers(options); !layers.empty()) {
        matte_keys_ = MatteKeys(*context.scene, layers, *context.diagnostics);
        matte_kernel_.emplace(matte_filter(options.filter));
        layer_rules_.keys = &matte_keys_, layer_rules_.kernel = &*matte_kernel_;
    }
    layer_rules_.deep_tolerance = deep_tolerance(options);

    image_.width = context.camera.width, image_.height = context.camera.height;
    image_.window = context.camera.crop;
    if (image_.window.empty()) return;
    const size_t count = static_cast<size_t>(image_.window.width()) * image_.window.height();
    image_.rgba.resize(4 * count);
    image_.z.assign(count, kInfinity);
    image_.aov_channels = aovs_.channel_count;
    image_.aovs.resize(static_cast<size_t>(aovs_.channel_count) * count);
    image_.matte_floats = kMatteFloats * static_cast<int>(matte_keys_.layer_count());
    image_.mattes.resize(static_cast<size_t>(image_.matte_floats) * count);
    if (layer_rules_.deep_tolerance) image_.deep.resize(count);
    if (record_ids || wants_ids(options)) image_.id.assign(count, kNoPrimitive);

    const PixelRect sampled = intersection(sampled_pixels(context.camera, options),
                                           grown(image_.window, kernel_.reach_x(), kernel_.reach_y()));
    tiles_ = FilmTiles(sampled, image_.window, kernel_.reach_x(), kernel_.reach_y());
}

Film::~Film() = default;

void Film::add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) {
    add_part({samples.pixels, samples, hits, grids});
}

void Film::add(const SampleTile& samples, const LayerStack& stack) {
    add_part(part_of_stack(samples, stack));
}

void Film::begin_stack(size_t sample_count, LayerStack& stack) const {
    stack.begin(sample_count, aovs_, depth_filter_ == DepthFilter::Midpoint, layer_rules_.want_layers());
}

void Film::add(const GatheredSamples& gathered) {
    add_tiles(gathered.pixels(), [&](const PixelRect& pixels) {
        auto sums = make_sums(pixels, gathered.shows_something());
        gathered.sum(pixels, kernel_, *sums,
                     [this](int px, int py, const GatheredSamples::PixelRecord& record) {
                         record_pixel(px, py, record.depth, record.primitive);
                         if (record.variables) record_variables(px, py, *record.variables);
                         if (record.layers && layer_rules_.deep_tolerance)
                             record_deep(px, py, record.layers->deep_samples());
                     });
        return sums;
    });
}

GatherRules Film::gather_rules() const {
    return {&aovs_, depth_filter_, layer_rules_};
}

void Film::add_part(const FilmPart& whole) {
    add_tiles(whole.pixels, [&](const PixelRect& pixels) {
        const FilmPart part{pixels, whole.samples, whole.hits, whole.grids, whole.stack};
        auto sums = make_sums(pixels, part.hits_anything());
        accumulate(part, *sums);
        if (sums->channels(Sum::Aov) > 0) accumulate_aovs(part, *sums);
        if (layer_rules_.want_layers()) accumulate_layers(part, *sums);
        return sums;
    });
}

std::unique_ptr<TileSums> Film::make_sums(const PixelRect& tile, bool colored) const {
    auto sums = std::make_unique<TileSums>(tile, kernel_, colored, aovs_.channel_count);
    if (matte_kernel_) sums->mattes.emplace(matte_kernel_->footprint(tile));
    return sums;
}

template <class SumsOf>
void Film::add_tiles(const PixelRect& pixels, const SumsOf& sums_of) {
    tiles_.for_each_in(pixels, [&](int tile) { add_tile(tile, pixels, sums_of); });
}

template <class SumsOf>
void Film::add_tile(int index, const PixelRect& pixels, const SumsOf& sums_of) {
    FilmTiles::Tile& tile = tiles_[index];
    // A tile counts once, whoever brings it.
    if (tile.added.exchange(true)) return;
    std::unique_ptr<TileSums> sums = sums_of(intersection(tiles_.square(index), pixels));
    develop_inner(index, *sums);
    if (tile.readers.load(std::memory_order_relaxed) > 0) {
        waiting_bytes_.fetch_add(sums->bytes(), std::memory_order_relaxed);
        tile.sums = std::move(sums);
    }
    tiles_.for_each_neighbour(index, [&](int to) {
        if (!tiles_.reaches(index, to)) return;
        // Acquire and release: whoever takes the last one sees the sums of all.
        if (tiles_[to].missing.fetch_sub(1, std::memory_order_acq_rel) == 1) finish_tile(to);
    });
}

/// Adds weights and colours of a tile's samples: all of a pixel together where that pays; else the usual
/// filters' sizes are compiled in.
void Film::accumulate(const FilmPart& part, TileSums& sums) {
    if (PixelSums::suits(kernel_, part.samples.samples_per_pixel)) return accumulate_pixels(part, sums);
    const int taps = kernel_.taps_x() == kernel_.taps_y() ? kernel_.taps_x() : 0;
    if (taps == 1) return accumulate_taps<1>(part, sums);
    if (taps == 2) return accumulate_taps<2>(part, sums);
    if (taps == 3) return accumulate_taps<3>(part, sums);
    if (taps == 4) return accumulate_taps<4>(part, sums);
    accumulate_taps<0>(part, sums);
}

void Film::accumulate_pixels(const FilmPart& part, TileSums& sums) {
    constexpr float kNothing[4] = {};
    const SampleTile& samples = part.samples;
    const auto count = static_cast<size_t>(samples.samples_per_pixel);
    const bool midpoint = depth_filter_ == DepthFilter::Midpoint;
    const bool colored = sums.channels(Sum::Color) > 0, ids = !image_.id.empty();
    PixelSums pixel(kernel_, samples.samples_per_pixel);
    HitLayers layers;
    for (int py = part.pixels.y0; py < part.pixels.y1; ++py) {
        if (colored) part.interpolate_row(py, layers);
        for (int px = part.pixels.x0; px < part.pixels.x1; ++px) {
            const size_t first = part.first_of(px, py);
            PixelDepth depth(depth_filter_);
            CentrePrimitive primitive(px, py);
            bool seen = false;
            for (size_t s = 0; s < count && colored; ++s) {
                const size_t sample = first + s;
                if (!part.has_hits(sample)) {
                    if (ids) primitive.add(samples.x[sample], samples.y[sample], kNoPrimitive);
                    pixel.set_color(s, kNothing);
                    continue;
                }
                const SampleColor color = part.color(sample, layers, midpoint);
                pixel.set_color(s, color.rgba);
                seen = true;
                depth.add(color.depth);
                if (ids) primitive.add(samples.x[sample], samples.y[sample], color.primitive);
            }
            pixel.sum(samples.x.data() + first, samples.y.data() + first, px, py, seen);
            sums.add(px - kernel_.reach_x(), py - kernel_.reach_y(), pixel, seen);
            if (colored) record_pixel(px, py, depth.value(), primitive.value());
        }
    }
}

/// Adds a tile's samples and records its pixels' depths. kTaps: taps along both axes; 0: as the kernel has
/// them.
template <int kTaps>
void Film::accumulate_taps(const FilmPart& part, TileSums& sums) {
    constexpr float kOne = 1;
    const SampleTile& samples = part.samples;
    std::vector<float> weights(kernel_.tap_count());
    const bool midpoint = depth_filter_ == DepthFilter::Midpoint;
    const bool colored = sums.channels(Sum::Color) > 0, ids = !image_.id.empty();
    HitLayers layers;
    for (int py = part.pixels.y0; py < part.pixels.y1; ++py) {
        if (colored) part.interpolate_row(py, layers);
        for (int px = part.pixels.x0; px < part.pixels.x1; ++px) {
            PixelDepth depth(depth_filter_);
            CentrePrimitive primitive(px, py);
            for (size_t sample = part.first_of(px, py); sample < part.first_of(px + 1, py); ++sample) {
                const float x = samples.x[sample], y = samples.y[sample];
                const FilterTaps taps = kernel_.weigh<kTaps>(x, y, px, py, weights.data());
                sums.add<kTaps, 1>(Sum::Weight, taps, weights.data(), &kOne);
                if (!colored || !part.has_hits(sample)) {
                    if (ids) primitive.add(x, y, kNoPrimitive);
                    continue;
                }
                const SampleColor color = part.color(sample, layers, midpoint);
                sums.add<kTaps, 4>(Sum::Color, taps, weights.data(), color.rgba);
                depth.add(color.depth);
                if (ids) primitive.add(x, y, color.primitive);
            }
            if (colored) record_pixel(px, py, depth.value(), primitive.value());
        }
    }
}

/// Adds output variables, in a pass of their own, so that pictures without them pay nothing.
void Film::accumulate_aovs(const FilmPart& part, TileSums& sums) {
    const SampleTile& samples = part.samples;
    std::vector<float> weights(kernel_.tap_count()), values(sums.channels(Sum::Aov));
    const bool all_summed = aovs_.all_summed();
    PixelVariables kept(aovs_);
    for (int py = part.pixels.y0; py < part.pixels.y1; ++py)
        for (int px = part.pixels.x0; px < part.pixels.x1; ++px) {
            kept.begin();
            for (size_t sample = part.first_of(px, py); sample < part.first_of(px + 1, py); ++sample) {
                if (!part.has_hits(sample)) continue;
                const float depth = part.variables(sample, aovs_, values.data());
                if (!all_summed) kept.take(values.data(), depth);
                const FilterTaps taps =
                    kernel_.weigh(samples.x[sample], samples.y[sample], px, py, weights.data());
                sums.add<0, 0>(Sum::Aov, taps, weights.data(), values.data());
            }
            if (!all_summed) record_variables(px, py, kept);
        }
}

void Film::accumulate_layers(const FilmPart& part, TileSums& sums) {
    const SampleTile& samples = part.samples;
    LayerSums pixel(layer_rules_);
    std::vector<SeenLayer> layers;
    for (int py = part.pixels.y0; py < part.pixels.y1; ++py)
        for (int px = part.pixels.x0; px < part.pixels.x1; ++px) {
            pixel.begin(px, py);
            for (size_t sample = part.first_of(px, py); sample < part.first_of(px + 1, py); ++sample) {
                layers.clear();
                if (sums.channels(Sum::Color) > 0 && part.has_hits(sample)) part.see(sample, layers);
                pixel.add(layers, samples.x[sample], samples.y[sample], 1,
                          sums.mattes ? &*sums.mattes : nullptr);
            }
            if (layer_rules_.deep_tolerance) record_deep(px, py, pixel.deep_samples());
        }
}

/// Whether a pixel is kept, and not one that an earlier run has finished.
bool Film::takes_pixel(int px, int py) const {
    return image_.window.contains(px, py) &&
           !tiles_[tiles_.of_pixel(px, py)].finished.load(std::memory_order_relaxed);
}

/// Exposure's gain is a picture's, too, but not its gamma: deep samples add up.
void Film::record_deep(int px, int py, std::vector<DeepSample> samples) {
    if (!takes_pixel(px, py)) return;
    for (DeepSample& sample : samples)
        for (int c = 0; c < 3; ++c) sample.rgba[c] *= gain_;
    image_.deep[image_.index(px, py)] = std::move(samples);
}

/// Records a pixel's depth and id, which are of the samples within the pixel alone; these all lie in one
/// tile.
void Film::record_pixel(int px, int py, float depth, uint32_t primitive) {
    if (!takes_pixel(px, py)) return;
    const size_t at = image_.index(px, py);
    image_.z[at] = depth;
    if (!image_.id.empty()) image_.id[at] = primitive;
}

/// Records what a pixel keeps of variables. To these channels nothing is added but 0.
void Film::record_variables(int px, int py, const PixelVariables& variables) {
    if (!takes_pixel(px, py)) return;
    std::copy(
        variables.values().begin(), variables.values().end(),
        image_.aovs.begin() + static_cast<std::ptrdiff_t>(variables.values().size() * image_.index(px, py)));
}

Image Film::finish() {
    for (int tile = 0; tile < tiles_.count(); ++tile)
        if (tiles_[tile].missing.load(std::memory_order_acquire) > 0) develop_rest(tile);
    tiles_ = {};
    waiting_bytes_ = 0;
    image_.matte_loss = matte_loss_;
    return std::move(image_);
}

}  // namespace trapeze
