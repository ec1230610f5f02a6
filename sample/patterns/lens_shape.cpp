#include "sample/patterns/lens_shape.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// from_square() rounds by less than this; as for the disk.
constexpr double kRounding = 2e-6;
/// What is under a density's root rounds by less than this part of its terms; near 0 the root makes much of
/// it.
constexpr double kRadicandRounding = 1e-6;
/// Of places along the outline, in corners.
constexpr double kPlaceRounding = 1e-4;
/// A region is bounded in so many parts along each side: bounds of parts are products of ranges.
constexpr int kParts = 16;

struct Extent {
    double min, max;
};

/// What the distance from the middle becomes: with density d the brightness, linear in the area within, is
/// 1 + d (2 r'^2 - 1), so that (1 - d) r'^2 + d r'^4 = r^2. The terms under the
/// root are off by `slack` of them.
double spread(double r, double d, double slack) {
    const double even = (1 - d) * (1 - d), rising = 4 * d * r * r;
    const double inner = std::max(even + rising + slack * (even + std::abs(rising)), 0.0);
    const double divisor = 1 - d + std::sqrt(inner);
    return std::min(r * std::sqrt(2 / std::max(divisor, double{kLeastDivisor})), 1.0);
}

/// Grows to hold what the outline's coordinate `from` + f * `along` is for places first to last, times
/// distances.
void add_piece(const std::vector<float>& from, const std::vector<float>& along, Extent place, Extent distance,
               Extent& to) {
    const auto count = static_cast<double>(from.size());
    place = {std::max(place.min - kPlaceRounding, 0.0), std::min(place.max + kPlaceRounding, count)};
    const auto add = [&](double at) {
        const auto corner = static_cast<size_t>(std::clamp(std::floor(at), 0.0, count - 1));
        const double rim = static_cast<double>(from[corner]) +
                           (at - static_cast<double>(corner)) * static_cast<double>(along[corner]);
        for (const double r : {distance.min, distance.max})
            to = {std::min(to.min, r * rim), std::max(to.max, r * rim)};
    };
    add(place.min), add(place.max);
    for (double corner = std::ceil(place.min); corner < place.max; ++corner) add(corner);
}

/// Grows `box` by the part of a rectangle of [-1, 1]^2 that is nearest to one of its four sides, the one in
/// the direction of `axis` (right, up, left, down) after turning: `out` towards that side, `across` it.
void add_quarter(const LensOutline& outline, int axis, Extent out, Extent across, Extent& u, Extent& v) {
    const double least_across = across.min > 0 ? across.min : std::min(across.max, 0.0) * -1;
    if (out.max < least_across || out.max <= 0) return;
    const double least = std::max({out.min, least_across, 0.0});
    const auto ratio = [&](double at, bool greatest) {
        const double by = (at > 0) == greatest ? least : out.max;
        return by <= 0 ? (greatest ? 1.0 : -1.0) : std::clamp(at / by, -1.0, 1.0);
    };
    const double scale = static_cast<double>(outline.size()) / 8, middle = 2 * axis + 1;
    const Extent place{(middle + ratio(across.min, false)) * scale,
                       (middle + ratio(across.max, true)) * scale};
    const double d = outline.density;
    const Extent distance{spread(least, d, kRadicandRounding), spread(out.max, d, -kRadicandRounding)};
    add_piece(outline.x, outline.dx, place, distance, u);
    add_piece(outline.y, outline.dy, place, distance, v);
}

}  // namespace

/// Four quarters of the square, each between its diagonals, become what the middle sees of two eighths of the
/// outline; `place` is where on the outline, in corners, and `distance` how far out.
V2f LensShape::from_square(float u, float v) const {
    if (outline_.size() == 0) return disk_from_square(u, v);
    const float a = 2 * u - 1, b = 2 * v - 1;
    const bool wide = std::abs(a) > std::abs(b);
    const float r = wide ? a : b, other = wide ? b : a;
    const float ratio = other / (r == 0 ? 1 : r);
    const float quarter = (wide ? 1.0f : 3.0f) + (r < 0 ? 4.0f : 0.0f);  // of eighths around the square
    const auto count = static_cast<float>(outline_.size());
    const float place = (quarter + (wide ? ratio : -ratio)) * (count * 0.125f);
    const auto corner = static_cast<size_t>(std::min(place, count - 1));
    const float part = place - static_cast<float>(corner);
    const float d = outline_.density, even = 1 - d;
    const float inner = std::max(even * even + 4 * d * (r * r), 0.0f);
    const float divisor = std::max(even + std::sqrt(inner), kLeastDivisor);
    const float distance = std::abs(r) * std::sqrt(2 / divisor);
    return {distance * (outline_.x[corner] + part * outline_.dx[corner]),
            distance * (outline_.y[corner] + part * outline_.dy[corner])};
}

/// Cut into small parts, since the bound of a part is a product of its ranges of place and distance: coarse
/// for a large region, close for a small one.
LensBox LensShape::region(uint32_t index, int nx, int ny) const {
    if (outline_.size() == 0) return lens_region(index, nx, ny);
    const auto axis = [](uint32_t at, int count, int part) {
        const auto place = [&](int border) {
            return 2 * (at + static_cast<double>(border) / kParts) / count - 1;
        };
        return Extent{place(part) - kRounding, place(part + 1) + kRounding};
    };
    Extent u{2, -2}, v{2, -2};
    for (int j = 0; j < kParts; ++j)
        for (int i = 0; i < kParts; ++i) {
            const Extent a = axis(index % static_cast<uint32_t>(nx), nx, i),
                         b = axis(index / static_cast<uint32_t>(nx), ny, j);
            const Extent left{-a.max, -a.min}, down{-b.max, -b.min};
            add_quarter(outline_, 0, a, b, u, v);
            add_quarter(outline_, 1, b, left, u, v);
            add_quarter(outline_, 2, left, down, u, v);
            add_quarter(outline_, 3, down, a, u, v);
        }
    return {static_cast<float>(u.min - kRounding), static_cast<float>(v.min - kRounding),
            static_cast<float>(u.max + kRounding), static_cast<float>(v.max + kRounding)};
}

}  // namespace trapeze
