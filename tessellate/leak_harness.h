/// For tests: random rays from inside closed surfaces. A surface that is closed in its bits is crossed an odd
/// number of times by every ray that leaves it, by hit_micropolygon's own rule: no tolerance.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "core/hit_micropolygon.h"
#include "core/random.h"
#include "core/rays.h"
#include "tessellate/dicing_harness.h"

namespace trapeze::testing {

struct LeakCount {
    int64_t rays = 0;
    int64_t leaks = 0;        ///< hit nothing
    int64_t wrong_sides = 0;  ///< hit an even number of times
    int64_t hits = 0;
    size_t open_sides = 0;  ///< see count_open_sides
};

/// Micropolygons at one time, binned by the direction in which they are seen from a point: for each of the
/// six main axes, kBins x kBins bins of the slopes.
class DirectionBins {
  public:
    DirectionBins(const std::vector<Grid>& grids, const V3f& origin, float time)
        : origin_(origin), time_(time) {
        bins_.resize(6 * kBins * kBins);
        for (const Grid& grid : grids)
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u) add(grid, u, v);
    }

    /// How often a ray leaves through a surface.
    int crossings(const V3f& direction) const {
        const TurnedRay turned = axis_ray({origin_, direction, time_});
        const int axis = turned.z_plane, side = turned.depth_sign < 0 ? 1 : 0;
        const float sx = turned.ray.ux * turned.depth_sign, sy = turned.ray.uy * turned.depth_sign;
        int count = 0;
        for (const int quad : bins_[index(axis, side, bin(sx), bin(sy))]) {
            const Quad q = turned_quad(quads_[quad], turned);
            float depth;
            if (hit_micropolygon(turned.ray, q, Facing::Both, &depth) &&
                (depth - turned.ray.oz) * turned.depth_sign > 0)
                ++count;
        }
        return count;
    }

  private:
    static constexpr int kBins = 96;

    struct Corners {
        V3f p[4];
    };

    static int bin(float slope) {
        return std::clamp(static_cast<int>((slope + 1) * 0.5f * kBins), 0, kBins - 1);
    }
    static size_t index(int axis, int side, int x, int y) {
        return static_cast<size_t>(((axis * 2 + side) * kBins + y) * kBins + x);
    }
    static Quad turned_quad(const Corners& corners, const TurnedRay& t) {
        Quad q;
        for (int i = 0; i < 4; ++i) {
            q.x[i] = corners.p[i][t.x_plane], q.y[i] = corners.p[i][t.y_plane];
            q.z[i] = corners.p[i][t.z_plane];
        }
        return q;
    }

    void add(const Grid& grid, int u, int v) {
        Corners c;
        for (int i = 0; i < 4; ++i) c.p[i] = grid.vertex(u + (i & 1), v + (i >> 1), time_);
        const int number = static_cast<int>(quads_.size());
        quads_.push_back(c);
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) add_to(number, axis, side);
    }

    void add_to(int number, int axis, int side) {
        const float sign = side ? -1.0f : 1.0f;
        float x0 = 1e30f, x1 = -1e30f, y0 = 1e30f, y1 = -1e30f;
        bool behind = false;
        int beyond[4] = {0, 0, 0, 0};  // corners beyond each plane of the pyramid of this axis' directions
        for (const V3f& p : quads_[number].p) {
            const V3f d = p - origin_;
            const float z = d[axis] * sign, x = d[(axis + 1) % 3], y = d[(axis + 2) % 3];
            const float reach = z + 1e-4f * std::abs(z);
            beyond[0] += x > reach, beyond[1] += -x > reach, beyond[2] += y > reach, beyond[3] += -y > reach;
            behind |= z <= 1e-4f;
            if (z <= 1e-4f) continue;
            x0 = std::min(x0, x / z), x1 = std::max(x1, x / z);
            y0 = std::min(y0, y / z), y1 = std::max(y1, y / z);
        }
        if (std::ranges::find(beyond, 4) != std::end(beyond)) return;
        if (behind) x0 = y0 = -1, x1 = y1 = 1;  // seen at slopes without bound: in all bins
        constexpr float kSlack = 1e-4f;
        if (x0 > 1 + kSlack || x1 < -1 - kSlack || y0 > 1 + kSlack || y1 < -1 - kSlack) return;
        for (int y = bin(y0 - kSlack); y <= bin(y1 + kSlack); ++y)
            for (int x = bin(x0 - kSlack); x <= bin(x1 + kSlack); ++x)
                bins_[index(axis, side, x, y)].push_back(number);
    }

    V3f origin_;
    float time_;
    std::vector<Corners> quads_;
    std::vector<std::vector<int>> bins_;
};

/// Sides of micropolygons, given by the bits of their ends at all keys, that occur an odd number of times:
/// the holes' rims. None in a closed surface, whatever rays find.
inline size_t count_open_sides(const std::vector<Grid>& grids) {
    using Point = std::vector<float>;
    std::map<std::pair<Point, Point>, bool> odd;
    const auto point = [](const Grid& grid, int i, int j) {
        Point p;
        for (int key = 0; key < grid.key_count; ++key) {
            const V3f at = grid.vertex_at_key(i, j, key, grid.key_count);
            p.insert(p.end(), {at.x + 0.0f, at.y + 0.0f, at.z + 0.0f});
        }
        return p;
    };
    const auto add = [&](Point a, Point b) {
        if (a == b) return;
        if (b < a) std::swap(a, b);
        bool& is_odd = odd[{std::move(a), std::move(b)}];
        is_odd = !is_odd;
    };
    // Inside a grid all sides come twice: its rim is enough.
    for (const Grid& grid : grids) {
        const int nu = grid.shape.nu, nv = grid.shape.nv;
        for (int i = 0; i < nu; ++i)
            for (const int j : {0, nv}) add(point(grid, i, j), point(grid, i + 1, j));
        for (int j = 0; j < nv; ++j)
            for (const int i : {0, nu}) add(point(grid, i, j), point(grid, i, j + 1));
    }
    return static_cast<size_t>(std::ranges::count_if(odd, [](const auto& side) { return side.second; }));
}

/// An even distribution over the sphere, by number.
inline V3f random_direction(uint32_t a, uint32_t b) {
    const float z = 2 * unit_float(hash(a, b, 1)) - 1;
    const float phi = 6.2831853f * unit_float(hash(a, b, 2));
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Rays from `inside(number, time)`, which is to give camera-space points inside the surface at a time.
inline LeakCount count_leaks(TestScene& test, const std::function<V3f(uint32_t, float)>& inside,
                             int64_t rays = 1'000'000, const DicedScene::Displace& displace = {}) {
    constexpr uint32_t kBatch = 10000;
    const DicedScene diced(test, displace);
    const uint32_t batches = static_cast<uint32_t>((rays + kBatch - 1) / kBatch);
    std::atomic<int64_t> leaks = 0, wrong = 0, hits = 0;
    tbb::parallel_for(0u, batches, [&](uint32_t batch) {
        // Both ends of the shutter and all between.
        const float time = static_cast<float>(batch) / static_cast<float>(batches - 1);
        const DirectionBins bins(diced.grids, inside(batch, time), time);
        for (uint32_t i = 0; i < kBatch; ++i) {
            const int crossings = bins.crossings(random_direction(batch, i));
            leaks += crossings == 0;
            wrong += crossings % 2 == 0;
            hits += crossings;
        }
    });
    return {int64_t{batches} * kBatch, leaks, wrong, hits, count_open_sides(diced.grids)};
}

}  // namespace trapeze::testing
