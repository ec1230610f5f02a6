/// The seven quadrics (RISpec 5.4): a profile curve over v, turned about the z axis by theta = u * thetamax.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"
#include "tessellate/surfaces/between.h"
#include "tessellate/surfaces/surface_variables.h"
#include "tessellate/topology/face_grid.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
using Kind = Quadric::Kind;

/// RIB gives thetamax and the torus' angles in degrees.
float radians(float degrees) {
    return degrees * (kPi / 180);
}

/// An interval of numbers and its arithmetic, which holds all results but for rounding.
struct Range {
    float lo = 0, hi = 0;

    static Range of(float a, float b) { return {std::min(a, b), std::max(a, b)}; }
    Range operator*(float s) const { return of(lo * s, hi * s); }
    Range operator+(Range o) const { return {lo + o.lo, hi + o.hi}; }
    Range operator-(Range o) const { return {lo - o.hi, hi - o.lo}; }
    Range operator*(Range o) const {
        const float p[4] = {lo * o.lo, lo * o.hi, hi * o.lo, hi * o.hi};
        return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
    }
};

/// The range of the cosine over an interval of angles in radians, a little wide for rounding.
Range cosine(Range angle) {
    constexpr float kSlack = 2e-6f;
    Range c = Range::of(portable::cos(angle.lo), portable::cos(angle.hi));
    /// Whether a multiple of the turn, shifted by `phase`, lies in the interval: an extremum of the cosine.
    const auto passes = [&](float phase) {
        return std::floor((angle.hi - phase) / (2 * kPi)) != std::floor((angle.lo - phase) / (2 * kPi));
    };
    // An extremum lies within the interval.
    if (passes(0)) c.hi = 1;
    if (passes(kPi)) c.lo = -1;
    return {c.lo - kSlack, c.hi + kSlack};
}

/// The cosine a quarter turn later.
Range sine(Range angle) {
    return cosine({angle.lo - kPi / 2, angle.hi - kPi / 2});
}

/// The quadric's curve at theta = 0, with its derivative by v.
struct ProfilePoint {
    float x = 0, y = 0, z = 0;
    float dx = 0, dy = 0, dz = 0;
};

/// A box about a part of the profile.
struct ProfileRange {
    Range x, y, z;
};

/// A quadric's arguments made ready for evaluation. Lengths are in object space, angles in radians.
struct Profile {
    Kind kind = Kind::Sphere;
    float a = 0, b = 0;            ///< radius; or height and radius, rmax and zmax, both radii of the torus
    float from = 0, to = 0;        ///< what runs linearly with v: an angle or a z
    V3f p1{0, 0, 0}, p2{0, 0, 0};  ///< of the hyperboloid
    bool bottom_is_point = false, top_is_point = false;
    bool v_closes = false;
    float theta_max = 0;  ///< radians

    /// The profile at v, 0..1; poles lie exactly on the axis.
    ProfilePoint at(float v) const;
    /// Bounds of the profile over a range of v.
    ProfileRange over(Range v) const;
};

/// Also several turns, and backwards; exact multiples come from files but for rounding.
bool whole_turn(float degrees) {
    return degrees != 0 && std::abs(std::remainder(degrees, 360.0f)) < 1e-4f;
}

/// Latitudes run from that of zmin to that of zmax, which is how v runs over a sphere (RISpec 5.4).
Profile sphere_profile(const std::array<float, 7>& q) {
    Profile p;
    p.a = q[0];
    // zmin and zmax are cut to the radius.
    const auto latitude = [&](float z) { return portable::asin(std::clamp(z / q[0], -1.0f, 1.0f)); };
    p.from = latitude(q[1]), p.to = latitude(q[2]);
    // zmin and zmax at or beyond the radius: the sphere is closed there.
    p.bottom_is_point = std::abs(q[1]) >= std::abs(q[0]);
    p.top_is_point = std::abs(q[2]) >= std::abs(q[0]);
    return p;
}

/// `values` are the request's arguments in its order, without thetamax.
Profile profile_of(const Quadric& quadric) {
    const std::array<float, 7>& q = quadric.values;
    Profile p;
    switch (quadric.kind) {
        case Kind::Sphere:
            p = sphere_profile(q);
            break;
        case Kind::Cone:
        case Kind::Disk:
            p.a = q[0], p.b = q[1], p.top_is_point = true;
            break;
        case Kind::Cylinder:
            p.a = q[0], p.from = q[1], p.to = q[2];
            break;
        case Kind::Hyperboloid:
            p.p1 = {q[0], q[1], q[2]}, p.p2 = {q[3], q[4], q[5]};
            p.bottom_is_point = q[0] == 0 && q[1] == 0;
            p.top_is_point = q[3] == 0 && q[4] == 0;
            break;
        case Kind::Paraboloid:
            p.a = q[0], p.b = q[2], p.from = q[1], p.to = q[2];
            p.bottom_is_point = q[1] == 0;
            break;
        case Kind::Torus:
            p.a = q[0], p.b = q[1], p.from = radians(q[2]), p.to = radians(q[3]);
            p.v_closes = whole_turn(q[3] - q[2]);
            break;
    }
    p.kind = quadric.kind;
    p.theta_max = radians(quadric.theta_max());
    return p;
}

/// Poles get an x of exactly 0, so that all points of one have the same bits.
ProfilePoint Profile::at(float v) const {
    const float span = to - from, along = from + v * span;
    const bool at_point = (bottom_is_point && v == 0) || (top_is_point && v == 1);
    switch (kind) {
        case Kind::Sphere: {
            auto [s, c] = portable::sine_and_cosine(along);
            if (at_point) c = 0;
            return {a * c, 0, a * s, -a * s * span, 0, a * c * span};
        }
        case Kind::Cone:
            return {b * (1 - v), 0, a * v, -b, 0, a};
        case Kind::Cylinder:
            return {a, 0, along, 0, 0, span};
        case Kind::Hyperboloid: {
            const V3f d = p2 - p1;
            const V3f p = v == 1 ? p2 : p1 + d * v;
            return {p.x, p.y, p.z, d.x, d.y, d.z};
        }
        case Kind::Paraboloid: {
            // x = a * sqrt(z / zmax): its derivative grows without bounds towards the apex, so that is taken
            // at a place a little higher.
            const float share = std::max(along / b, 0.0f);
            const float slope = 0.5f / (std::sqrt(std::max(share, 1e-6f)) * b);
            return {a * std::sqrt(share), 0, along, a * slope * span, 0, span};
        }
        case Kind::Disk:
            return {b * (1 - v), 0, a, -b, 0, 0};
        case Kind::Torus: {
            const auto [s, c] = portable::sine_and_cosine(along);
            return {a + b * c, 0, b * s, -b * s * span, 0, b * c * span};
        }
    }
    return {};
}

/// Bounds of the profile over a range of v: circles by ranges of sine and cosine, all others by their ends.
/// No tighter than its parts: ranges of x and z are taken each for itself.
ProfileRange Profile::over(Range v) const {
    if (kind == Kind::Sphere || kind == Kind::Torus) {
        const Range angle = Range::of(from + v.lo * (to - from), from + v.hi * (to - from));
        const Range c = cosine(angle), s = sine(angle);
        if (kind == Kind::Sphere) return {c * a, {0, 0}, s * a};
        return {Range{a, a} + c * b, {0, 0}, s * b};
    }
    const ProfilePoint lo = at(v.lo), hi = at(v.hi);  // the others are monotone
    return {Range::of(lo.x, hi.x), Range::of(lo.y, hi.y), Range::of(lo.z, hi.z)};
}

/// A quadric as a grid of faces, each about a quarter turn wide. At shape keys of other arguments it has the
/// same faces.
class QuadricSurface : public TopologySurface<QuadricSurface> {
  public:
    explicit QuadricSurface(const Primitive& primitive);

    const FaceGrid& topology() const { return faces_; }
    V2f faces_per_unit(int) const override {
        return {static_cast<float>(faces_.columns), static_cast<float>(faces_.rows)};
    }

    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override;

  private:
    const Primitive& primitive_;
    std::vector<Profile> profiles_;  ///< by shape key
    FaceGrid faces_;
};

/// A variable's four corner values (u fastest), bilinear over the whole quadric.
class CornerValues : public VariableSource {
  public:
    explicit CornerValues(const ShadingGrid& grid) : grid_(grid) {}

    void component(const Parameter& parameter, int component, std::span<float> values) const override {
        const size_t stride = parameter.declaration.floats_per_item();
        const float* const c = parameter.floats.data() + component;
        const float c00 = c[0], c10 = c[stride], c01 = c[2 * stride], c11 = c[3 * stride];
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = between_corners(c00, c10, c01, c11, grid_.u[i], grid_.v[i]);
    }
    size_t uniform_index(const Parameter&) const override { return 0; }

  private:
    const ShadingGrid& grid_;
};

/// The number of faces goes by the largest sweep of all keys, as each key has the same faces.
QuadricSurface::QuadricSurface(const Primitive& primitive) : primitive_(primitive) {
    // The topology is that of all shape keys: what closes at all of them is closed.
    faces_.u_wraps = faces_.v_wraps = faces_.bottom_is_point = faces_.top_is_point = true;
    float theta = 0;
    for (const auto& shape : primitive.shape_keys) {
        const Quadric& quadric = std::get<Quadric>(shape->topology);
        const Profile& p = profiles_.emplace_back(profile_of(quadric));
        faces_.u_wraps &= whole_turn(quadric.theta_max());
        faces_.v_wraps &= p.v_closes;
        faces_.bottom_is_point &= p.bottom_is_point;
        faces_.top_is_point &= p.top_is_point;
        theta = std::max(theta, std::abs(p.theta_max));
    }
    // Faces of a quarter turn: no closed edges, and work for several threads.
    const auto quarters = [](float angle) {
        return std::clamp(static_cast<int>(std::ceil(std::abs(angle) / (kPi / 2) - 1e-3f)), 1, 16);
    };
    const Profile& p = profiles_.front();
    faces_.columns = quarters(theta);
    if (p.kind == Kind::Sphere || p.kind == Kind::Torus) faces_.rows = quarters(p.to - p.from);
}

void QuadricSurface::evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch*,
                              std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const Profile& profile = profiles_[shape_key];
    const float du = profile.theta_max / static_cast<float>(faces_.columns);
    const float dv = 1 / static_cast<float>(faces_.rows);
    for (size_t i = 0; i < uv.size(); ++i) {
        const V2f at = faces_.surface_uv(face, uv[i]);
        // The profile turned about z. Derivatives are by the parameters of the face, of which the surface has
        // several along u and v: by the chain rule, RISpec's times du and dv.
        const float theta = at.x * profile.theta_max;
        const auto [s, c] = portable::sine_and_cosine(theta);
        const ProfilePoint p = profile.at(at.y);
        P[i] = {p.x * c - p.y * s, p.x * s + p.y * c, p.z};
        if (!dPdu.empty()) dPdu[i] = V3f(-P[i].y, P[i].x, 0) * du;
        if (!dPdv.empty()) dPdv[i] = V3f(p.dx * c - p.dy * s, p.dx * s + p.dy * c, p.dz) * dv;
    }
}

/// Variables have a value at each of the four corners of u and v, and are mixed in between (RISpec 5.4).
bool QuadricSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch*,
                                        ShadingGrid& grid) const {
    for (size_t i = 0; i < uv.size(); ++i) {
        const V2f at = faces_.surface_uv(face, uv[i]);
        grid.u[i] = at.x, grid.v[i] = at.y;
    }
    set_texture_coordinates(*primitive_.attributes, grid);
    return set_variables(primitive_.shape().variables, CornerValues(grid), grid);
}

/// Interval arithmetic over the rectangle: not tight, but never too small except for rounding, which callers
/// add.
Box3f QuadricSurface::bound(int face, V2f lo, V2f hi, int shape_key) const {
    const Profile& profile = profiles_[shape_key];
    const V2f a = faces_.surface_uv(face, lo), b = faces_.surface_uv(face, hi);
    const ProfileRange r = profile.over({a.y, b.y});
    const Range theta = Range::of(a.x * profile.theta_max, b.x * profile.theta_max);
    const Range c = cosine(theta), s = sine(theta);
    // The rotation of at() in intervals.
    const Range x = r.x * c - r.y * s, y = r.x * s + r.y * c;
    return {V3f(x.lo, y.lo, r.z.lo), V3f(x.hi, y.hi, r.z.hi)};
}

}  // namespace

std::unique_ptr<Surface> make_quadric_surface(const Primitive& primitive, Diagnostics&) {
    return std::make_unique<QuadricSurface>(primitive);
}

}  // namespace trapeze
