#include "shade/clouds/surfel_raster.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/portable_math.h"
#include "shade/rays/ray_directions.h"

namespace trapeze {
namespace {

constexpr float kHalfTurn = std::numbers::pi_v<float>;
constexpr int kSide = SkyPart::kSide;
constexpr float kPixel = 2.0f / kSide;  ///< a pixel's side; the disc's radius is 1

/// A disc of radius r covers (1 - (d / (kSpread r))^2)^3 times kPeak at a distance d from its middle, which
/// adds up to its area. On a square grid of discs the sum is 1 to some hundredths: the function's transform,
/// by J4, is zero at the grid's frequency.
constexpr float kSpread = 2.14f, kPeak = 4 / (kSpread * kSpread);

/// Discs rise above the horizon from this part of their radius on; and are steep, which a square of a sine
/// tells.
constexpr float kRises = 0.1f, kSteep = 0.05f;
/// How soft the edges of pieces of surface are, radians: a pixel in the middle.
constexpr float kEdge = kPixel;

/// Floats that are worked on together: the compiler makes vectors of them.
constexpr int kRasterLanes = SurfelRaster::kLanes;

/// In an order of its own, the same everywhere.
float added(const SurfelRaster::Lanes& lanes) {
    float sum = 0;
    for (const float lane : lanes) sum += lane;
    return sum;
}

float larger(float a, float b) {
    return a > b ? a : b;
}
float smaller(float a, float b) {
    return a < b ? a : b;
}

/// The middle of a pixel along an axis.
float middle(int i) {
    return (static_cast<float>(i) + 0.5f) * kPixel - 1;
}

/// Pixels along an axis whose middles are between two places.
struct PixelRange {
    PixelRange(float low, float high)
        : first(static_cast<int>(std::clamp((low + 1) / kPixel, 0.0f, static_cast<float>(kSide)))),
          end(static_cast<int>(std::clamp((high + 1) / kPixel + 1, 0.0f, static_cast<float>(kSide)))) {}
    int first, end;
};

/// Calls use(row, first column) for kRasterLanes pixels at a time, which hold those of the ranges.
template <class Use>
void for_each_row(const PixelRange& columns, const PixelRange& rows, const Use& use) {
    static_assert(kSide == 2 * kRasterLanes);
    const bool one = columns.end - columns.first <= kRasterLanes;
    for (int j = rows.first; j < rows.end; ++j) {
        use(j, one ? std::min(columns.first, kRasterLanes) : 0);
        if (!one) use(j, kRasterLanes);
    }
}

/// The middle of the part of a pixel that is within the rim; of a pixel beyond it the pixel's own.
V2f middle_within(int i, int j) {
    constexpr int kParts = 8;
    V2f sum(0, 0);
    int count = 0;
    for (int part = 0; part < kParts * kParts; ++part) {
        const auto off = [](int k) { return ((static_cast<float>(k) + 0.5f) / kParts - 0.5f) * kPixel; };
        const V2f at(middle(i) + off(part % kParts), middle(j) + off(part / kParts));
        if (at.length2() < 1) sum += at, ++count;
    }
    return count > 0 ? sum / static_cast<float>(count) : V2f(middle(i), middle(j));
}

/// The directions of the pixels, of those at the rim what is in the middle of the part within it; and which
/// part of each is within it.
struct Pixels {
    Pixels() {
        const SkyPart all(kHalfTurn / 2, false);
        float most = 0;
        for (int p = 0; p < SkyPart::kPixels; ++p) most = std::max(most, all.weight(p));
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const auto p = static_cast<size_t>(j * kSide + i);
                const V2f at = middle_within(i, j);
                const float r = at.length(), scale = r > 1 ? 1 / r : 1;
                x[p] = at.x * scale, y[p] = at.y * scale;
                z[p] = r < 1 ? std::sqrt(1 - r * r) : 0;
                inside[p] = all.weight(static_cast<int>(p)) / most;
            }
        area = kHalfTurn * most;
    }
    std::array<float, SkyPart::kPixels> x, y, z, inside;
    float area = 0;  ///< of a pixel that is inside wholly; all together are the unit disc
};

const Pixels& pixels() {
    static const Pixels all;
    return all;
}

/// Where along an axis a cone about a direction goes, seen from above.
PixelRange extent_of(float along, float sine, float cosine) {
    const float across = std::sqrt(std::max(0.0f, 1 - along * along)) * sine, mean = along * cosine;
    return {along < -cosine ? -1 : mean - across, along > cosine ? 1 : mean + across};
}

/// Columns and rows of what is seen between four corners, and half an edge's width around.
std::pair<PixelRange, PixelRange> extents_of(const std::array<V3f, 4>& corners, const V3f& middle) {
    constexpr float kLeast = 0.1f, kWider = kEdge / 2;
    const float length = middle.length();
    float nearest = 1;
    for (const V3f& corner : corners)
        nearest = smaller(nearest, corner.dot(middle) / larger(corner.length() * length, 1e-30f));
    if (!(nearest > kLeast)) return {PixelRange(-1, 1), PixelRange(-1, 1)};
    const float sine = std::sqrt(1 - nearest * nearest) + kWider;
    const float cosine = std::sqrt(larger(0, 1 - sine * sine));
    const V3f at = middle / length;
    return {extent_of(at.x, smaller(sine, 1), cosine), extent_of(at.y, smaller(sine, 1), cosine)};
}

}  // namespace

SkyPart::SkyPart(float angle, bool uniform) {
    constexpr int kParts = 8;  // of a pixel along each axis
    const float rim = angle < kHalfTurn / 2 ? portable::sin(angle) : 1.0f, rim2 = rim * rim;
    double sum = 0;
    for (int p = 0; p < kPixels; ++p) {
        double weight = 0;
        for (int part = 0; part < kParts * kParts; ++part) {
            const auto place = [](int pixel, int of) {
                return (static_cast<float>(pixel) + (static_cast<float>(of) + 0.5f) / kParts) * kPixel - 1;
            };
            const float x = place(p % kSide, part % kParts), y = place(p / kSide, part / kParts);
            const float r2 = x * x + y * y;
            if (r2 < rim2) weight += uniform ? 1 / std::sqrt(1 - static_cast<double>(r2)) : 1.0;
        }
        weights_[static_cast<size_t>(p)] = static_cast<float>(weight);
        sum += weight;
    }
    // A cone that is narrower than a pixel's parts are apart is its pixels in the middle.
    if (!(sum > 0)) {
        for (const int p : {kPixels / 2 - kSide / 2 - 1, kPixels / 2 - kSide / 2, kPixels / 2 + kSide / 2 - 1,
                            kPixels / 2 + kSide / 2})
            weights_[static_cast<size_t>(p)] = 1;
        sum = 4;
    }
    for (float& weight : weights_) weight = static_cast<float>(weight / sum), seen_ += weight > 0 ? 1 : 0;
}

void SurfelRaster::start(const V3f& normal, const SkyPart& sky, bool clamp) {
    const Cone cone(normal, 0);
    across_ = cone.across(), along_ = cone.along(), normal_ = normal;
    sky_ = &sky, clamp_ = clamp;
    front_.fill(0), back_.fill(0);
    has_layers_ = false;
    hidden_ = 0, light_ = V3f(0);
}

void SurfelRaster::Layers::start() {
    covered.fill(0), begun.fill(0), hiding.fill(0);
    reaches.fill(1);
}

void SurfelRaster::Layers::add(size_t pixel, float share, float opacity) {
    const float all = smaller(1, share), now = smaller(all, 1 - begun[pixel]), later = all - now;
    covered[pixel] = smaller(1, covered[pixel] + all);
    begun[pixel] += now, hiding[pixel] += opacity * now;
    if (begun[pixel] < 1) return;
    reaches[pixel] *= larger(0, 1 - hiding[pixel]);
    begun[pixel] = later, hiding[pixel] = opacity * later;
}

/// Where a closed thing's fronts and backs both are, light passes two layers.
float SurfelRaster::hidden_by_layers(size_t pixel) const {
    const float most = larger(front_layers_.covered[pixel], back_layers_.covered[pixel]);
    const float front = front_layers_.hidden(pixel), back = back_layers_.hidden(pixel);
    return most > 0 ? smaller(1, front + back - front * back / most) : 0;
}

/// A closed thing covers the same pixels by its fronts and its backs: of opaque ones that is what is hidden.
/// Whatever lets light through is not beside them, but before or behind.
float SurfelRaster::hidden_at(size_t pixel) const {
    const float opaque = larger(front_[pixel], back_[pixel]);
    return has_layers_ ? opaque + (1 - opaque) * hidden_by_layers(pixel) : opaque;
}

/// Covers shares of some pixels in a row.
void SurfelRaster::cover(int first, const float* shares, float front, float back, const SeenSurface& thing,
                         Lanes& sums) {
    const float* const weights = sky_->weights() + first;
    if (!clamp_) {
        const float hides = (front + back) * thing.opacity;
        for (size_t k = 0; k < kRasterLanes; ++k) sums[k] += hides * shares[k] * weights[k];
    } else if (thing.opacity < 1) {
        cover_in_layers(first, shares, front, back, thing.opacity, sums);
    } else {
        cover_opaque(first, shares, front, back, sums);
    }
}

void SurfelRaster::cover_opaque(int first, const float* shares, float front, float back, Lanes& sums) {
    float* const fronts = &front_[static_cast<size_t>(first)];
    float* const backs = &back_[static_cast<size_t>(first)];
    const float* const weights = sky_->weights() + first;
    Lanes added;
    for (size_t k = 0; k < kRasterLanes; ++k) {
        const float before = larger(fronts[k], backs[k]);
        fronts[k] = smaller(1, fronts[k] + front * shares[k]);
        backs[k] = smaller(1, backs[k] + back * shares[k]);
        added[k] = (larger(fronts[k], backs[k]) - before) * weights[k];
    }
    for (size_t k = 0; k < kRasterLanes && has_layers_; ++k)
        added[k] *= 1 - hidden_by_layers(static_cast<size_t>(first) + k);
    for (size_t k = 0; k < kRasterLanes; ++k) sums[k] += added[k];
}

void SurfelRaster::cover_in_layers(int first, const float* shares, float front, float back, float opacity,
                                   Lanes& sums) {
    if (!has_layers_) front_layers_.start(), back_layers_.start();
    has_layers_ = true;
    for (size_t k = 0; k < kRasterLanes; ++k) {
        if (!(shares[k] > 0)) continue;
        const size_t pixel = static_cast<size_t>(first) + k;
        const float before = hidden_at(pixel);
        if (front > 0) front_layers_.add(pixel, front * shares[k], opacity);
        if (back > 0) back_layers_.add(pixel, back * shares[k], opacity);
        sums[k] += (hidden_at(pixel) - before) * sky_->weight(static_cast<int>(pixel));
    }
}

void SurfelRaster::take(float part, const SeenSurface& thing) {
    hidden_ += part * thing.counts;
    light_ += thing.color * part;
}

/// It is spread over an ellipse, of what a ball of its solid angle would be, and a pixel more.
void SurfelRaster::add_small(const V3f& way, const SeenSurface& thing) {
    const V3f at = to_raster(way);
    if (!(at.z > 0)) return;
    const float solid_angle = std::max(thing.front, thing.back) / thing.opacity;
    const float across = kSpread * std::sqrt(solid_angle / kHalfTurn) + kPixel;
    const float out = (across - kPixel) * at.z + kPixel;
    const float r = std::sqrt(at.x * at.x + at.y * at.y), ex = r > 0 ? at.x / r : 1,
                ey = r > 0 ? at.y / r : 0;
    const float wide = std::sqrt(out * ex * out * ex + across * ey * across * ey);
    const float high = std::sqrt(out * ey * out * ey + across * ex * across * ex);
    const PixelRange columns(at.x - wide, at.x + wide), rows(at.y - high, at.y + high);
    const float ox = ex / out, oy = ey / out, ax = -ey / across, ay = ex / across;
    const Pixels& all = pixels();
    std::array<float, SkyPart::kPixels> shares;
    Lanes sums{};
    float* to = shares.data();
    for_each_row(columns, rows, [&](int j, int first) {
        const float dy = middle(j) - at.y, u_of_row = dy * oy, v_of_row = dy * ay;
        const float* const inside = &all.inside[static_cast<size_t>(j * kSide + first)];
        for (int k = 0; k < kRasterLanes; ++k) {
            const float dx = middle(first + k) - at.x, u = dx * ox + u_of_row, v = dx * ax + v_of_row;
            const float left = 1 - u * u - v * v, share = left > 0 ? left * left * left : 0;
            to[k] = share;
            sums[static_cast<size_t>(k)] += share * inside[k];
        }
        to += kRasterLanes;
    });
    const float sum = added(sums);
    if (!(sum > 0)) return;
    const float scale = at.z / (all.area * sum * thing.opacity);
    const float* from = shares.data();
    Lanes parts{};
    for_each_row(columns, rows, [&](int j, int first) {
        cover(j * kSide + first, from, thing.front * scale, thing.back * scale, thing, parts);
        from += kRasterLanes;
    });
    take(added(parts), thing);
}

/// A ray through the middle of each pixel meets the disc's plane.
///
/// Of a wall that ends where the place's surface begins the discs' soft rims would be half lost below the
/// horizon: what would go there is mirrored, along the disc, to where the wall is. Discs whose middle is on
/// the horizon, or below, count by their fronts alone: the backs are those of a thing that the place is on,
/// beyond its edge.
void SurfelRaster::add_disc(const V3f& way, const V3f& normal, float radius, const SeenSurface& thing) {
    const float reach = radius * kSpread, distance = way.length();
    const V3f at = to_raster(way), turned = to_raster(normal == V3f(0) ? way / -distance : normal);
    const bool rises = at.z > kRises * radius;
    if (!rises && !(thing.front > 0)) return;
    const float sine = distance > reach ? reach / distance : 1;
    const float cosine = distance > reach ? std::sqrt(1 - sine * sine) : -1;
    const PixelRange columns = extent_of(at.x / distance, sine, cosine);
    const PixelRange rows = extent_of(at.y / distance, sine, cosine);
    // Along the disc, upwards; how much of a height it takes to the mirrored one.
    const V3f upward = V3f(0, 0, 1) - turned * turned.z;
    const V3f mirror = rises && upward.z > kSteep ? upward * (2 / upward.z) : V3f(0);
    const float plane = at.dot(turned), of_reach = 1 / (reach * reach);
    const float front = thing.front > 0 ? kPeak : 0, back = thing.back > 0 ? kPeak : 0;
    const float mirrors = mirror == V3f(0) ? 0 : 1;
    const Pixels& all = pixels();
    Lanes parts{}, shares;
    for_each_row(columns, rows, [&](int j, int first) {
        const auto p = static_cast<size_t>(j * kSide + first);
        for (size_t k = 0; k < kRasterLanes; ++k) {
            const float x = all.x[p + k], y = all.y[p + k], z = all.z[p + k];
            const float t = plane / (x * turned.x + y * turned.y + z * turned.z);
            const float dx = x * t - at.x, dy = y * t - at.y, dz = z * t - at.z;
            const float h = z * t, mx = dx - h * mirror.x, my = dy - h * mirror.y, mz = dz - h * mirror.z;
            const float left = 1 - (dx * dx + dy * dy + dz * dz) * of_reach;
            const float mirrored = mirrors * (1 - (mx * mx + my * my + mz * mz) * of_reach);
            const float own = left > 0 ? left * left * left : 0;
            const float other = mirrored > 0 ? mirrored * mirrored * mirrored : 0;
            shares[k] = t > 0 ? own + other : 0;
        }
        cover(j * kSide + first, shares.data(), front, back, thing, parts);
    });
    take(added(parts), thing);
}

/// Of each edge the plane through it and the place: a direction is as far within the piece as it is within
/// all four.
void SurfelRaster::add_quad(const SurfelQuad& ways, float area, const SeenSurface& thing) {
    std::array<V3f, 4> corners, edges;
    V3f middle(0), turned(0);
    for (size_t k = 0; k < 4; ++k) corners[k] = to_raster(ways[k]), middle += corners[k];
    int planes = 0;
    for (size_t k = 0; k < 4; ++k) {
        edges[k] = corners[k].cross(corners[(k + 1) % 4]);
        turned += edges[k];
        const float length = edges[k].length();
        planes += length > 0 ? 1 : 0;
        edges[k] = length > 0 ? edges[k] / length : V3f(0);
    }
    if (planes < 3) return;
    const float side = turned.dot(middle) < 0 ? -1.0f / kEdge : 1.0f / kEdge;
    std::array<float, 4> within;  // of an edge that is a point, all is
    for (size_t k = 0; k < 4; ++k) within[k] = edges[k] == V3f(0) ? 1 : 0.5f, edges[k] *= side;
    const float own = (corners[2] - corners[0]).cross(corners[3] - corners[1]).length() / 2;
    const float part = own > area ? area / own : 1;
    const float front = thing.front > 0 ? part : 0, back = thing.back > 0 ? part : 0;
    const auto [columns, rows] = extents_of(corners, middle);
    const Pixels& all = pixels();
    Lanes parts{}, shares;
    for_each_row(columns, rows, [&](int j, int first) {
        const auto p = static_cast<size_t>(j * kSide + first);
        for (size_t k = 0; k < kRasterLanes; ++k) {
            float share = 1;
            for (size_t e = 0; e < 4; ++e) {
                const float in = all.x[p + k] * edges[e].x + all.y[p + k] * edges[e].y +
                                 all.z[p + k] * edges[e].z + within[e];
                share *= in < 0 ? 0 : smaller(in, 1);
            }
            shares[k] = share;
        }
        cover(j * kSide + first, shares.data(), front, back, thing, parts);
    });
    take(added(parts), thing);
}

void SurfelRaster::open_parts(std::vector<V3f>& ways, std::vector<float>& parts) const {
    const Pixels& all = pixels();
    ways.clear(), parts.clear();
    for (int p = 0; p < SkyPart::kPixels; ++p) {
        const auto i = static_cast<size_t>(p);
        const float open = (1 - hidden_at(i)) * sky_->weight(p);
        if (!(open > 0)) continue;
        ways.push_back(across_ * all.x[i] + along_ * all.y[i] + normal_ * all.z[i]);
        parts.push_back(open);
    }
}

V3f SurfelRaster::open_way() const {
    const Pixels& all = pixels();
    V3f sum(0);
    for (int p = 0; p < SkyPart::kPixels; ++p) {
        const auto i = static_cast<size_t>(p);
        const float open = (1 - hidden_at(i)) * sky_->weight(p);
        sum += V3f(all.x[i], all.y[i], all.z[i]) * open;
    }
    return across_ * sum.x + along_ * sum.y + normal_ * sum.z;
}

}  // namespace trapeze
