/// Constants and order of steps are those of [Andersson20 sec. 4] and of the authors' program (FLIP 1.0,
/// BSD-3-Clause, github.com/NVlabs/flip), from which no code was taken. Filters are separated: a Gaussian in
/// two dimensions is a product, and so is its derivative along an axis.
#include "pipeline/compare/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "core/portable_math.h"

namespace trapeze {
namespace {

constexpr double kPixelsPerDegree = 67;
constexpr double kColorExponent = .7, kFeatureExponent = .5;  ///< q_c and q_f
/// Errors below the part p_c of the largest take the part p_t of the scale.
constexpr double kLargeError = .4, kLargeErrorsPlace = .95;
constexpr double kFeatureDegrees = .082;  ///< w: width of the edges and points that are looked for

/// A term of a contrast sensitivity function: a and b of table 1. The function is a sqrt(pi / b)
/// exp(-(pi d)^2 / b) over a distance of d degrees.
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity kAchromatic{1, .0047}, kRedGreen{1, .0053};
constexpr Sensitivity kBlueYellow[] = {{34.1, .04}, {13.5, .025}};

using Plane = std::vector<float>;
using Vector = std::array<double, 3>;

/// Weights from -radius to radius.
struct Kernel {
    std::vector<double> weights;

    int radius() const { return static_cast<int>(weights.size() / 2); }
};

template <class Weight>
Kernel kernel_of(int radius, const Weight& weight) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) kernel.weights.push_back(weight(x));
    return kernel;
}

double squared(double x) {
    return x * x;
}

/// Pixels row by row, with what filters need of their size.
struct Size {
    int width, height;

    size_t count() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
    template <class Work>
    void for_each_row(const Work& work) const {
        tbb::parallel_for(0, height, [&](int y) { work(y, static_cast<size_t>(y) * width); });
    }
};

/// Along rows; beyond the border are the border's values.
Plane filtered_across(const Plane& plane, const Size& size, const Kernel& kernel) {
    Plane out(plane.size());
    size.for_each_row([&](int, size_t row) {
        for (int x = 0; x < size.width; ++x) {
            double sum = 0;
            for (int i = -kernel.radius(); i <= kernel.radius(); ++i)
                sum += kernel.weights[static_cast<size_t>(i + kernel.radius())] *
                       static_cast<double>(
                           plane[row + static_cast<size_t>(std::clamp(x + i, 0, size.width - 1))]);
            out[row + static_cast<size_t>(x)] = static_cast<float>(sum);
        }
    });
    return out;
}

/// Along columns, a row at a time.
Plane filtered_down(const Plane& plane, const Size& size, const Kernel& kernel) {
    Plane out(plane.size());
    const auto columns = static_cast<size_t>(size.width);
    size.for_each_row([&](int y, size_t row) {
        std::vector<double> sums(columns);
        for (int i = -kernel.radius(); i <= kernel.radius(); ++i) {
            const double weight = kernel.weights[static_cast<size_t>(i + kernel.radius())];
            const size_t from = static_cast<size_t>(std::clamp(y + i, 0, size.height - 1)) * columns;
            for (size_t x = 0; x < columns; ++x) sums[x] += weight * static_cast<double>(plane[from + x]);
        }
        for (size_t x = 0; x < columns; ++x) out[row + x] = static_cast<float>(sums[x]);
    });
    return out;
}

/// Filters by a sum of Gaussians whose weights' sum is 1.
Plane as_seen(const Plane& plane, const Size& size, std::span<const Sensitivity> terms) {
    double widest = 0;  // of all channels, so that all have one radius
    for (const double b : {kAchromatic.b, kRedGreen.b, kBlueYellow[0].b, kBlueYellow[1].b})
        widest = std::max(widest, b);
    const double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * kPixelsPerDegree));
    const auto gaussian = [&](const Sensitivity& term) {
        return [&term](int x) {
            return portable::exp(-squared(std::numbers::pi * x / kPixelsPerDegree) / term.b);
        };
    };
    std::vector<double> sums, parts;  // of the terms' weights along an axis; of the terms in the whole
    double whole = 0;
    for (const Sensitivity& term : terms) {
        double sum = 0;
        for (int x = -radius; x <= radius; ++x) sum += gaussian(term)(x);
        sums.push_back(sum), parts.push_back(term.a * std::sqrt(pi / term.b) * sum * sum);
        whole += parts.back();
    }
    Plane all(plane.size());
    for (size_t t = 0; t < terms.size(); ++t) {
        const double part = parts[t] / whole / sums[t];
        const Kernel across = kernel_of(radius, [&](int x) { return gaussian(terms[t])(x) / sums[t]; });
        const Kernel down = kernel_of(radius, [&](int x) { return part * gaussian(terms[t])(x); });
        const Plane one = filtered_down(filtered_across(plane, size, across), size, down);
        size.for_each_row([&](int, size_t row) {
            for (size_t i = row; i < row + static_cast<size_t>(size.width); ++i) all[i] += one[i];
        });
    }
    return all;
}

/// Positive and negative weights are scaled to a sum of 1 and -1.
template <class Weight>
Kernel balanced_kernel(int radius, const Weight& weight) {
    double above = 0, below = 0;
    for (int x = -radius; x <= radius; ++x) {
        const double w = weight(x);
        (w > 0 ? above : below) += std::abs(w);
    }
    return kernel_of(radius, [&](int x) {
        const double w = weight(x);
        return w > 0 ? w / above : w / below;
    });
}

/// Lengths of the gradients that kernels along the axes and a Gaussian across them find.
Plane gradient(const Plane& plane, const Plane& smooth_across, const Size& size, const Kernel& kernel,
               const Kernel& gaussian) {
    Plane x = filtered_down(filtered_across(plane, size, kernel), size, gaussian);
    const Plane y = filtered_down(smooth_across, size, kernel);
    size.for_each_row([&](int, size_t row) {
        for (size_t i = row; i < row + static_cast<size_t>(size.width); ++i)
            x[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
    });
    return x;
}

/// Edges by the first derivative of a Gaussian, points by the second.
void find_features(const Plane& luminance, const Size& size, SeenPicture& seen) {
    const double deviation = .5 * kFeatureDegrees * kPixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto bell = [&](int x) { return portable::exp(-squared(x / deviation) / 2); };
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) sum += bell(x);
    const Kernel gaussian = kernel_of(radius, [&](int x) { return bell(x) / sum; });
    const Plane smooth = filtered_across(luminance, size, gaussian);
    seen.edges = gradient(luminance, smooth, size,
                          balanced_kernel(radius, [&](int x) { return -x * bell(x); }), gaussian);
    const auto second = [&](int x) { return (squared(x / deviation) - 1) * bell(x); };
    seen.points = gradient(luminance, smooth, size, balanced_kernel(radius, second), gaussian);
}

/// Linear RGB of sRGB's primaries to XYZ by D65's white: rows sum to 1.
constexpr double kXyz[3][3] = {
    {10135552. / 24577794 / .950428545, 8788810. / 24577794 / .950428545, 4435075. / 24577794 / .950428545},
    {2613072. / 12288897, 8788810. / 12288897, 887015. / 12288897},
    {1425312. / 73733382 / 1.088900371, 8788810. / 73733382 / 1.088900371,
     70074185. / 73733382 / 1.088900371}};

Vector xyz_of(const Vector& rgb) {
    Vector xyz;
    for (size_t i = 0; i < 3; ++i) xyz[i] = kXyz[i][0] * rgb[0] + kXyz[i][1] * rgb[1] + kXyz[i][2] * rgb[2];
    return xyz;
}

/// The inverse, by Cramer's rule.
Vector rgb_of(const Vector& xyz) {
    const auto& m = kXyz;
    const auto minor = [&](int r0, int r1, int c0, int c1) {
        return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    };
    const double determinant =
        m[0][0] * minor(1, 2, 1, 2) - m[0][1] * minor(1, 2, 0, 2) + m[0][2] * minor(1, 2, 0, 1);
    return {
        (minor(1, 2, 1, 2) * xyz[0] - minor(0, 2, 1, 2) * xyz[1] + minor(0, 1, 1, 2) * xyz[2]) / determinant,
        (-minor(1, 2, 0, 2) * xyz[0] + minor(0, 2, 0, 2) * xyz[1] - minor(0, 1, 0, 2) * xyz[2]) / determinant,
        (minor(1, 2, 0, 1) * xyz[0] - minor(0, 2, 0, 1) * xyz[1] + minor(0, 1, 0, 1) * xyz[2]) / determinant};
}

/// CIELAB of linear RGB, with Hunt's adjustment of a* and b*.
Vector hunt_lab_of(const Vector& rgb) {
    constexpr double kDelta = 6. / 29;
    const auto compressed = [](double value) {
        return value > kDelta * kDelta * kDelta ? portable::cbrt(value)
                                                : value / (3 * kDelta * kDelta) + 4. / 29;
    };
    const Vector xyz = xyz_of(rgb);
    const double x = compressed(xyz[0]), y = compressed(xyz[1]), z = compressed(xyz[2]);
    const double lightness = 116 * y - 16;
    return {lightness, .01 * lightness * 500 * (x - y), .01 * lightness * 200 * (y - z)};
}

/// HyAB: lightness counts as along city blocks, chroma as the crow flies.
double distance(const Vector& one, const Vector& other) {
    return std::abs(one[0] - other[0]) + portable::hypot(one[1] - other[1], one[2] - other[2]);
}

/// Errors of colour on a scale to 1.
class ColorError {
  public:
    double of(double distance_of_colors) const {
        const double error = portable::pow(distance_of_colors, kColorExponent), large = kLargeError * most_;
        const double value =
            error < large ? kLargeErrorsPlace / large * error
                          : kLargeErrorsPlace + (error - large) / (most_ - large) * (1 - kLargeErrorsPlace);
        return std::min(value, 1.0);
    }

  private:
    /// The largest distance: of green and blue.
    double most_ = portable::pow(distance(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), kColorExponent);
};

/// Into the range of a screen; what is no number is black.
double shown(float value) {
    return value > 0 ? std::min(static_cast<double>(value), 1.0) : 0;
}

}  // namespace

SeenPicture seen_picture(const Image& image) {
    const Size size{image.window.width(), image.window.height()};
    SeenPicture seen{size.width, size.height, {}, {}, {}, {}, {}};
    // Opponent colours: lightness, red against green, blue against yellow, linear (YyCxCz).
    Plane y(size.count()), cx(size.count()), cz(size.count()), luminance(size.count());
    const auto columns = static_cast<size_t>(size.width);
    size.for_each_row([&](int, size_t row) {
        for (size_t i = row; i < row + columns; ++i) {
            const float* const rgba = &image.rgba[4 * i];
            const Vector xyz = xyz_of({shown(rgba[0]), shown(rgba[1]), shown(rgba[2])});
            luminance[i] = static_cast<float>(xyz[1]);
            y[i] = static_cast<float>(116 * xyz[1] - 16);
            cx[i] = static_cast<float>(500 * (xyz[0] - xyz[1]));
            cz[i] = static_cast<float>(200 * (xyz[1] - xyz[2]));
        }
    });
    y = as_seen(y, size, {&kAchromatic, 1});
    cx = as_seen(cx, size, {&kRedGreen, 1});
    cz = as_seen(cz, size, kBlueYellow);
    size.for_each_row([&](int, size_t row) {
        for (size_t i = row; i < row + columns; ++i) {
            const double yn = (static_cast<double>(y[i]) + 16) / 116;
            Vector rgb =
                rgb_of({yn + static_cast<double>(cx[i]) / 500, yn, yn - static_cast<double>(cz[i]) / 200});
            for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
            const Vector lab = hunt_lab_of(rgb);
            y[i] = static_cast<float>(lab[0]), cx[i] = static_cast<float>(lab[1]);
            cz[i] = static_cast<float>(lab[2]);
        }
    });
    seen.lightness = std::move(y), seen.a = std::move(cx), seen.b = std::move(cz);
    find_features(luminance, size, seen);
    return seen;
}

std::vector<float> flip_differences(const SeenPicture& picture, const SeenPicture& reference) {
    const Size size{picture.width, picture.height};
    const ColorError color_error;
    std::vector<float> differences(size.count());
    const auto apart = [](const Plane& one, const Plane& other, size_t i) {
        return std::abs(static_cast<double>(one[i]) - static_cast<double>(other[i]));
    };
    const auto lab = [](const SeenPicture& seen, size_t i) {
        return Vector{static_cast<double>(seen.lightness[i]), static_cast<double>(seen.a[i]),
                      static_cast<double>(seen.b[i])};
    };
    size.for_each_row([&](int, size_t row) {
        for (size_t i = row; i < row + static_cast<size_t>(size.width); ++i) {
            const double color = color_error.of(distance(lab(picture, i), lab(reference, i)));
            const double features = std::max(apart(picture.edges, reference.edges, i),
                                             apart(picture.points, reference.points, i));
            const double feature = portable::pow(features / std::numbers::sqrt2, kFeatureExponent);
            differences[i] = static_cast<float>(portable::pow(color, 1 - std::min(feature, 1.0)));
        }
    });
    return differences;
}

double flip_difference(const SeenPicture& picture, const SeenPicture& reference) {
    const std::vector<float> differences = flip_differences(picture, reference);
    double sum = 0;
    for (const float difference : differences) sum += static_cast<double>(difference);
    return differences.empty() ? 0 : sum / static_cast<double>(differences.size());
}

}  // namespace trapeze
