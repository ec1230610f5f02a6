/// Samples of pixels that have as many as each needs, with what they show: what adaptive sampling looks at
/// while it takes more, and what the film gets in the end.
///
/// Every pixel has the same say in the picture: where it has a quarter of the samples that it may have, each
/// weighs four times as much. A picture whose rates differ is then the same in the mean as one
/// where all pixels have all samples, without borders between rates.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "composite/film/film_rules.h"
#include "composite/film/pixel_samples.h"
#include "composite/film/sample_sink.h"
#include "composite/filters/filters.h"

namespace trapeze {

struct FilmPart;
struct PixelRecord;
class TileSums;

/// One a thread, used again from rectangle to rectangle.
class GatheredSamples final : public SampleSink {
  public:
    /// Forgets all samples. `most`: samples that a pixel may have. The rules are a film's.
    void begin(const PixelRect& pixels, size_t most, const FilmRules& rules);

    /// Adds samples of listed pixels (SampleTile::listed), behind those that these have; in two goes at most.
    void add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) override;
    void add(const SampleTile& samples, const LayerStack& stack) override;
    void begin_stack(size_t sample_count, LayerStack& stack) const override;

    const PixelRect& pixels() const { return pixels_; }
    /// Colours and alpha of the samples with which a pixel began, four numbers each; and their times.
    const float* first_colors(const PixelPlace& pixel) const {
        return &rgba_[4 * slots_[index(pixel)].first[0]];
    }
    const float* first_times(const PixelPlace& pixel) const { return &times_[slots_[index(pixel)].first[0]]; }
    size_t sample_count(const PixelPlace& pixel) const { return slots_[index(pixel)].count(); }
    /// Whether any sample shows anything.
    bool shows_something() const { return shows_something_; }

    using RecordPixel = std::function<void(int x, int y, const PixelRecord& record)>;
    /// Adds weights, colours and variables of a part of the pixels.
    void sum(const PixelRect& part, const FilterKernel& kernel, TileSums& sums,
             const RecordPixel& record) const;

  private:
    /// Depth, primitive, and whether there are any hits.
    struct Seen {
        float depth;
        uint32_t primitive;
        bool has_hits;
        float variables_depth;  ///< as SeenSample's
    };
    /// Where a pixel's samples are: those with which it began, and those that came later.
    struct Slot {
        std::array<uint32_t, 2> first{}, counts{};

        size_t count() const { return size_t{counts[0]} + counts[1]; }
    };
    class Level;

    std::span<const SeenLayer> layers_of(size_t sample) const {
        return std::span(layers_).subspan(first_layer_[sample],
                                          first_layer_[sample + 1] - first_layer_[sample]);
    }

    size_t index(const PixelPlace& pixel) const {
        return static_cast<size_t>(pixel.y - pixels_.y0) * pixels_.width() +
               static_cast<size_t>(pixel.x - pixels_.x0);
    }
    void append(const FilmPart& part);
    void append(const PixelSamples& pixel);
    SeenSample of(size_t sample) const;

    PixelRect pixels_;
    size_t most_ = 0;
    const FilmRules* rules_ = nullptr;
    bool shows_something_ = false;
    std::vector<Slot> slots_;  ///< by pixel
    std::vector<Seen> seen_;
    std::vector<float> rgba_, x_, y_, times_, aovs_;  ///< colours, and variables, of one sample after another
    std::vector<uint16_t> numbers_;                   ///< of samples in their pixels
    std::vector<SeenLayer> layers_;                   ///< of one sample after another, where they are wanted
    std::vector<size_t> first_layer_;                 ///< of each sample, and the end
};

}  // namespace trapeze
