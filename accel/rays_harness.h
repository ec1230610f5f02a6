/// Grids and rays in all directions for tests of trees, and what the rays hit.
#pragma once

#include <cmath>

#include "accel/hit_policies.h"
#include "core/grids_harness.h"
#include "core/noise_harness.h"
#include "core/ray_query.h"
#include "core/stats.h"

namespace trapeze::testing {

/// Adds bent sheets of up to 16 x 16 micropolygons that cut through each other, each on an accelerated way of
/// its own, so that poses between keys differ from a straight line from open to close.
inline void add_sheets(GridMaker& maker, int count, int keys, Noise& noise) {
    for (int n = 0; n < count; ++n) {
        const V3f origin = noise.point(4), along_u = noise.point(2), along_v = noise.point(2),
                  shift = noise.point(1);
        const int nu = 1 + static_cast<int>(noise.engine() % 16),
                  nv = 1 + static_cast<int>(noise.engine() % 16);
        maker.add(nu, nv, keys, [=](int i, int j, float t) {
            const float u = static_cast<float>(i) / static_cast<float>(nu),
                        v = static_cast<float>(j) / static_cast<float>(nv);
            return origin + along_u * u + along_v * v + V3f(0, 0.2f * std::sin(8 * u + 5 * v), 0) +
                   shift * (t * t);
        });
    }
}

/// Adds a closed, bumpy, moving torus about the point `middle` whose shared vertices are the same bits on
/// both sides. with_hole: grid (0, 1) is of single micropolygons, and number (2, 2) of it is not there.
inline void add_torus(GridMaker& maker, int keys, const V3f& middle = V3f(0), bool with_hole = false) {
    constexpr int kAround = 6, kAcross = 4;  // grids
    const auto vertex = [&middle](int i, int j, float t) {
        constexpr float kTurn = 6.2831853f;
        const float phi = kTurn * static_cast<float>(i % (16 * kAround)) / (16 * kAround);
        const float theta = kTurn * static_cast<float>(j % (16 * kAcross)) / (16 * kAcross);
        const float r = 1 + 0.1f * std::sin(5 * phi) + 0.2f * t * std::cos(phi);
        const float ring = 3 + r * std::cos(theta);
        return middle + V3f(ring * std::cos(phi) + t, ring * std::sin(phi), r * std::sin(theta) - 0.5f * t);
    };
    for (int gu = 0; gu < kAround; ++gu)
        for (int gv = 0; gv < kAcross; ++gv) {
            const auto at = [&](int i, int j, float t) { return vertex(16 * gu + i, 16 * gv + j, t); };
            if (!with_hole || gu != 0 || gv != 1) {
                maker.add(16, 16, keys, at);
                continue;
            }
            for (int v = 0; v < 16; ++v)
                for (int u = 0; u < 16; ++u) {
                    if (u == 2 && v == 2) continue;
                    maker.add(1, 1, keys, [&](int i, int j, float t) { return at(u + i, v + j, t); });
                }
        }
}

/// Calls see(hit) for every micropolygon that a ray of any direction hits, without any bound.
template <class See>
void for_each_hit_naively(const Grids& grids, const SpaceRay& ray, DepthRange range, const See& see) {
    const TurnedRay turned = axis_ray(ray);
    for (size_t g = 0; g < grids.grids.size(); ++g) {
        const Grid& grid = grids.grids[g];
        for (int v = 0; v < grid.shape.nv; ++v)
            for (int u = 0; u < grid.shape.nu; ++u) {
                const Quad quad = grid.quad(u, v, ray.time, turned.x_plane, turned.y_plane, turned.z_plane);
                float z;
                if (!hit_micropolygon(turned.ray, quad, Facing::Both, &z)) continue;
                const MicropolygonId id{static_cast<uint32_t>(g), static_cast<uint8_t>(u),
                                        static_cast<uint8_t>(v)};
                const Hit hit{(z - turned.ray.oz) * turned.depth_sign, id.packed()};
                if (hit.depth >= range.min && hit.depth <= range.max) see(hit);
            }
    }
}

/// The truth: the nearest of these.
inline Hit closest_naively(const Grids& grids, const SpaceRay& ray, DepthRange range) {
    Hit best = kNoHit;
    for_each_hit_naively(grids, ray, range, [&](const Hit& hit) {
        if (in_front(hit, best)) best = hit;
    });
    return best;
}

/// That a ray along z hits nothing, as in a tree of no grids.
template <class Tree>
void expect_no_hit_in(const Tree& tree) {
    TraceRay ray = TraceRay::turned(axis_ray({V3f(0), V3f(0, 0, 1), 0}), {});
    ClosestHit policy;
    SampleStats stats;
    tree.trace(ray, policy, stats);
    EXPECT_FALSE(policy.found());
}

}  // namespace trapeze::testing
