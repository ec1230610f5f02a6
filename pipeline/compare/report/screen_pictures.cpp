#include "pipeline/compare/report/screen_pictures.h"

#include <algorithm>
#include <cmath>

#include "composite/displays/srgb.h"
#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/report/png_bytes.h"
#include "pipeline/compare/report/viridis.h"

namespace trapeze {
namespace {

constexpr float kLargestScale = 64;

/// The value that a part of all values lies at or below.
float quantile(std::vector<float>& values, double part) {
    if (values.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<size_t>(at)];
}

std::string url_of(int width, int height, const std::vector<uint8_t>& rgb) {
    return "data:image/png;base64," + base64(png_bytes(width, height, rgb));
}

/// Means of squares of a map of so many values a pixel.
std::vector<float> means(const std::vector<float>& map, int width, int height, int channels, int factor) {
    const int columns = width / factor, rows = height / factor;
    std::vector<float> out(static_cast<size_t>(columns) * rows * channels);
    for (int y = 0; y < rows * factor; ++y)
        for (int x = 0; x < columns * factor; ++x)
            for (int c = 0; c < channels; ++c)
                out[(static_cast<size_t>(y / factor) * columns + x / factor) * channels + c] +=
                    map[(static_cast<size_t>(y) * width + x) * channels + c];
    for (float& value : out) value /= static_cast<float>(factor * factor);
    return out;
}

}  // namespace

LinearPicture part_of(const Image& image, const PixelRect& pixels) {
    LinearPicture part{pixels.width(), pixels.height(), {}};
    part.rgb.reserve(static_cast<size_t>(part.width) * part.height * 3);
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const float* rgba = &image.rgba[4 * image.index(x, y)];
            part.rgb.insert(part.rgb.end(), rgba, rgba + 3);
        }
    return part;
}

LinearPicture difference_of(const Image& a, const Image& b, float scale) {
    LinearPicture picture = part_of(a, a.window);
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        picture.rgb[i] = scale * std::abs(picture.rgb[i] - b.rgba[i / 3 * 4 + i % 3]);
    return picture;
}

LinearPicture shrunk(const LinearPicture& picture, int factor) {
    if (factor == 1) return picture;
    return {picture.width / factor, picture.height / factor,
            means(picture.rgb, picture.width, picture.height, 3, factor)};
}

float difference_scale(const Comparison& comparison, SampleRate rate) {
    std::vector<float> differences;
    for (const ComparedMethod* method : comparison.at(rate)) {
        const LinearPicture picture = difference_of(method->picture.image, comparison.reference, 1);
        differences.insert(differences.end(), picture.rgb.begin(), picture.rgb.end());
    }
    const float large = quantile(differences, 0.995);
    float scale = 1;
    while (scale < kLargestScale && 2 * scale * large <= 1) scale *= 2;
    return scale;
}

float HeatScale::place(float count) const {
    return std::clamp(std::log(std::max(count, 1.0f)) / std::log(top), 0.0f, 1.0f);
}

HeatScale heat_scale(std::span<const std::vector<float>* const> maps) {
    std::vector<float> values;
    for (const std::vector<float>* map : maps) values.insert(values.end(), map->begin(), map->end());
    return {std::max(2.0f, quantile(values, 0.999))};
}

std::string png_url(const LinearPicture& picture) {
    std::vector<uint8_t> rgb;
    rgb.reserve(picture.rgb.size());
    for (const float value : picture.rgb)
        rgb.push_back(static_cast<uint8_t>(std::min(srgb_encoded(value), 1.0f) * 255 + 0.5f));
    return url_of(picture.width, picture.height, rgb);
}

std::string png_url(const std::vector<float>& map, int width, int height, int factor,
                    const HeatScale& scale) {
    std::vector<uint8_t> rgb;
    for (const float value : means(map, width, height, 1, factor)) {
        const auto color = viridis(scale.place(value));
        rgb.insert(rgb.end(), color.begin(), color.end());
    }
    return url_of(width / factor, height / factor, rgb);
}

}  // namespace trapeze
