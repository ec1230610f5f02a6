#include "composite/filters/glow_filter.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace trapeze {
namespace {

/// A bright middle and wide skirts, as those of lenses are: of standard deviations in parts of the widest.
struct LobeShape {
    float size, share;
};
constexpr LobeShape kLobes[] = {{1, .2f}, {1.0f / 3, .3f}, {1.0f / 9, .5f}};
constexpr float kCut = 3;  ///< standard deviations at which lobes end

int reach(float pixels) {
    return static_cast<int>(std::ceil(kCut * pixels));
}

/// A Gaussian's weights from -reach to reach, whose sum is `sum`.
std::vector<float> weights(float pixels, double sum) {
    const int to = reach(pixels);
    std::vector<double> values;
    double total = 0;
    for (int i = -to; i <= to; ++i) {
        const double x = i / static_cast<double>(pixels);
        values.push_back(portable::exp(-x * x / 2));
        total += values.back();
    }
    std::vector<float> result;
    for (const double value : values) result.push_back(static_cast<float>(value / total * sum));
    return result;
}

/// The pixel of 0 to `size` that one beyond the picture's edges mirrors.
int mirrored(int at, int size) {
    const int period = 2 * size, place = ((at % period) + period) % period;
    return place < size ? place : period - 1 - place;
}

/// sum += weight * values, `count` of them.
void add_weighted(float weight, const float* values, size_t count, float* sum) {
    for (size_t i = 0; i < count; ++i) sum[i] += weight * values[i];
}

/// Pixels of a plane with so many channels, those of `window` alone; `of` is the plane's window.
template <class Value>
std::vector<Value> trimmed(const std::vector<Value>& plane, size_t channels, const PixelRect& of,
                           const PixelRect& window) {
    std::vector<Value> result;
    if (plane.empty()) return result;
    const auto width = static_cast<size_t>(window.width());
    result.reserve(channels * width * static_cast<size_t>(window.height()));
    for (int y = window.y0; y < window.y1; ++y) {
        const size_t first = static_cast<size_t>(y - of.y0) * static_cast<size_t>(of.width()) +
                             static_cast<size_t>(window.x0 - of.x0);
        const auto from = plane.begin() + static_cast<std::ptrdiff_t>(channels * first);
        result.insert(result.end(), from, from + static_cast<std::ptrdiff_t>(channels * width));
    }
    return result;
}

}  // namespace

PixelRect glow_window(const Glow& glow, const Camera& camera, const PixelRect& crop) {
    if (crop.empty()) return crop;
    const int x = reach(glow.pixels_x(camera.width)), y = reach(glow.pixels_y(camera.width));
    return intersection({crop.x0 - x, crop.y0 - y, crop.x1 + x, crop.y1 + y},
                        {0, 0, camera.width, camera.height});
}

GlowFilter::GlowFilter(const Glow& glow, const Camera& camera, const PixelRect& kept, Image& image)
    : glow_(glow), width_(camera.width), height_(camera.height), kept_(kept), image_(image) {
    for (const LobeShape& shape : kLobes) {
        Lobe lobe;
        lobe.along = weights(shape.size * glow.pixels_x(camera.width), 1);
        lobe.down = weights(shape.size * glow.pixels_y(camera.width), static_cast<double>(shape.share));
        lobe.spread.resize(3 * static_cast<size_t>(kept.width()) *
                           static_cast<size_t>(image.window.height()));
        lobes_.push_back(std::move(lobe));
    }
}

float GlowFilter::share(const float* rgba) const {
    // What is no number stays where it is.
    if (!std::isfinite(rgba[0]) || !std::isfinite(rgba[1]) || !std::isfinite(rgba[2])) return 0;
    if (glow_.threshold == 0) return glow_.amount;
    const float brightest = std::max({rgba[0], rgba[1], rgba[2]});
    return brightest > glow_.threshold ? glow_.amount * (1 - glow_.threshold / brightest) : 0;
}

void GlowFilter::spread_row(int y) {
    const auto width = static_cast<size_t>(kept_.width());
    const size_t row = static_cast<size_t>(y - image_.window.y0) * width * 3;
    std::vector<float> light;
    for (Lobe& lobe : lobes_) {
        // The lobe's reach to either side: what mirrors do there, the window holds.
        const auto to = static_cast<int>(lobe.along.size() / 2);
        light.assign(3 * (width + lobe.along.size() - 1), 0);
        for (int x = kept_.x0 - to; x < kept_.x1 + to; ++x) {
            const float* const rgba = &image_.rgba[4 * image_.index(mirrored(x, width_), y)];
            const float part = share(rgba);
            float* const here = &light[3 * static_cast<size_t>(x - (kept_.x0 - to))];
            for (int c = 0; c < 3 && part != 0; ++c) here[c] = part * rgba[c];
        }
        for (size_t tap = 0; tap < lobe.along.size(); ++tap)
            add_weighted(lobe.along[tap], light.data() + 3 * tap, 3 * width, lobe.spread.data() + row);
    }
}

void GlowFilter::add_to_row(int y) {
    const auto width = static_cast<size_t>(kept_.width());
    std::vector<float> glow(3 * width);
    for (const Lobe& lobe : lobes_) {
        const auto to = static_cast<int>(lobe.down.size() / 2);
        for (int from = y - to; from <= y + to; ++from) {
            const size_t row = static_cast<size_t>(mirrored(from, height_) - image_.window.y0) * width * 3;
            add_weighted(lobe.down[static_cast<size_t>(from - y + to)], lobe.spread.data() + row, 3 * width,
                         glow.data());
        }
    }
    for (size_t i = 0; i < width; ++i) {
        float* const rgba = &image_.rgba[4 * image_.index(kept_.x0 + static_cast<int>(i), y)];
        const float part = share(rgba);
        for (size_t c = 0; c < 3; ++c) {
            if (part != 0) rgba[c] -= part * rgba[c];
            rgba[c] += glow[3 * i + c];
        }
    }
}

void trim(const PixelRect& window, Image& image) {
    if (window == image.window) return;
    image.rgba = trimmed(image.rgba, 4, image.window, window);
    image.z = trimmed(image.z, 1, image.window, window);
    image.id = trimmed(image.id, 1, image.window, window);
    image.aovs = trimmed(image.aovs, static_cast<size_t>(image.aov_channels), image.window, window);
    image.mattes = trimmed(image.mattes, static_cast<size_t>(image.matte_floats), image.window, window);
    image.deep = trimmed(image.deep, 1, image.window, window);
    image.window = window;
}

}  // namespace trapeze
