#include "pipeline/study/aff/aff_splines.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

constexpr double kRadiansOfDegree = 3.14159265358979323846 / 180;

/// What the steps before, along and after a segment count for in its tangents.
struct TangentWeights {
    double out_before, out_along;  ///< of the tangent at which it leaves its first key
    double in_along, in_after;     ///< of the tangent at which it reaches its second key
};

/// Of the segment from k[1] to k[2]. A tangent is adjusted to how long the segment lasts beside its
/// neighbour. Where neither lasts, any will do: nobody sees the segment.
TangentWeights tangent_weights(const AffKey* k) {
    const auto adjusted = [&](double span) { return span > 0 ? (k[2].time - k[1].time) / span : 0.0; };
    const double out = adjusted(k[2].time - k[0].time) * (1 - k[1].tension);
    const double in = adjusted(k[3].time - k[1].time) * (1 - k[2].tension);
    return {out * (1 + k[1].continuity) * (1 + k[1].bias), out * (1 - k[1].continuity) * (1 - k[1].bias),
            in * (1 - k[2].continuity) * (1 + k[2].bias), in * (1 + k[2].continuity) * (1 - k[2].bias)};
}

std::vector<double> segment_times(const std::vector<AffKey>& keys) {
    std::vector<double> times;
    for (size_t i = 1; i + 1 < keys.size(); ++i) times.push_back(keys[i].time);
    return times;
}

/// A segment, and where in it: from 0 to 1.
struct PlaceInSpline {
    size_t segment;
    double u;
};

PlaceInSpline place_in_spline(const std::vector<double>& times, double time) {
    if (!(time > times.front())) return {0, 0};
    if (time >= times.back()) return {times.size() - 2, 1};
    const auto after = std::ranges::upper_bound(times, time);
    const auto segment = static_cast<size_t>(after - times.begin()) - 1;
    return {segment, (time - times[segment]) / (times[segment + 1] - times[segment])};
}

/// Half the axis and angle, in radians, that a unit quaternion turns by.
V3d quaternion_logarithm(const Imath::Quatd& q) {
    const double sine = q.v.length();
    return sine > 0 ? q.v * (std::atan2(sine, q.r) / sine) : V3d(0, 0, 0);
}

Imath::Quatd quaternion_exponential(const V3d& v) {
    const double angle = v.length();
    if (!(angle > 0)) return {};
    return {std::cos(angle), v * (std::sin(angle) / angle)};
}

}  // namespace

Imath::Quatd aff_rotation(const V3d& axis, double degrees) {
    const double length = axis.length(), half = .5 * degrees * kRadiansOfDegree;
    if (!(length > 0)) return {};
    return {std::cos(half), axis * (std::sin(half) / length)};
}

AffSpline::AffSpline(const std::vector<AffKey>& keys) : times_(segment_times(keys)) {
    for (size_t i = 0; i + 3 < keys.size(); ++i) {
        const AffKey* k = &keys[i];
        const TangentWeights w = tangent_weights(k);
        const V3d before = k[1].value - k[0].value, along = k[2].value - k[1].value,
                  after = k[3].value - k[2].value;
        const V3d out = w.out_before * before + w.out_along * along;
        const V3d in = w.in_along * along + w.in_after * after;
        segments_.push_back({k[1].value, out, 3.0 * along - 2.0 * out - in, out + in - 2.0 * along});
    }
}

V3d AffSpline::at(double time) const {
    const auto [segment, u] = place_in_spline(times_, time);
    const Segment& s = segments_[segment];
    return s.c0 + u * (s.c1 + u * (s.c2 + u * s.c3));
}

AffRotationSpline::AffRotationSpline(const std::vector<AffKey>& keys) : times_(segment_times(keys)) {
    // q and -q are the same rotation. Of the two each key takes that which is less far from the key before.
    std::vector<Imath::Quatd> q;
    for (const AffKey& key : keys) {
        q.push_back(aff_rotation(key.value, key.degrees));
        if (q.size() > 1 && q[q.size() - 2].euclideanInnerProduct(q.back()) < 0) q.back() = -q.back();
    }
    const auto step = [&](size_t from) { return quaternion_logarithm(~q[from] * q[from + 1]); };
    for (size_t i = 0; i + 3 < keys.size(); ++i) {
        const TangentWeights w = tangent_weights(&keys[i]);
        const V3d before = step(i), along = step(i + 1), after = step(i + 2);
        const V3d out = w.out_before * before + w.out_along * along;
        const V3d in = w.in_along * along + w.in_after * after;
        segments_.push_back({q[i + 1], q[i + 1] * quaternion_exponential(.5 * (out - along)),
                             q[i + 2] * quaternion_exponential(.5 * (along - in)), q[i + 2]});
    }
}

Imath::Quatd AffRotationSpline::at(double time) const {
    const auto [segment, u] = place_in_spline(times_, time);
    const Segment& s = segments_[segment];
    return Imath::squad(s.begin, s.after_begin, s.before_end, s.end, u).normalized();
}

}  // namespace trapeze
