/// A tile's own sums, over its pixels and all others that its samples may reach.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "composite/film/matte_sums.h"
#include "composite/film/pixel_sums.h"
#include "composite/filters/filters.h"
#include "core/scene/camera.h"

namespace trapeze {

/// What is summed, each with its channels: filter weights (1), premultiplied colour and alpha (4), output
/// variables (as many as the frame has). The picture is colours, and variables, divided by weights.
enum class Sum : uint8_t { Weight, Color, Aov };
inline constexpr std::array kSums{Sum::Weight, Sum::Color, Sum::Aov};

/// Sums over a tile's footprint. Only the tile's own thread adds; neighbours read them when they are
/// complete.
class TileSums {
  public:
    /// `colored`: some sample hits something; else colours and variables are not even there.
    TileSums(const PixelRect& tile, const FilterKernel& kernel, bool colored, int aov_channels)
        : pixels_(kernel.footprint(tile)) {
        channels_ = {1, colored ? 4 : 0, colored ? aov_channels : 0};
        const size_t count = static_cast<size_t>(pixels_.width()) * pixels_.height();
        for (const Sum sum : kSums) values_[at(sum)].resize(count * channels(sum));
    }

    const PixelRect& pixels() const { return pixels_; }
    /// Floats of a pixel in a sum; 0: the sum is not there.
    size_t channels(Sum sum) const { return static_cast<size_t>(channels_[at(sum)]); }
    const float* pixel(Sum sum, int x, int y) const {
        return values_[at(sum)].data() + channels(sum) * index(x, y);
    }

    /// Adds weights, and the rest if there is some, of a pixel's samples to the pixels from (x0, y0) on, each
    /// so many times over.
    void add(int x0, int y0, const PixelSums& from, bool sees_something, float times) {
        const size_t variables = channels(Sum::Aov);
        for (int j = 0; j < from.rows(); ++j)
            for (int i = 0; i < from.columns(); ++i) {
                const float* const sums = from.at(i, j);
                const size_t pixel = index(x0 + i, y0 + j);
                values_[at(Sum::Weight)][pixel] += times * sums[0];
                if (!sees_something) continue;
                float* const color = values_[at(Sum::Color)].data() + 4 * pixel;
                for (size_t c = 0; c < 4; ++c) color[c] += times * sums[1 + c];
                float* const aovs = values_[at(Sum::Aov)].data() + variables * pixel;
                for (size_t c = 0; c < variables; ++c) aovs[c] += times * sums[5 + c];
            }
    }

    size_t bytes() const {
        size_t floats = 0;
        for (const auto& values : values_) floats += values.size();
        return floats * sizeof(float) + (mattes ? mattes->bytes() : 0);
    }

    std::optional<MatteSums> mattes;  ///< where they are asked for

  private:
    static size_t at(Sum sum) { return static_cast<size_t>(sum); }
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - pixels_.y0) * pixels_.width() + static_cast<size_t>(x - pixels_.x0);
    }

    PixelRect pixels_;
    std::array<int, kSums.size()> channels_{};
    std::array<std::vector<float>, kSums.size()> values_;  ///< row by row; a pixel's channels together
};

}  // namespace trapeze
