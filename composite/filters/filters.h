/// Pixel filters (RISpec 4.1.1, PixelFilter; the formulas are those of its appendix on built-in filters,
/// where the table in filters.cpp says nothing else). A filter is a function of the vector from a pixel's
/// centre to a sample, in pixels; it counts within [-width/2, width/2) on each axis. The film divides by the
/// sum of the weights, so scale does not matter.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/scene/camera.h"
#include "core/scene/scene.h"

namespace trapeze {

/// The filter's value, straight from its formula, without its support. Unknown names give the gaussian's.
double filter_value(std::string_view name, double x, double y, double width_x, double width_y);

/// Where a sample's taps are: the first of the pixels that it reaches. Weights on these follow row by row,
/// taps_y() rows of taps_x().
struct FilterTaps {
    int x0 = 0, y0 = 0;
};

/// One axis of the support. A sample's first tap is the first pixel whose centre lies less than half a
/// width to its left; its phase in [0, 1) is how far it lies beyond the position where that tap came in.
/// Both give all distances: tap i is at half_width - 1 + phase - i.
struct FilterAxis {
    /// How finely a sample's phase is tabulated, between which weights are interpolated.
    static constexpr int kPhases = 1024;

    float half_width = 1;
    int taps = 2, reach = 1;
    float rim = 0;  ///< phases below this leave the last tap outside of the support (widths between
                    ///< integers); its weight is then 0
    /// A weight at a phase, and how much more it is at the next one.
    struct Pair {
        float weight, step;
    };
    /// Of a separable filter: kPhases + 1 Pairs of each tap, tap by tap; as integers, so that a vector load
    /// brings both numbers.
    std::vector<int64_t> phases;
    /// The weight of all samples of a pixel, where it is one and goes to their own pixel alone: of a box of
    /// one pixel.
    std::optional<float> only_weight;

    const int64_t* tap(int i) const { return phases.data() + static_cast<size_t>(i) * (kPhases + 1); }

    int locate(float position, int pixel, float* phase) const {
        // Rounding may put a sample on its pixel's far edge; it stays that pixel's. So does one that is
        // no number.
        const float in_pixel = std::max(0.0f, std::min(0x1.fffffep-1f, position - static_cast<float>(pixel)));
        const float begin = in_pixel + start();
        const int first = static_cast<int>(begin);
        *phase = begin - static_cast<float>(first);
        return pixel - reach + first;
    }
    /// Where the samples on a pixel's near edge are, from where the first of `reach` pixels comes in: in [0,
    /// 1).
    float start() const { return static_cast<float>(reach) + 0.5f - half_width; }
    /// Pixels that samples of one pixel reach, along this axis.
    int columns() const { return taps + (start() > 0 ? 1 : 0); }
    int spare() const { return taps > 2 * reach && rim > 0 ? 1 : 0; }
    /// The weights of a separable filter's taps; returns the first.
    int weigh(float position, int pixel, float* weights) const {
        float phase;
        const int first = locate(position, pixel, &phase);
        const float at = phase * kPhases;
        const int row = static_cast<int>(at);
        const float part = at - static_cast<float>(row);
        for (int i = 0; i < taps; ++i) {
            const Pair pair = std::bit_cast<Pair>(tap(i)[row]);
            weights[i] = pair.weight + part * pair.step;
        }
        if (phase < rim) weights[taps - 1] = 0;
        return first;
    }
};

/// A filter ready to weigh millions of samples: tabulated, in double precision from the C library and
/// rounded, so that its last bits do not depend on the processor. What the tables lose is below 1e-5 of the
/// largest weight.
class FilterKernel {
  public:
    /// Warns once about a name that is not known and uses the gaussian.
    explicit FilterKernel(const PixelFilter& filter, Diagnostics* diagnostics = nullptr);

    /// The table of a filter that is a function of the distance from the centre.
    struct RadialTable {
        std::vector<float>
            values;        ///< one more than `last` says, so that interpolation at the end stays inside
        float scale = 1;   ///< entries per pixel
        float last = 0;    ///< index from which on the filter is 0
        float aspect = 1;  ///< y times this, then the distance is taken
    };

    /// Whether weights are products of those along both axes.
    bool is_separable() const { return separable_; }
    const FilterAxis& x() const { return x_; }
    const FilterAxis& y() const { return y_; }
    const RadialTable& radial() const { return radial_; }  ///< of a filter that is not separable
    int taps_x() const { return x_.taps; }
    int taps_y() const { return y_.taps; }
    int tap_count() const { return x_.taps * y_.taps; }
    /// How many pixels beyond its own a sample reaches on each side.
    int reach_x() const { return x_.reach; }
    int reach_y() const { return y_.reach; }

    /// What samples in these pixels may name as taps: the pixels in reach and, with some widths between
    /// integers, one more on the far sides, whose weight is always 0.
    PixelRect footprint(const PixelRect& pixels) const {
        return {pixels.x0 - x_.reach, pixels.y0 - y_.reach, pixels.x1 + x_.reach + x_.spare(),
                pixels.y1 + y_.reach + y_.spare()};
    }

    /// The weights of a sample at raster position (x, y) in pixel (pixel_x, pixel_y). Depends on nothing
    /// else. `weights` has room for tap_count(); taps outside the support get 0.
    FilterTaps weigh(float x, float y, int pixel_x, int pixel_y, float* weights) const {
        if (!separable_) return weigh_radially(x, y, pixel_x, pixel_y, weights);
        float wx[kMaxTaps], wy[kMaxTaps];
        const FilterTaps taps{x_.weigh(x, pixel_x, wx), y_.weigh(y, pixel_y, wy)};
        for (int j = 0; j < y_.taps; ++j)
            for (int i = 0; i < x_.taps; ++i) weights[j * x_.taps + i] = wx[i] * wy[j];
        return taps;
    }

  private:
    /// Taps along an axis, at most.
    static constexpr int kMaxTaps = 64;

    static FilterAxis make_axis(float width);
    FilterTaps weigh_radially(float x, float y, int pixel_x, int pixel_y, float* weights) const;

    FilterAxis x_, y_;
    bool separable_ = true;
    RadialTable radial_;
};

}  // namespace trapeze
