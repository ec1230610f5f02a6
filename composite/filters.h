/// Pixel filters (RISpec 4.1.1, PixelFilter; the formulas are those of its appendix on built-in filters,
/// where the table in filters.cpp says nothing else). A filter is a function of the vector from a pixel's
/// centre to a sample, in pixels; it counts within [-width/2, width/2) on each axis. The film divides by the
/// sum of the weights, so scale does not matter.
#pragma once

#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/scene.h"

namespace trapeze {

/// The filter's value, straight from its formula, without its support. Unknown names give the gaussian's.
double filter_value(std::string_view name, double x, double y, double width_x, double width_y);

bool is_known_filter(std::string_view name);

/// The pixels that a sample reaches and its weight on each: row by row, count_y rows of count_x.
struct FilterTaps {
    int x0 = 0, y0 = 0;  ///< the first pixel
};

/// A filter ready to weigh millions of samples: tabulated by distance, in double precision from the C library
/// and rounded, so that its last bits do not depend on the processor. A table's error (linear, 512 or more
/// entries a pixel) is below 1e-5 of the largest weight.
class FilterKernel {
  public:
    /// Warns once about a name that is not known and uses the gaussian.
    explicit FilterKernel(const PixelFilter& filter, Diagnostics* diagnostics = nullptr);

    int taps_x() const { return x_.taps; }
    int taps_y() const { return y_.taps; }
    int tap_count() const { return x_.taps * y_.taps; }
    /// How many pixels beyond its own a sample reaches on each side.
    int reach_x() const { return x_.reach; }
    int reach_y() const { return y_.reach; }

    /// The weights of a sample at raster position (x, y) in pixel (pixel_x, pixel_y). Depends on nothing
    /// else, and never reaches further than reach_x() and reach_y(). `weights` has room for tap_count(); taps
    /// outside the support get 0.
    FilterTaps weigh(float x, float y, int pixel_x, int pixel_y, float* weights) const;

  private:
    struct Table {
        std::vector<float>
            values;       ///< two more than `last` says, so that interpolation at the end stays inside
        float scale = 1;  ///< entries per pixel
        float last = 0;   ///< index of the support's (or radius') end
        float at(float distance) const;
    };
    struct Axis {
        float half_width = 1;
        int taps = 2, reach = 1;
        Table table;  ///< of a separable filter
        int first_tap(float position, int pixel) const;
        void weigh(float position, int first, float* weights) const;
    };
    static Axis make_axis(float width);

    void weigh_radially(float x, float y, const FilterTaps& taps, float* weights) const;

    Axis x_, y_;
    bool separable_ = true;
    Table radial_;
    float radial_aspect_ = 1;  ///< y is multiplied by it before the radius is taken
};

}  // namespace trapeze
