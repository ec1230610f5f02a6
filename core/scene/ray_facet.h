/// The micropolygon that a ray has met, for who begins rays on it.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/math.h"
#include "core/motion_keys.h"

namespace trapeze {

/// One of a micropolygon's two triangles. Camera space; its normal is of unit length, outside, or 0 where
/// there is none.
struct FacetTriangle {
    std::array<V3f, 3> corners;
    V3f normal;

    FacetTriangle(const std::array<V3f, 3>& at, bool reversed) : corners(at) {
        normal = (at[1] - at[0]).cross(at[2] - at[0]).normalized() * (reversed ? -1.0f : 1.0f);
    }

    /// Of a point near it on its corners; the least is below 0 where it lies beside it. Nothing where it has
    /// no area.
    std::optional<std::array<float, 3>> weights_at(const V3f& P) const {
        const V3f u = corners[1] - corners[0], v = corners[2] - corners[0], across = u.cross(v);
        const float area = across.length2();
        if (!(area > 0)) return {};
        const V3f way = P - corners[0];
        const float a = way.cross(v).dot(across) / area, b = u.cross(way).dot(across) / area;
        return std::array<float, 3>{1 - a - b, a, b};
    }

    /// Whether the way from a point along a direction crosses it, ahead of the point.
    bool is_ahead(const V3f& from, const V3f& direction) const {
        const V3f u = corners[1] - corners[0], v = corners[2] - corners[0], across = direction.cross(v);
        const float area = u.dot(across);
        if (area == 0) return false;
        const V3f way = from - corners[0], turned = way.cross(u);
        const float a = way.dot(across) / area, b = direction.dot(turned) / area, t = v.dot(turned) / area;
        return a >= 0 && b >= 0 && a + b <= 1 && t > 0;
    }
};

/// A micropolygon at a time.
struct FacetPose {
    FacetTriangle hit;    ///< the one of its triangles that was hit
    FacetTriangle other;  ///< the rest of it
    V3f inner;            ///< where it was hit, but off the triangle's edges
};

/// A micropolygon that was hit, at all times of the shutter.
struct RayFacet {
    using Corners = std::array<V3f, 4>;  ///< 00, 10, 01, 11; camera space

    std::vector<Corners> keys;       ///< at evenly spaced times
    std::array<float, 4> weights{};  ///< of the inner point on the corners; of either 10 or 01 it is 0
    bool reversed = false;           ///< outside is where 00, 11, 10 turn counter-clockwise, not 00, 10, 11

    FacetPose at(float time) const {
        const Corners c = corners_at(time);
        const FacetTriangle lower({c[0], c[1], c[3]}, reversed), upper({c[0], c[3], c[2]}, reversed);
        const bool hits_lower = weights[2] == 0;
        FacetPose pose{hits_lower ? lower : upper, hits_lower ? upper : lower, V3f(0, 0, 0)};
        for (size_t i = 0; i < 4; ++i) pose.inner += weights[i] * c[i];
        return pose;
    }

    /// Sets the weights by a point near the micropolygon, as it is at a time: on the triangle that holds it,
    /// or that it is nearest to.
    void set_inner(const V3f& P, float time) {
        constexpr float kFromEdges = 1.0f / 32;
        const Corners c = corners_at(time);
        const std::array<size_t, 3> lower{0, 1, 3}, upper{0, 3, 2};
        const auto of = [&](const std::array<size_t, 3>& at) {
            return FacetTriangle({c[at[0]], c[at[1]], c[at[2]]}, reversed).weights_at(P);
        };
        const auto in_lower = of(lower), in_upper = of(upper);
        const auto least = [](const std::optional<std::array<float, 3>>& w) {
            return w ? std::min({(*w)[0], (*w)[1], (*w)[2]}) : -std::numeric_limits<float>::infinity();
        };
        const bool is_lower = least(in_lower) >= least(in_upper);
        const std::array<size_t, 3>& at = is_lower ? lower : upper;
        const std::array<float, 3> on =
            (is_lower ? in_lower : in_upper).value_or(std::array<float, 3>{1, 1, 1});
        weights.fill(0);
        float sum = 0;
        for (size_t i = 0; i < 3; ++i) sum += weights[at[i]] = std::max(on[i], kFromEdges);
        for (float& weight : weights) weight /= sum;
    }

  private:
    Corners corners_at(float time) const {
        if (keys.size() == 1) return keys.front();
        const MotionSegment segment = segment_at(time, static_cast<int>(keys.size()));
        const Corners &from = keys[static_cast<size_t>(segment.index)],
                      &to = keys[static_cast<size_t>(segment.index) + 1];
        Corners corners;
        for (size_t i = 0; i < 4; ++i) corners[i] = from[i] + (to[i] - from[i]) * segment.local;
        return corners;
    }
};

}  // namespace trapeze
