#include "composite/filters/filters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace trapeze {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kMinWidth = 1;   ///< below it a pixel might see no sample at all
constexpr float kMaxWidth = 64;  ///< a bound on what absurd input costs
constexpr int kRadialEntriesPerPixel = 512;

double sinc(double x) {
    return std::abs(x) < 1e-9 ? 1.0 : portable::sin(kPi * x) / (kPi * x);
}

double box(double, double) {
    return 1;
}

/// RISpec prints (1 - |x|) / (width / 2), which is a triangle for width 2 alone; this is one for every width.
double triangle(double x, double width) {
    return std::max(0.0, 1 - std::abs(2 * x / width));
}

/// RISpec's gaussian: exp(-2 (2x / width)^2), so that it is exp(-2) at the support's end.
double gaussian(double x, double width) {
    const double s = 2 * x / width;
    return portable::exp(-2 * s * s);
}

/// RISpec prints sin(x) / x with x in pixels, three times too wide to be the ideal filter of the pixel grid,
/// and cuts it off at the width. As in most renderers: zero at the neighbouring pixels, and a cosine window
/// that ends at the support.
double windowed_sinc(double x, double width) {
    return std::abs(2 * x) >= width ? 0 : sinc(x) * portable::cos(kPi * x / width);
}

/// The sinc, windowed by a wider sinc that ends at the support.
double lanczos(double x, double width) {
    return std::abs(2 * x) >= width ? 0 : sinc(x) * sinc(2 * x / width);
}

/// Catmull and Rom's cubic, twice as RISpec writes it: 2 in the middle, 0 from 2 pixels on, whatever the
/// width.
double catmull_rom(double x, double) {
    const double r = std::abs(x);
    if (r >= 2) return 0;
    return r < 1 ? (3 * r - 5) * r * r + 2 : ((5 - r) * r - 8) * r + 4;
}

/// The uniform cubic B-spline; its four spans fill the width.
double b_spline(double x, double width) {
    const double r = std::abs(4 * x / width);
    if (r >= 2) return 0;
    return r < 1 ? (3 * r - 6) * r * r / 6 + 2.0 / 3 : (2 - r) * (2 - r) * (2 - r) / 6;
}

/// [Mitchell88, equation 8] with B = C = 1/3; its four spans fill the width.
double mitchell(double x, double width) {
    const double r = std::abs(4 * x / width);
    if (r >= 2) return 0;
    return r < 1 ? ((7 * r - 12) * r * r + 16.0 / 3) / 6
                 : (((-7.0 / 3 * r + 12) * r - 20) * r + 32.0 / 3) / 6;
}

/// The four-term window of minimal side lobes [Harris78].
double blackman_harris(double x, double width) {
    if (std::abs(2 * x) >= width) return 0;
    const double phase = 2 * kPi * (std::abs(x) / width + 0.5);
    return 0.35875 - 0.48829 * portable::cos(phase) + 0.14128 * portable::cos(2 * phase) -
           0.01168 * portable::cos(3 * phase);
}

double disk(double r, double width) {
    return 2 * r < width ? 1 : 0;
}

/// The circular twin of sinc: the transform of a disk, windowed by the same cosine.
double bessel(double r, double width) {
    if (2 * r >= width) return 0;
    const double jinc = r < 1e-9 ? 1.0 : 2 * portable::bessel_j1(kPi * r) / (kPi * r);
    return jinc * portable::cos(kPi * r / width);
}

enum class Form {
    Separable,  ///< f(x, width_x) * f(y, width_y)
    Radial,     ///< f(r, width_x), r in pixels
    Elliptic,   ///< f(r, width_x), y first stretched so that the support's ellipse becomes a circle
};

struct FilterRow {
    std::string_view name;
    Form form;
    double (*value)(double, double);
};

constexpr FilterRow kFilters[] = {
    {"gaussian", Form::Separable, gaussian},
    {"box", Form::Separable, box},
    {"triangle", Form::Separable, triangle},
    {"catmull-rom", Form::Radial, catmull_rom},
    {"separable-catmull-rom", Form::Separable, catmull_rom},
    {"sinc", Form::Separable, windowed_sinc},
    {"lanczos", Form::Separable, lanczos},
    {"b-spline", Form::Separable, b_spline},
    {"mitchell", Form::Separable, mitchell},
    {"blackman-harris", Form::Separable, blackman_harris},
    {"disk", Form::Elliptic, disk},
    {"bessel", Form::Elliptic, bessel},
};

const FilterRow* find_filter(std::string_view name) {
    for (const FilterRow& row : kFilters)
        if (row.name == name) return &row;
    return nullptr;
}

double radial_aspect(const FilterRow& row, double width_x, double width_y) {
    return row.form == Form::Elliptic ? width_x / width_y : 1;
}

/// Fills the table of an axis of a separable filter.
void tabulate(FilterAxis& axis, const FilterRow& row) {
    for (int i = 0; i < axis.taps; ++i) {
        const auto weight_at = [&](int phase) {
            const double x = axis.half_width - 1.0 + static_cast<double>(phase) / FilterAxis::kPhases - i;
            return static_cast<float>(row.value(x, 2.0 * axis.half_width));
        };
        for (int phase = 0; phase <= FilterAxis::kPhases; ++phase) {
            const float weight = weight_at(phase);
            axis.phases.push_back(
                std::bit_cast<int64_t>(FilterAxis::Pair{weight, weight_at(phase + 1) - weight}));
        }
    }
    const auto is_first = [&](int64_t pair) { return pair == axis.phases.front(); };
    const auto [weight, step] = std::bit_cast<FilterAxis::Pair>(axis.phases.front());
    if (axis.columns() == 1 && axis.rim <= 0 && step == 0 && std::ranges::all_of(axis.phases, is_first))
        axis.only_weight = weight;
}

/// A width that a kernel can be made for.
float sane_width(float width) {
    return width >= kMinWidth ? std::min(width, kMaxWidth) : kMinWidth;  // NaN too
}

}  // namespace

double filter_value(std::string_view name, double x, double y, double width_x, double width_y) {
    const FilterRow* found = find_filter(name);
    const FilterRow& row = found ? *found : kFilters[0];
    if (row.form == Form::Separable) return row.value(x, width_x) * row.value(y, width_y);
    const double stretched = y * radial_aspect(row, width_x, width_y);
    return row.value(std::sqrt(x * x + stretched * stretched), width_x);
}

FilterAxis FilterKernel::make_axis(float width) {
    FilterAxis axis;
    axis.half_width = width / 2;
    axis.taps = static_cast<int>(std::ceil(width));
    axis.reach = static_cast<int>(std::ceil((width - 1) / 2));  // as sampled_pixels() has it
    axis.rim = static_cast<float>(axis.taps) - width;
    return axis;
}

FilterKernel::FilterKernel(const PixelFilter& filter, Diagnostics* diagnostics) {
    const FilterRow* found = find_filter(filter.name);
    if (!found && diagnostics)
        diagnostics->warning({},
                             fmt::format("PixelFilter \"{}\" is not known; gaussian is used", filter.name),
                             "unknown-filter");
    const FilterRow& row = found ? *found : kFilters[0];
    x_ = make_axis(sane_width(filter.width_x)), y_ = make_axis(sane_width(filter.width_y));
    separable_ = row.form == Form::Separable;
    if (separable_) {
        for (FilterAxis* axis : {&x_, &y_}) tabulate(*axis, row);
        return;
    }
    const double width_x = 2.0 * x_.half_width, width_y = 2.0 * y_.half_width;
    // A function of the ellipse ends where that does, others at the corner of the support.
    const double length =
        row.form == Form::Elliptic ? width_x / 2 : std::sqrt(width_x * width_x + width_y * width_y) / 2;
    const int last = static_cast<int>(std::ceil(length * kRadialEntriesPerPixel));
    radial_.aspect = static_cast<float>(radial_aspect(row, width_x, width_y));
    radial_.scale = static_cast<float>(last / length);
    radial_.last = static_cast<float>(last);
    for (int i = 0; i <= last; ++i)
        radial_.values.push_back(static_cast<float>(row.value(length * i / last, width_x)));
    if (row.value == disk) radial_.values.back() = 1;  // its rim is no ramp
}

FilterTaps FilterKernel::weigh_radially(float x, float y, int pixel_x, int pixel_y, float* weights) const {
    float phase_x, phase_y;
    const FilterTaps taps{x_.locate(x, pixel_x, &phase_x), y_.locate(y, pixel_y, &phase_y)};
    for (int j = 0; j < y_.taps; ++j)
        for (int i = 0; i < x_.taps; ++i) {
            const float dx = x_.half_width - 1 + phase_x - static_cast<float>(i);
            const float dy = (y_.half_width - 1 + phase_y - static_cast<float>(j)) * radial_.aspect;
            const float at = std::sqrt(dx * dx + dy * dy) * radial_.scale;
            const bool outside = (i + 1 == x_.taps && phase_x < x_.rim) ||
                                 (j + 1 == y_.taps && phase_y < y_.rim) || at >= radial_.last;
            float& weight = weights[j * x_.taps + i];
            weight = 0;
            if (outside) continue;
            const int k = static_cast<int>(at);
            weight = radial_.values[k] +
                     (at - static_cast<float>(k)) * (radial_.values[k + 1] - radial_.values[k]);
        }
    return taps;
}

}  // namespace trapeze
