#include "composite/film/gathered_samples.h"

#include <algorithm>
#include <memory>

#include "composite/film/film_part.h"
#include "composite/film/pixel_depth.h"
#include "composite/film/pixel_sums.h"
#include "composite/film/pixel_variables.h"
#include "composite/film/tile_sums.h"

namespace trapeze {

void GatheredSamples::begin(const PixelRect& pixels, size_t most, const GatherRules& rules) {
    pixels_ = pixels, most_ = most, rules_ = rules;
    shows_something_ = false;
    slots_.assign(static_cast<size_t>(pixels.width()) * static_cast<size_t>(pixels.height()), {});
    for (auto* values : {&rgba_, &x_, &y_, &times_, &aovs_}) values->clear();
    seen_.clear(), numbers_.clear();
    layers_.clear(), first_layer_.assign(1, 0);
}

void GatheredSamples::begin_stack(size_t sample_count, LayerStack& stack) const {
    stack.begin(sample_count, *rules_.aovs, rules_.depth_filter == DepthFilter::Midpoint,
                rules_.layers.want_layers());
}

void GatheredSamples::add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) {
    append({samples.pixels, samples, hits, grids});
}

void GatheredSamples::add(const SampleTile& samples, const LayerStack& stack) {
    append(part_of_stack(samples, stack));
}

void GatheredSamples::append(const FilmPart& part) {
    const SampleTile& samples = part.samples;
    const bool midpoint = rules_.depth_filter == DepthFilter::Midpoint;
    const auto channels = static_cast<size_t>(rules_.aovs->channel_count);
    const auto per_pixel = static_cast<size_t>(samples.samples_per_pixel);
    const size_t before = seen_.size(), all = before + samples.size();
    HitLayers layers;
    seen_.resize(all), rgba_.resize(4 * all), aovs_.resize(channels * all);
    for (size_t first = 0, pixel = 0; first < samples.size(); first += per_pixel, ++pixel) {
        // Layers of a pixel at a time stay in the cache.
        part.interpolate(first, first + per_pixel, layers);
        for (size_t s = first; s < first + per_pixel; ++s) {
            Seen& seen = seen_[before + s];
            float* const rgba = &rgba_[4 * (before + s)];
            seen = {kInfinity, kNoPrimitive, part.has_hits(s), kInfinity};
            if (rules_.layers.want_layers()) {
                if (seen.has_hits) part.see(s, layers_);
                first_layer_.push_back(layers_.size());
            }
            if (!seen.has_hits) {
                std::fill_n(rgba, 4, 0.0f);
                continue;
            }
            shows_something_ = true;
            const SampleColor color = part.color(s, layers, midpoint);
            std::copy_n(color.rgba, 4, rgba);
            seen.depth = color.depth, seen.primitive = color.primitive;
            if (channels == 0) continue;
            seen.variables_depth = part.variables(s, *rules_.aovs, &aovs_[channels * (before + s)]);
        }
        Slot& slot = slots_[index(samples.listed[pixel])];
        const size_t row = slot.counts[0] > 0 ? 1 : 0;
        slot.first[row] = static_cast<uint32_t>(before + first);
        slot.counts[row] = static_cast<uint32_t>(per_pixel);
    }
    const auto append_to = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append_to(x_, samples.x), append_to(y_, samples.y), append_to(times_, samples.time);
    append_to(numbers_, samples.in_pixel);
}

/// Sums up pixels that have some number of samples.
class GatheredSamples::PixelSummer {
  public:
    PixelSummer(const GatheredSamples& gathered, const FilterKernel& kernel, size_t count)
        : from_(gathered),
          kernel_(kernel),
          share_(static_cast<float>(gathered.most_) / static_cast<float>(count)),
          weights_(static_cast<size_t>(kernel.tap_count())),
          order_(count),
          x_(count),
          y_(count),
          values_(static_cast<size_t>(gathered.rules_.aovs->channel_count)),
          all_summed_(gathered.rules_.aovs->all_summed()),
          kept_(*gathered.rules_.aovs),
          layers_(gathered.rules_.layers) {
        if (PixelSums::suits(kernel, static_cast<int>(count)))
            planes_ = std::make_unique<PixelSums>(kernel, static_cast<int>(count));
    }
    size_t count() const { return order_.size(); }

    void add(int px, int py, const Slot& slot, TileSums& sums, const RecordPixel& record) {
        put_in_order(slot);
        PixelDepth depth(from_.rules_.depth_filter);
        CentrePrimitive primitive(px, py);
        bool shows_something = false;
        for (size_t place = 0; place < count(); ++place) {
            const size_t sample = order_[place];
            const Seen& seen = from_.seen_[sample];
            x_[place] = from_.x_[sample], y_[place] = from_.y_[sample];
            if (planes_) planes_->set_color(place, &from_.rgba_[4 * sample]);
            primitive.add(x_[place], y_[place], seen.primitive);
            if (seen.has_hits) shows_something = true, depth.add(seen.depth);
        }
        if (planes_) {
            planes_->sum(x_.data(), y_.data(), px, py, shows_something);
            sums.add(px - kernel_.reach_x(), py - kernel_.reach_y(), *planes_, shows_something, share_);
        }
        if (!planes_ || sums.channels(Sum::Aov) > 0) add_one_by_one(px, py, sums);
        if (from_.rules_.layers.want_layers()) add_layers(px, py, sums);
        if (sums.channels(Sum::Color) > 0)
            record(px, py,
                   {depth.value(), primitive.value(), all_summed_ ? nullptr : &kept_,
                    from_.rules_.layers.want_layers() ? &layers_ : nullptr});
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

    void add_layers(int px, int py, TileSums& sums) {
        layers_.begin(px, py);
        for (size_t place = 0; place < count(); ++place)
            layers_.add(from_.layers_of(order_[place]), x_[place], y_[place], share_,
                        sums.mattes ? &*sums.mattes : nullptr);
    }

    /// What is not summed in planes.
    void add_one_by_one(int px, int py, TileSums& sums) {
        constexpr float kOne = 1;
        const size_t channels = sums.channels(Sum::Aov);
        kept_.begin();
        for (size_t place = 0; place < count(); ++place) {
            const size_t sample = order_[place];
            const FilterTaps taps = kernel_.weigh(x_[place], y_[place], px, py, weights_.data());
            for (float& weight : weights_) weight *= share_;
            if (!planes_) sums.add<0, 1>(Sum::Weight, taps, weights_.data(), &kOne);
            if (!from_.seen_[sample].has_hits) continue;
            if (!planes_) sums.add<0, 4>(Sum::Color, taps, weights_.data(), &from_.rgba_[4 * sample]);
            if (channels == 0) continue;
            std::copy_n(&from_.aovs_[channels * sample], channels, values_.data());
            if (!all_summed_) kept_.take(values_.data(), from_.seen_[sample].variables_depth);
            sums.add<0, 0>(Sum::Aov, taps, weights_.data(), values_.data());
        }
    }

    const GatheredSamples& from_;
    const FilterKernel& kernel_;
    const float share_;  ///< how many times over each sample counts
    std::vector<float> weights_;
    std::vector<size_t> order_;
    std::vector<float> x_, y_;
    std::vector<float> values_;  ///< of output variables, of one sample
    const bool all_summed_;
    PixelVariables kept_;
    LayerSums layers_;
    std::unique_ptr<PixelSums> planes_;
};

void GatheredSamples::sum(const PixelRect& part, const FilterKernel& kernel, TileSums& sums,
                          const RecordPixel& record) const {
    std::vector<std::unique_ptr<PixelSummer>> summers;  // few: one for each level
    const auto summer_of = [&](size_t count) -> PixelSummer& {
        for (const auto& one : summers)
            if (one->count() == count) return *one;
        return *summers.emplace_back(std::make_unique<PixelSummer>(*this, kernel, count));
    };
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x) {
            const Slot& slot = slots_[index({x, y})];
            if (slot.count() > 0) summer_of(slot.count()).add(x, y, slot, sums, record);
        }
}

}  // namespace trapeze
