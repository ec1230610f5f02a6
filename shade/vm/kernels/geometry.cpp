/// Operations on points, vectors and normals.
#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/geometry.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

void dot_product(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) out.put(dot(a.get3(i), b.get3(i)), i);
}

/// The handedness of the result is that of the coordinate system: nothing is flipped here.
void cross_product(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) out.put3(cross(a.get3(i), b.get3(i)), i);
}

/// Squares may overflow for vectors longer than about 1e19; no scene has such.
void length(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = in.get3(i);
        out.put(hn::Sqrt(dot(v, v)), i);
    }
}

// Differences first: points far from the origin and near each other keep their digits.
void distance(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = subtract(a.get3(i), b.get3(i));
        out.put(hn::Sqrt(dot(v, v)), i);
    }
}

/// Divides by the length; a vector without one stays zero (inverse_length).
void normalize(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = in.get3(i);
        out.put3(scale(v, inverse_length(v)), i);
    }
}

/// RISpec's sign(-I.Nref) * N, but N where I.Nref is 0: a silhouette must not lose its normal.
void face_forward(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input N(o[1]), I(o[2]), reference(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const M behind = hn::Gt(dot(I.get3(i), reference.get3(i)), hn::Zero(D()));
        // The sign bit alone: Xor with it negates, Xor with 0 leaves N.
        const V turn = hn::IfThenElseZero(behind, set(-0.0f));
        const V3 n = N.get3(i);
        out.put3({hn::Xor(n.x, turn), hn::Xor(n.y, turn), hn::Xor(n.z, turn)}, i);
    }
}

/// I - 2 (I.N) N, for N of unit length.
HWY_INLINE V3 reflection(const V3& I, const V3& N) {
    const V twice = hn::Mul(dot(I, N), set(2));
    return subtract(I, scale(N, twice));
}

/// 1 - eta^2 (1 - (I.N)^2): negative where nothing is transmitted.
HWY_INLINE V squared_cosine_inside(V toward, V eta) {
    return hn::Sub(set(1), hn::Mul(hn::Mul(eta, eta), hn::Sub(set(1), hn::Mul(toward, toward))));
}

/// Snell's law in vectors, for I and N of unit length and I.N < 0: eta I - (eta I.N + sqrt(1 - eta^2 (1 -
/// (I.N)^2))) N.
HWY_INLINE V3 refraction(const V3& I, const V3& N, V eta) {
    const V toward = dot(I, N), squared = squared_cosine_inside(toward, eta);
    const V along = hn::Add(hn::Mul(eta, toward), hn::Sqrt(positive(squared)));
    const V3 t = subtract(scale(I, eta), scale(N, along));
    const M none = hn::Lt(squared, hn::Zero(D()));
    return {hn::IfThenZeroElse(none, t.x), hn::IfThenZeroElse(none, t.y), hn::IfThenZeroElse(none, t.z)};
}

/// What a dielectric reflects of unpolarised light, from RISpec's eta, the ratio of the refractive indices on
/// the incident side and the other: the mean of ((eta c - g) / (eta c + g))^2 and ((c - eta g) / (c + eta
/// g))^2, where c = |I.N| and g is the cosine of the transmitted direction; 1 for total reflection. The rest
/// is transmitted.
HWY_INLINE V reflectance(V toward, V eta) {
    const V squared = squared_cosine_inside(toward, eta), g = hn::Sqrt(positive(squared));
    const V c = hn::Abs(toward), ec = hn::Mul(eta, c), eg = hn::Mul(eta, g);
    const V across = hn::Div(hn::Sub(ec, g), hn::Add(ec, g));
    const V within = hn::Div(hn::Sub(c, eg), hn::Add(c, eg));
    const V mean = hn::Mul(hn::Add(hn::Mul(across, across), hn::Mul(within, within)), set(0.5f));
    return at_most(hn::IfThenElse(hn::Gt(squared, hn::Zero(D())), mean, set(1)), set(1));
}

/// I points to the surface and is not turned: the result points away from it.
void reflect(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input I(o[1]), N(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) out.put3(reflection(I.get3(i), N.get3(i)), i);
}

/// Zero for total internal reflection, where squared_cosine_inside() is negative.
void refract(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input I(o[1]), N(o[2]), eta(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count())
        out.put3(refraction(I.get3(i), N.get3(i), eta.get(i)), i);
}

template <bool directions>
/// Kr and Kt alone, or with the directions R and T behind them: what is reflected and what is transmitted.
void fresnel(size_t lanes, Operands o) {
    const Output Kr(o[0]), Kt(o[1]), R(o[directions ? 2 : 0]), T(o[directions ? 3 : 0]);
    const size_t first = directions ? 4 : 2;
    const Input incident(o[first]), normal(o[first + 1]), ratio(o[first + 2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 I = incident.get3(i), N = normal.get3(i);
        const V eta = ratio.get(i), reflected = reflectance(dot(I, N), eta);
        Kr.put(reflected, i);
        Kt.put(hn::Sub(set(1), reflected), i);
        if constexpr (directions) R.put3(reflection(I, N), i), T.put3(refraction(I, N, eta), i);
    }
}

/// Rodrigues' formula; nothing turns about a line without direction.
void rotate(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input point(o[1]), angle(o[2]), from(o[3]), to(o[4]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 p = point.get3(i), a = from.get3(i), line = subtract(to.get3(i), a);
        const V inverse = inverse_length(line);
        const V3 axis = scale(line, inverse), q = subtract(p, a);
        const SineCosine turn = sin_cos(angle.get(i));
        const V along = hn::Mul(dot(axis, q), hn::Sub(set(1), turn.cosine));
        const V3 turned =
            add(add(scale(q, turn.cosine), scale(cross(axis, q), turn.sine)), scale(axis, along));
        const V3 result = add(turned, a);
        const M still = hn::Eq(inverse, hn::Zero(D()));
        out.put3({hn::IfThenElse(still, p.x, result.x), hn::IfThenElse(still, p.y, result.y),
                  hn::IfThenElse(still, p.z, result.z)},
                 i);
    }
}

/// To the segment, not the line through it: the nearest point is kept between its ends (RISpec 3.2, ptlined).
void line_distance(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input from(o[1]), to(o[2]), point(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 a = from.get3(i), line = subtract(to.get3(i), a), q = subtract(point.get3(i), a);
        // A segment of no length gives 0 / 0 here, a NaN, of which positive() makes 0: its one point.
        const V t = at_most(positive(hn::Div(dot(q, line), dot(line, line))), set(1));
        const V3 apart = subtract(q, scale(line, t));
        out.put(hn::Sqrt(dot(apart, apart)), i);
    }
}

Kernel find_fresnel(std::span<const int> widths) {
    if (are(widths, {1, 1, 3, 3, 1})) return fresnel<false>;
    return are(widths, {1, 1, 3, 3, 3, 3, 1}) ? fresnel<true> : nullptr;
}

constexpr KernelRow kRows[] = {
    {Op::Dot, counted<dot_product, 3>},
    {Op::Cross, counted<cross_product, 3>},
    {Op::Length, counted<length, 2>},
    {Op::Distance, counted<distance, 3>},
    {Op::Normalize, counted<normalize, 2>},
    {Op::FaceForward, counted<face_forward, 4>},
    {Op::Reflect, counted<reflect, 3>},
    {Op::Refract, counted<refract, 4>},
    {Op::Fresnel, find_fresnel},
    {Op::Rotate, counted<rotate, 5>},
    {Op::LineDistance, counted<line_distance, 4>},
};

Kernel find_geometry(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
TRAPEZE_KERNEL_FAMILY(find_geometry)
#endif
