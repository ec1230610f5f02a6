#include "composite/film/gathered_samples.h"

#include <algorithm>
#include <memory>

#include "composite/film/film_part.h"
#include "composite/film/pixel_summer.h"
#include "composite/film/tile_sums.h"

namespace trapeze {

void GatheredSamples::begin(const PixelRect& pixels, size_t most, const FilmRules& rules) {
    pixels_ = pixels, most_ = most, rules_ = &rules;
    shows_something_ = false;
    slots_.assign(static_cast<size_t>(pixels.width()) * static_cast<size_t>(pixels.height()), {});
    for (auto* values : {&rgba_, &x_, &y_, &times_, &aovs_}) values->clear();
    seen_.clear(), numbers_.clear();
    layers_.clear(), first_layer_.assign(1, 0);
}

void GatheredSamples::begin_stack(size_t sample_count, LayerStack& stack) const {
    stack.begin(sample_count, *rules_->aovs, rules_->depth_rule, rules_->layers.want_layers());
}

void GatheredSamples::add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) {
    append({samples.pixels, samples, hits, grids});
}

void GatheredSamples::add(const SampleTile& samples, const LayerStack& stack) {
    append(part_of_stack(samples, stack));
}

void GatheredSamples::append(const FilmPart& part) {
    const SampleTile& samples = part.samples;
    const auto per_pixel = static_cast<size_t>(samples.samples_per_pixel);
    PixelSamples pixel(*rules_, per_pixel);
    for (size_t first = 0, number = 0; first < samples.size(); first += per_pixel, ++number) {
        Slot& slot = slots_[index(samples.listed[number])];
        const size_t row = slot.counts[0] > 0 ? 1 : 0;
        slot.first[row] = static_cast<uint32_t>(seen_.size());
        slot.counts[row] = static_cast<uint32_t>(per_pixel);
        pixel.see(part, first);
        append(pixel);
    }
    const auto append_to = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append_to(x_, samples.x), append_to(y_, samples.y), append_to(times_, samples.time);
    append_to(numbers_, samples.in_pixel);
}

void GatheredSamples::append(const PixelSamples& pixel) {
    shows_something_ |= pixel.sees_something();
    const auto channels = static_cast<size_t>(rules_->aovs->channel_count);
    for (size_t s = 0; s < pixel.count(); ++s) {
        const SeenSample seen = pixel.of(s);
        seen_.push_back({seen.depth, seen.primitive, seen.has_hits, seen.variables_depth});
        rgba_.insert(rgba_.end(), seen.rgba, seen.rgba + 4);
        aovs_.resize(aovs_.size() + channels);
        if (seen.variables)
            std::copy_n(seen.variables, channels, aovs_.end() - static_cast<std::ptrdiff_t>(channels));
        layers_.insert(layers_.end(), seen.layers.begin(), seen.layers.end());
        first_layer_.push_back(layers_.size());
    }
}

SeenSample GatheredSamples::of(size_t sample) const {
    const Seen& from = seen_[sample];
    SeenSample seen;
    seen.depth = from.depth, seen.primitive = from.primitive, seen.has_hits = from.has_hits;
    std::copy_n(&rgba_[4 * sample], 4, seen.rgba);
    seen.layers = layers_of(sample);
    if (const auto channels = static_cast<size_t>(rules_->aovs->channel_count); channels > 0)
        seen.variables = &aovs_[channels * sample], seen.variables_depth = from.variables_depth;
    return seen;
}

/// Sums up pixels that have some number of samples.
class GatheredSamples::Level {
  public:
    Level(const GatheredSamples& gathered, const FilterKernel& kernel, size_t count)
        : from_(gathered),
          order_(count),
          x_(count),
          y_(count),
          samples_(*gathered.rules_, count),
          summer_(kernel, *gathered.rules_, count,
                  static_cast<float>(gathered.most_) / static_cast<float>(count)) {}
    size_t count() const { return order_.size(); }

    PixelRecord add(int px, int py, const Slot& slot, TileSums& sums) {
        put_in_order(slot);
        samples_.begin();
        for (size_t place = 0; place < count(); ++place) {
            const size_t sample = order_[place];
            x_[place] = from_.x_[sample], y_[place] = from_.y_[sample];
            samples_.set(place, from_.of(sample));
        }
        return summer_.add(px, py, x_.data(), y_.data(), samples_, sums);
    }

  private:
    /// A pixel that has all samples has them in the order of a picture whose pixels all do: so it is the same
    /// to the bit. Others have them as they came.
    void put_in_order(const Slot& slot) {
        const bool whole = count() == from_.most_;
        size_t place = 0;
        for (size_t row = 0; row < 2; ++row)
            for (size_t s = slot.first[row]; s < size_t{slot.first[row]} + slot.counts[row]; ++s, ++place)
                order_[whole ? from_.numbers_[s] : place] = s;
    }

    const GatheredSamples& from_;
    std::vector<size_t> order_;
    std::vector<float> x_, y_;
    PixelSamples samples_;
    PixelSummer summer_;
};

void GatheredSamples::sum(const PixelRect& part, const FilterKernel& kernel, TileSums& sums,
                          const RecordPixel& record) const {
    std::vector<std::unique_ptr<Level>> levels;  // few
    const auto level_of = [&](size_t count) -> Level& {
        for (const auto& one : levels)
            if (one->count() == count) return *one;
        return *levels.emplace_back(std::make_unique<Level>(*this, kernel, count));
    };
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x) {
            const Slot& slot = slots_[index({x, y})];
            if (slot.count() == 0) continue;
            const PixelRecord of_pixel = level_of(slot.count()).add(x, y, slot, sums);
            if (shows_something_) record(x, y, of_pixel);
        }
}

}  // namespace trapeze
