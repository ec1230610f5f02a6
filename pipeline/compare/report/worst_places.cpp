#include "pipeline/compare/report/worst_places.h"

#include <algorithm>

namespace trapeze {
namespace {

constexpr int kStep = 4;  ///< pixels between the places that are tried

/// Sums over rectangles of a map in constant time.
class SumTable {
  public:
    SumTable(const std::vector<float>& map, int width, int height)
        : stride_(static_cast<size_t>(width) + 1), sums_(stride_ * (static_cast<size_t>(height) + 1)) {
        for (int y = 0; y < height; ++y) {
            double row = 0;
            for (int x = 0; x < width; ++x) {
                row += static_cast<double>(map[static_cast<size_t>(y) * width + x]);
                at(x + 1, y + 1) = at(x + 1, y) + row;
            }
        }
    }
    double sum(int x, int y, int width, int height) {
        return at(x + width, y + height) - at(x, y + height) - at(x + width, y) + at(x, y);
    }

  private:
    double& at(int x, int y) { return sums_[static_cast<size_t>(y) * stride_ + x]; }

    size_t stride_;
    std::vector<double> sums_;
};

/// Pixel by pixel, the squared difference of the worst picture.
std::vector<float> worst_errors(const Image& reference, std::span<const Image* const> pictures) {
    std::vector<float> errors(reference.rgba.size() / 4);
    for (const Image* const picture : pictures)
        for (size_t i = 0; i < errors.size(); ++i) {
            float error = 0;
            for (size_t c = 0; c < 3; ++c) {
                const float d = picture->rgba[4 * i + c] - reference.rgba[4 * i + c];
                error += d * d;
            }
            errors[i] = std::max(errors[i], error);
        }
    return errors;
}

}  // namespace

std::vector<PixelRect> worst_places(const Image& reference, std::span<const Image* const> pictures, int side,
                                    size_t count) {
    const PixelRect& window = reference.window;
    const int width = std::min(side, window.width()), height = std::min(side, window.height());
    SumTable sums(worst_errors(reference, pictures), window.width(), window.height());
    std::vector<PixelRect> places;
    while (places.size() < count && width > 0 && height > 0) {
        PixelRect worst;
        double most = -1;
        for (int y = 0; y + height <= window.height(); y += kStep)
            for (int x = 0; x + width <= window.width(); x += kStep) {
                const PixelRect place{window.x0 + x, window.y0 + y, window.x0 + x + width,
                                      window.y0 + y + height};
                const bool taken = std::any_of(places.begin(), places.end(), [&](const PixelRect& other) {
                    return !intersection(place, other).empty();
                });
                const double sum = sums.sum(x, y, width, height);
                if (!taken && sum > most) most = sum, worst = place;
            }
        if (most <= 0) break;  // nothing differs in what is left
        places.push_back(worst);
    }
    return places;
}

}  // namespace trapeze
