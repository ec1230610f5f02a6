/// Discs for tests, and what a point sees of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shade/clouds/surfel_raster.h"
#include "shade/clouds/surfel_tree.h"

namespace trapeze::testing {

/// Half a turn.
inline constexpr double kHalfTurn64 = std::numbers::pi;

inline void add_disc(Surfels& surfels, const V3f& position, const V3f& normal, double area) {
    surfels.positions.push_back(position);
    surfels.normals.push_back(normal);
    surfels.areas.push_back(static_cast<float>(area));
}

/// A parallelogram of n x n discs: corner + s along + t across.
inline void add_sheet(Surfels& surfels, int n, const V3f& corner, const V3f& along, const V3f& across) {
    const V3f normal = along.cross(across);
    for (int i = 0; i < n * n; ++i) {
        const float s = (static_cast<float>(i % n) + .5f) / static_cast<float>(n);
        const float t = (static_cast<float>(i / n) + .5f) / static_cast<float>(n);
        add_disc(surfels, corner + along * s + across * t, normal.normalized(),
                 static_cast<double>(normal.length()) / (n * n));
    }
}

/// The six sides of a cube from -half to half, facing inwards.
inline Surfels box(int n, float half) {
    Surfels surfels;
    const float h = half, w = 2 * half;
    add_sheet(surfels, n, {-h, -h, -h}, {w, 0, 0}, {0, w, 0});
    add_sheet(surfels, n, {-h, -h, h}, {0, w, 0}, {w, 0, 0});
    add_sheet(surfels, n, {-h, -h, -h}, {0, w, 0}, {0, 0, w});
    add_sheet(surfels, n, {h, -h, -h}, {0, 0, w}, {0, w, 0});
    add_sheet(surfels, n, {-h, -h, -h}, {0, 0, w}, {w, 0, 0});
    add_sheet(surfels, n, {-h, h, -h}, {w, 0, 0}, {0, 0, w});
    return surfels;
}

/// A sphere of about so many discs of the same area, facing outwards (Fibonacci's spiral).
inline Surfels sphere(int count, const V3f& middle, double radius) {
    Surfels surfels;
    const double turn = kHalfTurn64 * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
        const V3f n(V3d(r * std::cos(turn * i), r * std::sin(turn * i), z));
        add_disc(surfels, middle + n * static_cast<float>(radius), n,
                 4 * kHalfTurn64 * radius * radius / count);
    }
    return surfels;
}

/// What a place sees: pieces from the nearest to the farthest.
struct Look {
    SkyPart sky{static_cast<float>(kHalfTurn64 / 2), false};
    bool clamp = true, fronts = true, backs = true;
    std::vector<SurfelPiece> pieces = {};
    SurfelRaster raster = {};

    double hidden(const SurfelTree& tree, const SurfelPlace& place) {
        tree.cut(place, pieces);
        std::ranges::sort(pieces, {}, &SurfelPiece::distance);
        raster.start(place.normal, sky, clamp);
        for (const SurfelPiece& piece : pieces) {
            SeenSurface seen;
            const float d2 = piece.distance * piece.distance;
            seen.front = fronts ? piece.front / d2 : 0, seen.back = backs ? piece.back / d2 : 0;
            seen.color = tree.radiosity(piece);
            if (!(seen.front > 0) && !(seen.back > 0)) continue;
            if (piece.is_large)
                raster.add_disc(piece.way, tree.surfels().normals[piece.number],
                                tree.disc_radius(piece.number), seen);
            else
                raster.add_small(piece.way / piece.distance, seen);
        }
        return static_cast<double>(raster.hidden());
    }
};

}  // namespace trapeze::testing
