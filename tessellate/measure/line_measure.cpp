#include "tessellate/measure/line_measure.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/grid.h"
#include "tessellate/measure/lattice_measure.h"

namespace trapeze {
namespace {

/// Keys at which foreshortening may be trusted; 0: not at all. Rotations, whose keys are many, may show any
/// side between them; displaced surfaces, curves and points lie otherwise than their lines tell.
int keys_to_look_at(const PlacedSurface& surface, bool displaced) {
    const Attributes& attributes = *surface.primitive().attributes;
    const Topology& topology = surface.primitive().shape().topology;
    const bool plain =
        !displaced && !std::holds_alternative<Curves>(topology) && !std::holds_alternative<Points>(topology);
    return plain && attributes.dice.raster_oriented && surface.key_count() <= LineMeasure::kMostKeys
               ? surface.key_count()
               : 0;
}

/// How far a line leaves the chord between its points before and after the middle one.
float bend(const V3f& before, const V3f& at, const V3f& after) {
    const V3f chord = after - before, second = (after - at) - (at - before);
    const float length = chord.length();
    return length > 0 ? second.cross(chord).length() / length : second.length();
}

/// Whether a line in front of the eye leads so far into depth that it has to be split.
bool is_deep(std::span<const V3f> P) {
    const float a = P.front().z, b = P.back().z;
    return a > 0 && b > 0 && std::max(a, b) > kDeepestLine * std::min(a, b);
}

}  // namespace

/// Uneven: uniform segments as fine as the longest piece wants would be half as many again as are needed.
bool RateEstimate::wants_split(float pixels_per_segment) const {
    if (deep) return true;
    const float even = sum / pixels_per_segment;
    const float uneven = static_cast<float>(pieces) * longest / pixels_per_segment;
    return even > kMaxGridSide || uneven > 1.5f * even + 2;  // false for NaN
}

int RateEstimate::clamped_segments(const EdgeRate& rate) const {
    const float n = std::ceil(segments(rate.pixels_per_segment));
    const int wanted = n >= 1 ? static_cast<int>(std::min<float>(n, kMaxGridSide)) : 1;  // also NaN
    return rate.binary ? static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted))) : wanted;
}

/// The lens and the flatness are taken once: the measure is asked for every line of the primitive.
LineMeasure::LineMeasure(const ScreenMetric& metric, const Camera& camera, const PlacedSurface& surface,
                         bool displaced, float pixels_per_segment, bool from_all_sides)
    : metric_(metric),
      least_(surface.primitive().attributes->dice.raster_oriented && !from_all_sides ? kLeastForeshortening
                                                                                     : 1.0f),
      keys_(from_all_sides ? 0 : keys_to_look_at(surface, displaced)),
      flatness_(pixels_per_segment / 32),
      rate_(pixels_per_segment),
      lens_radius_(camera.perspective ? camera.lens_radius : camera.lens_radius / camera.focal_distance),
      perspective_(camera.perspective) {}

RateEstimate LineMeasure::of(std::span<const V3f> P) const {
    std::array<float, kMostPieces> counted;
    const size_t pieces = P.size() - 1;
    lengths(P.first(pieces), P.subspan(1), counted);
    RateEstimate estimate;
    for (size_t i = 0; i < pieces; ++i) estimate.add(counted[i]);
    return estimate;
}

void LineMeasure::lengths(std::span<const V3f> from, std::span<const V3f> to,
                          std::span<float> counted) const {
    std::array<PixelLength, kMostLengths> lengths;
    metric_.of(from, to, lengths);
    for (size_t i = 0; i < from.size(); ++i)
        counted[i] = std::max(lengths[i].seen, least_ * lengths[i].square_on);
}

void LineMeasure::of(std::span<const PlacedLattices> keys, LatticeLines& lines) const {
    measure_lattices(keys, {metric_, least_, keys_ > 0, rate_, flatness_, lens_radius_}, lines);
}

/// Sine of the angle by which rays to a point differ over the lens.
float LineMeasure::lens_angle(const V3f& p) const {
    return perspective_ ? lens_radius_ / std::max(p.length(), lens_radius_) : lens_radius_;
}

/// What counts of a length along a line where the surface's other lines are seen to cross it at a slant:
/// less, along both, so that micropolygons are slivers of an area nearer to that of a pixel.
float LineMeasure::slant(const V3f& p, const V3f& along, const V3f& across) const {
    const V3f ray = perspective_ ? p : V3f(0, 0, 1);
    const V3f a = ray.cross(along), b = ray.cross(across);  // as seen, but turned
    float lengths = std::sqrt(a.dot(a) * b.dot(b));
    // The product is of the eighth power of a length: too large or too small for things far away or tiny.
    if (!(lengths > 0 && lengths < kInfinity)) lengths = std::sqrt(a.dot(a)) * std::sqrt(b.dot(b));
    if (!(lengths > 0)) return 1;
    const float sine = std::abs(ray.dot(along.cross(across))) * ray.length() / lengths;
    return std::clamp(std::sqrt(sine / kSlantedSine), kLeastSlant, 1.0f);
}

/// For each piece the most that any key, any point of the lens or the curve's bend wants of it, but not more
/// than without foreshortening, nor less than what is seen at the first key.
RateEstimate LineMeasure::foreshortened(std::span<const V3f> P, std::span<const V3f> beside) const {
    const size_t points = P.size() / static_cast<size_t>(keys_), pieces = points - 1;
    std::array<float, kMostPieces> seen{}, least{}, most{};
    bool in_view = true;
    for (int key = 0; key < keys_; ++key) {
        const V3f* const p = P.data() + static_cast<size_t>(key) * points;
        const V3f* const q = beside.data() + static_cast<size_t>(key) * points;
        std::array<float, kMostPieces> scale;  // pixels of a unit of length
        std::array<PixelLength, kMostPieces> lengths;
        metric_.of({p, pieces}, {p + 1, pieces}, lengths);
        for (size_t i = 0; i < pieces; ++i) {
            const PixelLength& length = lengths[i];
            const float own = (p[i + 1] - p[i]).length();
            scale[i] = own > 0 ? length.square_on / own : 0;
            const float at_most = std::max(length.seen, least_ * length.square_on);
            in_view &= length.in_view;
            const float counted =
                length.in_view ? length.seen * slant(p[i], p[i + 1] - p[i], q[i] - p[i]) : at_most;
            if (key == 0) seen[i] = counted, most[i] = at_most;
            // The most of all keys, and what the lens's rim sees of it.
            least[i] = std::max({least[i], counted, lens_angle(p[i]) * length.square_on});
        }
        // n segments of a curve that is h high over its chord leave it by h / n^2.
        for (size_t i = 1; i < pieces; ++i) {
            const float height = bend(p[i - 1], p[i], p[i + 1]) * std::max(scale[i - 1], scale[i]) / 8;
            const float wanted = rate_ * std::sqrt(height / flatness_);
            least[i - 1] = std::max(least[i - 1], wanted), least[i] = std::max(least[i], wanted);
        }
    }
    RateEstimate estimate;
    estimate.deep = perspective_ && in_view && is_deep(P.first(points));
    for (size_t i = 0; i < pieces; ++i) estimate.add(std::max(seen[i], std::min(most[i], least[i])));
    return estimate;
}

}  // namespace trapeze
