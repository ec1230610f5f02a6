#include "composite/film/film.h"

#include <algorithm>
#include <cmath>

#include "composite/film/resolve_layers.h"

namespace trapeze {
namespace {

int tile_of(int pixel) {
    return pixel >= 0 ? pixel / kTileSide : -((kTileSide - 1 - pixel) / kTileSide);
}

PixelRect grown(const PixelRect& r, int x, int y) {
    return {r.x0 - x, r.y0 - y, r.x1 + x, r.y1 + y};
}

std::string depth_filter_name(const Options& options) {
    return options.hider_parameters.string_or("depthfilter", "min");
}

/// The same with a warning where the name is not known.
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

/// The depths of a pixel's samples, in their order.
class PixelDepth {
  public:
    explicit PixelDepth(DepthFilter filter) : filter_(filter) {}

    void add(float depth) {
        if (depth >= kInfinity) return;
        if (count_ == 0)
            value_ = depth;
        else if (filter_ == DepthFilter::Min || filter_ == DepthFilter::Midpoint)
            value_ = std::min(value_, depth);
        else if (filter_ == DepthFilter::Max)
            value_ = std::max(value_, depth);
        else
            value_ += depth;
        ++count_;
    }
    float value() const {
        if (count_ == 0) return kInfinity;
        return filter_ == DepthFilter::Average ? value_ / static_cast<float>(count_) : value_;
    }

  private:
    DepthFilter filter_;
    float value_ = 0;
    int count_ = 0;
};

/// What the sample nearest a pixel's centre sees; the first of equals.
class CentrePrimitive {
  public:
    CentrePrimitive(int px, int py) : x_(static_cast<float>(px) + 0.5f), y_(static_cast<float>(py) + 0.5f) {}

    void add(float x, float y, uint32_t primitive) {
        const float dx = x - x_, dy = y - y_, distance = dx * dx + dy * dy;
        if (distance < nearest_) nearest_ = distance, primitive_ = primitive;
    }
    uint32_t value() const { return primitive_; }

  private:
    float x_, y_;
    float nearest_ = kInfinity;
    uint32_t primitive_ = kNoPrimitive;
};

}  // namespace

DepthFilter depth_filter(const Options& options) {
    const std::string name = depth_filter_name(options);
    if (name == "max") return DepthFilter::Max;
    if (name == "average") return DepthFilter::Average;
    return name == "midpoint" ? DepthFilter::Midpoint : DepthFilter::Min;
}

/// A tile's own sums, over its pixels and all that its samples may reach.
struct Film::Sums {
    PixelRect pixels;
    std::vector<float> weights;  ///< one a pixel
    std::vector<float> rgba;     ///< four a pixel; empty when no sample hits anything
    std::vector<float> aovs;     ///< channels of output variables, `aov_channels` a pixel; empty with rgba

    Sums(const PixelRect& tile, const FilterKernel& kernel, bool colored, int aov_channels)
        : pixels(kernel.footprint(tile)) {
        const size_t count = static_cast<size_t>(pixels.width()) * pixels.height();
        weights.resize(count);
        if (!colored) return;
        rgba.resize(4 * count);
        aovs.resize(static_cast<size_t>(aov_channels) * count);
    }
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - pixels.y0) * pixels.width() + static_cast<size_t>(x - pixels.x0);
    }
    size_t bytes() const { return sizeof(float) * (weights.size() + rgba.size() + aovs.size()); }
};

struct Film::Tile {
    /// Set by the thread that adds the tile, before it lowers the neighbours' `missing`.
    std::unique_ptr<Sums> sums;
    /// Tiles that this one's pixels wait for. At 0 they are developed, or none of them is in the crop.
    std::atomic<int> missing{0};
    /// Tiles whose pixels still need `sums`.
    std::atomic<int> readers{0};
    std::atomic<bool> added{false};
};

Film::Film(const RenderContext& context, bool record_ids)
    : aovs_(aov_layout(context.scene->options)),
      kernel_(context.scene->options.filter, context.diagnostics),
      depth_filter_(depth_filter_of(context)) {
    const Options& options = context.scene->options;
    gain_ = options.exposure_gain;
    inverse_gamma_ = options.exposure_gamma > 0 ? 1 / options.exposure_gamma : 1.0f;

    image_.width = context.camera.width, image_.height = context.camera.height;
    image_.window = context.camera.crop;
    if (image_.window.empty()) return;
    const size_t count = static_cast<size_t>(image_.window.width()) * image_.window.height();
    image_.rgba.resize(4 * count);
    image_.z.assign(count, kInfinity);
    image_.aov_channels = aovs_.channel_count;
    image_.aovs.resize(static_cast<size_t>(aovs_.channel_count) * count);
    if (record_ids || wants_ids(options)) image_.id.assign(count, kNoPrimitive);

    sampled_ = intersection(sampled_pixels(context.camera, options),
                            grown(image_.window, kernel_.reach_x(), kernel_.reach_y()));
    first_tile_x_ = tile_of(sampled_.x0), first_tile_y_ = tile_of(sampled_.y0);
    tiles_x_ = tile_of(sampled_.x1 - 1) + 1 - first_tile_x_;
    tiles_y_ = tile_of(sampled_.y1 - 1) + 1 - first_tile_y_;
    tile_reach_x_ = (kernel_.reach_x() + kTileSide - 1) / kTileSide;
    tile_reach_y_ = (kernel_.reach_y() + kTileSide - 1) / kTileSide;
    const int tile_count = tiles_x_ * tiles_y_;
    tiles_ = std::make_unique<Tile[]>(tile_count);
    for (int tile = 0; tile < tile_count; ++tile)
        for_each_neighbour(tile, [&](int from) {
            if (!reaches(from, tile)) return;
            tiles_[tile].missing.fetch_add(1, std::memory_order_relaxed);
            tiles_[from].readers.fetch_add(1, std::memory_order_relaxed);
        });
}

Film::~Film() = default;

PixelRect Film::tile_pixels(int tile) const {
    const int x = (first_tile_x_ + tile % tiles_x_) * kTileSide,
              y = (first_tile_y_ + tile / tiles_x_) * kTileSide;
    return intersection({x, y, x + kTileSide, y + kTileSide}, sampled_);
}

bool Film::reaches(int from, int to) const {
    const PixelRect reached = grown(tile_pixels(from), kernel_.reach_x(), kernel_.reach_y());
    return !intersection(intersection(reached, tile_pixels(to)), image_.window).empty();
}

template <class Visit>
void Film::for_each_neighbour(int tile, Visit&& visit) const {
    const int column = tile % tiles_x_, row = tile / tiles_x_;
    for (int y = std::max(0, row - tile_reach_y_); y <= std::min(tiles_y_ - 1, row + tile_reach_y_); ++y)
        for (int x = std::max(0, column - tile_reach_x_); x <= std::min(tiles_x_ - 1, column + tile_reach_x_);
             ++x)
            visit(y * tiles_x_ + x);
}

void Film::add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) {
    if (samples.pixels.empty()) return;
    const int column = tile_of(samples.pixels.x0) - first_tile_x_,
              row = tile_of(samples.pixels.y0) - first_tile_y_;
    if (column < 0 || column >= tiles_x_ || row < 0 || row >= tiles_y_) return;
    const int index = row * tiles_x_ + column;
    Tile& tile = tiles_[index];
    if (tile.added.exchange(true)) return;
    const bool colored = !hits.hits.empty() && hits.size() == samples.size();
    auto sums = std::make_unique<Sums>(samples.pixels, kernel_, colored, aovs_.channel_count);
    accumulate(samples, hits, grids, *sums);
    if (!sums->aovs.empty()) accumulate_aovs(samples, hits, grids, *sums);
    if (tile.readers.load(std::memory_order_relaxed) > 0) {
        waiting_bytes_.fetch_add(sums->bytes(), std::memory_order_relaxed);
        tile.sums = std::move(sums);
    }
    for_each_neighbour(index, [&](int to) {
        // Acquire and release: whoever takes the last one sees the sums of all.
        if (reaches(index, to) && tiles_[to].missing.fetch_sub(1, std::memory_order_acq_rel) == 1) settle(to);
    });
}

/// The usual filters' sizes are compiled in.
void Film::accumulate(const SampleTile& samples, const HitBuffer& hits, const Grids& grids, Sums& sums) {
    const int taps = kernel_.taps_x() == kernel_.taps_y() ? kernel_.taps_x() : 0;
    if (taps == 1) return accumulate_taps<1>(samples, hits, grids, sums);
    if (taps == 2) return accumulate_taps<2>(samples, hits, grids, sums);
    if (taps == 3) return accumulate_taps<3>(samples, hits, grids, sums);
    if (taps == 4) return accumulate_taps<4>(samples, hits, grids, sums);
    accumulate_taps<0>(samples, hits, grids, sums);
}

template <int kTaps>
void Film::accumulate_taps(const SampleTile& samples, const HitBuffer& hits, const Grids& grids, Sums& sums) {
    std::vector<float> weights(kernel_.tap_count());
    const bool midpoint = depth_filter_ == DepthFilter::Midpoint;
    const bool colored = !sums.rgba.empty(), ids = !image_.id.empty();
    const auto row = static_cast<size_t>(samples.pixels.width()) * samples.samples_per_pixel;
    HitLayers layers;
    size_t sample = 0;
    for (int py = samples.pixels.y0; py < samples.pixels.y1; ++py) {
        if (colored) layers.interpolate(samples, hits, sample, std::min(sample + row, samples.size()), grids);
        for (int px = samples.pixels.x0; px < samples.pixels.x1; ++px) {
            const size_t end =
                std::min(samples.size(), sample + static_cast<size_t>(samples.samples_per_pixel));
            PixelDepth depth(depth_filter_);
            CentrePrimitive primitive(px, py);
            for (; sample < end; ++sample) {
                const auto seen = colored ? hits.of(sample) : std::span<const Hit>();
                const float x = samples.x[sample], y = samples.y[sample];
                if (seen.empty()) {
                    add_sample<kTaps>(x, y, px, py, nullptr, weights.data(), sums);
                    if (ids) primitive.add(x, y, kNoPrimitive);
                    continue;
                }
                const SampleColor color = resolve_layers(seen, layers, hits.first[sample], grids, midpoint);
                add_sample<kTaps>(x, y, px, py, color.rgba, weights.data(), sums);
                depth.add(color.depth);
                if (ids) primitive.add(x, y, color.primitive);
            }
            if (colored) record_pixel(px, py, depth.value(), primitive.value());
        }
    }
}

template <int kTaps>
void Film::add_sample(float x, float y, int px, int py, const float* rgba, float* weights, Sums& sums) const {
    const int nx = kTaps ? kTaps : kernel_.taps_x(), ny = kTaps ? kTaps : kernel_.taps_y();
    const FilterTaps taps = kernel_.weigh<kTaps>(x, y, px, py, weights);
    size_t row = sums.index(taps.x0, taps.y0);
    for (int j = 0; j < ny; ++j, row += sums.pixels.width(), weights += nx) {
        for (int i = 0; i < nx; ++i) sums.weights[row + i] += weights[i];
        if (!rgba) continue;
        for (int i = 0; i < nx; ++i)
            for (int c = 0; c < 4; ++c) sums.rgba[4 * (row + i) + c] += weights[i] * rgba[c];
    }
}

void Film::accumulate_aovs(const SampleTile& samples, const HitBuffer& hits, const Grids& grids,
                           Sums& sums) const {
    const auto channels = static_cast<size_t>(aovs_.channel_count);
    std::vector<float> weights(kernel_.tap_count()), values(channels);
    const int nx = kernel_.taps_x(), ny = kernel_.taps_y();
    size_t sample = 0;
    for (int py = samples.pixels.y0; py < samples.pixels.y1; ++py)
        for (int px = samples.pixels.x0; px < samples.pixels.x1; ++px) {
            const size_t end =
                std::min(samples.size(), sample + static_cast<size_t>(samples.samples_per_pixel));
            for (; sample < end; ++sample) {
                const auto seen = hits.of(sample);
                if (seen.empty()) continue;
                resolve_aovs(samples.rays[sample], seen, grids, aovs_, values.data());
                const FilterTaps taps =
                    kernel_.weigh(samples.x[sample], samples.y[sample], px, py, weights.data());
                for (int tap = 0; tap < nx * ny; ++tap) {
                    float* sum = &sums.aovs[channels * sums.index(taps.x0 + tap % nx, taps.y0 + tap / nx)];
                    for (size_t c = 0; c < channels; ++c) sum[c] += weights[tap] * values[c];
                }
            }
        }
}

/// Depth and id are of the samples within the pixel alone, which all lie in one tile.
void Film::record_pixel(int px, int py, float depth, uint32_t primitive) {
    const PixelRect& window = image_.window;
    if (px < window.x0 || px >= window.x1 || py < window.y0 || py >= window.y1) return;
    const size_t at = image_.index(px, py);
    image_.z[at] = depth;
    if (!image_.id.empty()) image_.id[at] = primitive;
}

/// All that a tile's pixels wait for is there.
void Film::settle(int tile) {
    develop(tile);
    for_each_neighbour(tile, [&](int from) {
        if (reaches(from, tile)) release(from);
    });
}

void Film::release(int tile) {
    if (tiles_[tile].readers.fetch_sub(1, std::memory_order_acq_rel) != 1 || !tiles_[tile].sums) return;
    waiting_bytes_.fetch_sub(tiles_[tile].sums->bytes(), std::memory_order_relaxed);
    tiles_[tile].sums.reset();
}

void Film::develop(int tile) {
    const PixelRect pixels = intersection(tile_pixels(tile), image_.window);
    const size_t count = static_cast<size_t>(pixels.width()) * pixels.height();
    std::vector<float> weights(count), colors(4 * count);
    for_each_neighbour(tile, [&](int from) {
        const Sums* sums = reaches(from, tile) ? tiles_[from].sums.get() : nullptr;
        if (!sums) return;
        const PixelRect shared = intersection(sums->pixels, pixels);
        for (int y = shared.y0; y < shared.y1; ++y)
            for (int x = shared.x0; x < shared.x1; ++x) {
                const size_t at = static_cast<size_t>(y - pixels.y0) * pixels.width() + (x - pixels.x0);
                const size_t source = sums->index(x, y);
                weights[at] += sums->weights[source];
                if (sums->rgba.empty()) continue;
                for (int c = 0; c < 4; ++c) colors[4 * at + c] += sums->rgba[4 * source + c];
            }
    });
    size_t at = 0;
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x, ++at) {
            if (weights[at] == 0) continue;
            float* rgba = &image_.rgba[4 * image_.index(x, y)];
            for (int c = 0; c < 4; ++c) rgba[c] = colors[4 * at + c] / weights[at];
            expose(rgba);
        }
    if (!aovs_.empty()) develop_aovs(tile, weights);
}

/// `weights` are the sums of the weights of the tile's pixels, those that develop() divides colours by.
void Film::develop_aovs(int tile, const std::vector<float>& weights) {
    const PixelRect pixels = intersection(tile_pixels(tile), image_.window);
    const auto channels = static_cast<size_t>(aovs_.channel_count);
    for_each_neighbour(tile, [&](int from) {
        const Sums* sums = reaches(from, tile) ? tiles_[from].sums.get() : nullptr;
        if (!sums || sums->aovs.empty()) return;
        const PixelRect shared = intersection(sums->pixels, pixels);
        for (int y = shared.y0; y < shared.y1; ++y)
            for (int x = shared.x0; x < shared.x1; ++x) {
                const float* source = &sums->aovs[channels * sums->index(x, y)];
                float* sum = &image_.aovs[channels * image_.index(x, y)];
                for (size_t c = 0; c < channels; ++c) sum[c] += source[c];
            }
    });
    size_t at = 0;
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x, ++at) {
            float* values = &image_.aovs[channels * image_.index(x, y)];
            for (size_t c = 0; c < channels; ++c) values[c] = weights[at] == 0 ? 0 : values[c] / weights[at];
        }
}

/// RISpec 4.1.2, Exposure: (colour * gain) ^ (1 / gamma). What filters of negative lobes make negative stays
/// so.
void Film::expose(float* rgba) const {
    for (int c = 0; c < 3; ++c) {
        rgba[c] *= gain_;
        if (inverse_gamma_ == 1) continue;
        const double power =
            std::pow(std::abs(static_cast<double>(rgba[c])), static_cast<double>(inverse_gamma_));
        rgba[c] = static_cast<float>(std::copysign(power, static_cast<double>(rgba[c])));
    }
}

Image Film::finish() {
    for (int tile = 0; tile < tiles_x_ * tiles_y_; ++tile)
        if (tiles_[tile].missing.load(std::memory_order_acquire) > 0) develop(tile);
    tiles_.reset();
    tiles_x_ = tiles_y_ = 0;
    waiting_bytes_ = 0;
    return std::move(image_);
}

}  // namespace trapeze
