#include "sample/patterns/lens_outline.h"

#include <cmath>

#include "core/math.h"
#include "core/portable_math.h"

namespace trapeze {
namespace {

constexpr int kChords = 256;        ///< of the whole rim, at least, where it bows
constexpr int kRoundBlades = 8;     ///< that a round opening is made of: arcs of its rim
constexpr double kStraight = 1e-4;  ///< radians of bend below which a side is one chord

struct Point {
    double x, y;
};

double cross(const Point& a, const Point& b) {
    return a.x * b.y - a.y * b.x;
}

/// A side whose middle is on the axis x, as an arc of a circle. All blades are this one turned; computed in
/// doubles with portable functions, so that the lens is the same on every machine.
class Blade {
  public:
    explicit Blade(const Aperture& aperture) {
        const double half = M_PI / aperture.blades;
        // Sides may not bend in further than to where they run straight to the middle from the corners.
        const double most = aperture.roundness >= 0 ? half : std::min(half, M_PI / 2 - half);
        bend_ = most * aperture.roundness;
        middle_ = portable::cos(half), reach_ = portable::sin(half);
        chords_ = is_straight() ? 1 : (kChords + aperture.blades - 1) / aperture.blades;
    }

    int chords() const { return chords_; }

    /// `at` runs from -1, one corner, to 1, the next one.
    Point point(double at) const {
        if (is_straight()) return {middle_, reach_ * at};
        const double radius = reach_ / portable::sin(bend_), angle = bend_ * at;
        return {middle_ + radius * (portable::cos(angle) - portable::cos(bend_)),
                radius * portable::sin(angle)};
    }

    /// The ends of chords that make triangles of one area with the middle.
    std::vector<Point> corners() const {
        std::vector<Point> made;
        double low = 0, high = 4 * M_PI / chords_;  // twice the area of a triangle
        for (int i = 0; i < kHalvings; ++i) {
            const double area = (low + high) / 2;
            (step_along(area, nullptr) ? low : high) = area;
        }
        step_along(low, &made);
        return made;
    }

  private:
    static constexpr int kHalvings = 36;

    bool is_straight() const { return std::abs(bend_) < kStraight; }

    /// Steps along the side by triangles of twice the area `area`; false where they end beyond it. All ends
    /// but the last one are added to `ends`.
    bool step_along(double area, std::vector<Point>* ends) const {
        double at = -1;
        const Point last = point(1);
        for (int step = 0; step < chords_; ++step) {
            const Point from = point(at);
            if (ends) ends->push_back(from);
            if (cross(from, last) < area) return false;
            double low = at, high = 1;
            for (int i = 0; i < kHalvings; ++i) {
                const double middle = (low + high) / 2;
                (cross(from, point(middle)) < area ? low : high) = middle;
            }
            at = high;
        }
        return true;
    }

    double bend_, middle_, reach_;  ///< half the arc's angle; the chord's distance and half its length
    int chords_;
};

/// The same opening by blades.
Aperture with_blades(const Aperture& aperture) {
    Aperture made = aperture;
    if (aperture.is_round()) made.blades = kRoundBlades, made.roundness = 1;
    return made;
}

}  // namespace

/// Chords are chosen by the area of their triangles and not by their length, for points are spread over
/// triangles evenly.
LensOutline::LensOutline(const Aperture& given) : density(given.density) {
    if (given.is_disk()) return;
    const Aperture aperture = with_blades(given);
    const Blade blade(aperture);
    const std::vector<Point> corners = blade.corners();
    // From the corner nearest to -45 degrees, where the square's outline begins: cells of the square stay
    // near their place.
    const double step = 360.0 / aperture.blades, first = std::round((-45 - aperture.angle) / step);
    for (int side = 0; side < aperture.blades; ++side) {
        const double turn = (aperture.angle + (first + side + 0.5) * step) * (M_PI / 180);
        const double cosine = portable::cos(turn), sine = portable::sin(turn);
        for (const Point& p : corners) {
            x.push_back(static_cast<float>(p.x * cosine - p.y * sine));
            y.push_back(static_cast<float>(p.x * sine + p.y * cosine));
        }
    }
    for (size_t i = 0; i < size(); ++i) {
        const size_t next = (i + 1) % size();
        dx.push_back(x[next] - x[i]), dy.push_back(y[next] - y[i]);
    }
}

}  // namespace trapeze
