#include "composite/filters.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kMinWidth = 1;   ///< below it a pixel might see no sample at all
constexpr float kMaxWidth = 64;  ///< a bound on what absurd input costs
constexpr int kEntriesPerPixel = 512;
constexpr int kMinEntries = 1024;
constexpr int kMaxTaps = 64;

double sinc(double x) {
    return std::abs(x) < 1e-9 ? 1.0 : std::sin(kPi * x) / (kPi * x);
}

double box(double, double) {
    return 1;
}

/// RISpec prints (1 - |x|) / (width / 2), which is a triangle for width 2 alone; this is one for every width.
double triangle(double x, double width) {
    return std::max(0.0, 1 - std::abs(2 * x / width));
}

double gaussian(double x, double width) {
    const double s = 2 * x / width;
    return std::exp(-2 * s * s);
}

/// RISpec prints sin(x) / x with x in pixels, three times too wide to be the ideal filter of the pixel grid,
/// and cuts it off at the width. As in most renderers: zero at the neighbouring pixels, and a cosine window
/// that ends at the support.
double windowed_sinc(double x, double width) {
    return std::abs(2 * x) >= width ? 0 : sinc(x) * std::cos(kPi * x / width);
}

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

/// Mitchell and Netravali 1988, "Reconstruction filters in computer graphics", equation 8 with B = C = 1/3;
/// its four spans fill the width.
double mitchell(double x, double width) {
    const double r = std::abs(4 * x / width);
    if (r >= 2) return 0;
    return r < 1 ? ((7 * r - 12) * r * r + 16.0 / 3) / 6
                 : (((-7.0 / 3 * r + 12) * r - 20) * r + 32.0 / 3) / 6;
}

/// Harris 1978, the four-term window of minimal side lobes.
double blackman_harris(double x, double width) {
    if (std::abs(2 * x) >= width) return 0;
    const double phase = 2 * kPi * (std::abs(x) / width + 0.5);
    return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) -
           0.01168 * std::cos(3 * phase);
}

double disk(double r, double width) {
    return 2 * r < width ? 1 : 0;
}

/// The circular twin of sinc: the transform of a disk, windowed by the same cosine.
double bessel(double r, double width) {
    if (2 * r >= width) return 0;
    const double jinc = r < 1e-9 ? 1.0 : 2 * std::cyl_bessel_j(1.0, kPi * r) / (kPi * r);
    return jinc * std::cos(kPi * r / width);
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

float sane_width(float width) {
    return width >= kMinWidth ? std::min(width, kMaxWidth) : kMinWidth;  // NaN too
}

}  // namespace

bool is_known_filter(std::string_view name) {
    return find_filter(name) != nullptr;
}

double filter_value(std::string_view name, double x, double y, double width_x, double width_y) {
    const FilterRow* found = find_filter(name);
    const FilterRow& row = found ? *found : kFilters[0];
    if (row.form == Form::Separable) return row.value(x, width_x) * row.value(y, width_y);
    const double stretched = y * radial_aspect(row, width_x, width_y);
    return row.value(std::sqrt(x * x + stretched * stretched), width_x);
}

FilterKernel::Axis FilterKernel::make_axis(float width) {
    Axis axis;
    axis.half_width = width / 2;
    axis.taps = static_cast<int>(std::ceil(width));
    axis.reach = static_cast<int>(std::ceil((width - 1) / 2));  // as sampled_pixels() has it
    return axis;
}

FilterKernel::FilterKernel(const PixelFilter& filter, Diagnostics* diagnostics) {
    const FilterRow* found = find_filter(filter.name);
    if (!found && diagnostics)
        diagnostics->warning({}, "PixelFilter \"" + filter.name + "\" is not known; gaussian is used",
                             "unknown-filter");
    const FilterRow& row = found ? *found : kFilters[0];
    const float width_x = sane_width(filter.width_x), width_y = sane_width(filter.width_y);
    x_ = make_axis(width_x), y_ = make_axis(width_y);

    const auto tabulate = [&](float length, double width) {
        const int last = std::max(kMinEntries, static_cast<int>(std::ceil(length * kEntriesPerPixel)));
        Table table;
        table.scale = static_cast<float>(last) / length;
        table.last = static_cast<float>(last);
        for (int i = 0; i <= last; ++i)
            table.values.push_back(
                static_cast<float>(row.value(static_cast<double>(length) * i / last, width)));
        table.values.push_back(table.values.back());
        return table;
    };
    separable_ = row.form == Form::Separable;
    if (separable_) {
        x_.table = tabulate(x_.half_width, width_x);
        y_.table = tabulate(y_.half_width, width_y);
    } else {
        radial_aspect_ = static_cast<float>(radial_aspect(row, width_x, width_y));
        // An ellipse ends where the table does; a radial filter's square support reaches to its corner.
        const float corner = std::sqrt(width_x * width_x + width_y * width_y) / 2;
        radial_ = tabulate(row.form == Form::Elliptic ? width_x / 2 : corner, width_x);
        if (row.value == disk)
            *(radial_.values.end() - 1) = *(radial_.values.end() - 2) = 1;  // the rim is not a ramp
    }
}

float FilterKernel::Table::at(float distance) const {
    const float position = std::min(distance * scale, last);
    const int i = static_cast<int>(position);
    const float below = values[i];
    return below + (position - static_cast<float>(i)) * (values[i + 1] - below);
}

int FilterKernel::Axis::first_tap(float position, int pixel) const {
    const int first = static_cast<int>(std::floor(position - 0.5f - half_width)) + 1;
    // Rounding may put a sample on its pixel's far edge; it stays that pixel's.
    return std::clamp(first, pixel - reach, pixel + reach + 1 - taps);
}

void FilterKernel::Axis::weigh(float position, int first, float* weights) const {
    for (int i = 0; i < taps; ++i) {
        const float distance = std::abs(position - (static_cast<float>(first + i) + 0.5f));
        weights[i] = distance <= half_width ? table.at(distance) : 0.0f;
    }
}

void FilterKernel::weigh_radially(float x, float y, const FilterTaps& taps, float* weights) const {
    for (int j = 0; j < y_.taps; ++j)
        for (int i = 0; i < x_.taps; ++i) {
            const float dx = x - (static_cast<float>(taps.x0 + i) + 0.5f);
            const float dy = y - (static_cast<float>(taps.y0 + j) + 0.5f);
            const float sy = dy * radial_aspect_;
            const float r = std::sqrt(dx * dx + sy * sy);
            const bool inside = std::abs(dx) <= x_.half_width && std::abs(dy) <= y_.half_width &&
                                r * radial_.scale < radial_.last;
            weights[j * x_.taps + i] = inside ? radial_.at(r) : 0.0f;
        }
}

FilterTaps FilterKernel::weigh(float x, float y, int pixel_x, int pixel_y, float* weights) const {
    const FilterTaps taps{x_.first_tap(x, pixel_x), y_.first_tap(y, pixel_y)};
    if (!separable_) {
        weigh_radially(x, y, taps, weights);
        return taps;
    }
    float wx[kMaxTaps], wy[kMaxTaps];
    x_.weigh(x, taps.x0, wx);
    y_.weigh(y, taps.y0, wy);
    for (int j = 0; j < y_.taps; ++j)
        for (int i = 0; i < x_.taps; ++i) weights[j * x_.taps + i] = wx[i] * wy[j];
    return taps;
}

}  // namespace trapeze
