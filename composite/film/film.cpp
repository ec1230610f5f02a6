#include "composite/film/film.h"

#include <algorithm>
#include <cmath>

#include "composite/film/film_part.h"
#include "composite/film/gathered_samples.h"
#include "composite/film/pixel_samples.h"
#include "composite/film/pixel_summer.h"
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
    : aovs_(aov_layout(context.scene->options)), kernel_(context.scene->options.filter, context.diagnostics) {
    const Options& options = context.scene->options;
    gain_ = options.exposure_gain;
    inverse_gamma_ = leave_gamma ? 1.0f : inverse_of_gamma(options.exposure_gamma);

    if (const std::vector<MatteLayer> layers = matte_layers(options); !layers.empty()) {
        matte_keys_ = MatteKeys(*context.scene, layers, *context.diagnostics);
        matte_kernel_.emplace(matte_filter(options.filter));
        rules_.layers.keys = &matte_keys_, rules_.layers.kernel = &*matte_kernel_;
    }
    rules_.layers.deep_tolerance = deep_tolerance(options);
    rules_.aovs = &aovs_;
    rules_.depth_filter = depth_filter_of(context);
    rules_.depth_rule = depth_rule(options);
    rules_.wants_primitives = record_ids || wants_ids(options);

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
    if (rules_.layers.deep_tolerance) image_.deep.resize(count);
    if (rules_.wants_primitives) image_.id.assign(count, kNoPrimitive);

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
    stack.begin(sample_count, aovs_, rules_.depth_rule, rules_.layers.want_layers());
}

void Film::add(const GatheredSamples& gathered) {
    add_tiles(gathered.pixels(), [&](const PixelRect& pixels) {
        auto sums = make_sums(pixels, gathered.shows_something());
        gathered.sum(pixels, kernel_, *sums,
                     [this](int px, int py, const PixelRecord& record) { record_pixel(px, py, record); });
        return sums;
    });
}

void Film::add_part(const FilmPart& whole) {
    add_tiles(whole.pixels, [&](const PixelRect& pixels) {
        const FilmPart part{pixels, whole.samples, whole.hits, whole.grids, whole.stack};
        auto sums = make_sums(pixels, part.hits_anything());
        accumulate(part, *sums);
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

/// Adds what a tile's samples see to its sums, a pixel's together.
void Film::accumulate(const FilmPart& part, TileSums& sums) {
    const auto count = static_cast<size_t>(part.samples.samples_per_pixel);
    const bool sees_something = sums.channels(Sum::Color) > 0;
    PixelSamples samples(rules_, count);
    PixelSummer summer(kernel_, rules_, count);
    for (int py = part.pixels.y0; py < part.pixels.y1; ++py)
        for (int px = part.pixels.x0; px < part.pixels.x1; ++px) {
            const size_t first = part.first_of(px, py);
            if (sees_something) samples.see(part, first);
            const PixelRecord record = summer.add(px, py, part.samples.x.data() + first,
                                                  part.samples.y.data() + first, samples, sums);
            if (sees_something) record_pixel(px, py, record);
        }
}

/// Whether a pixel is kept, and not one that an earlier run has finished.
bool Film::takes_pixel(int px, int py) const {
    return image_.window.contains(px, py) &&
           !tiles_[tiles_.of_pixel(px, py)].finished.load(std::memory_order_relaxed);
}

/// Records what is of the samples within a pixel alone; these all lie in one tile.
void Film::record_pixel(int px, int py, const PixelRecord& record) {
    if (!takes_pixel(px, py)) return;
    const size_t at = image_.index(px, py);
    image_.z[at] = record.depth;
    if (!image_.id.empty()) image_.id[at] = record.primitive;
    // To these channels nothing is added but 0.
    if (record.variables) {
        const std::vector<float>& values = record.variables->values();
        std::copy(values.begin(), values.end(),
                  image_.aovs.begin() + static_cast<std::ptrdiff_t>(values.size() * at));
    }
    if (record.layers && rules_.layers.deep_tolerance) {
        std::vector<DeepSample> samples = record.layers->deep_samples();
        // Exposure's gain is a picture's, too, but not its gamma: deep samples add up.
        for (DeepSample& sample : samples)
            for (int c = 0; c < 3; ++c) sample.rgba[c] *= gain_;
        image_.deep[at] = std::move(samples);
    }
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
