#include "shade/vm/kernels/spline.h"

#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/spline.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

#ifndef TRAPEZE_SHADE_VM_SPLINE_ONCE_
#define TRAPEZE_SHADE_VM_SPLINE_ONCE_
namespace trapeze::vm {

/// A cubic basis of RiBasis: how many knots a segment is from the next, and the matrix that takes the powers
/// of the place in a segment, cubes first, to the weights of its four knots.
struct SplineRule {
    int step;
    float matrix[4][4];
};

inline constexpr float k16 = 1.0f / 6, k23 = 2.0f / 3;
inline constexpr SplineRule kSplineRules[] = {
    // In the order of SplineBasis: Catmull-Rom, Bezier, B-spline, Hermite, linear, constant. The last two use
    // the
    // second and third knot of each four, so that all bases have the same number of knots to spare at the
    // ends.
    {1, {{-0.5f, 1.5f, -1.5f, 0.5f}, {1, -2.5f, 2, -0.5f}, {-0.5f, 0, 0.5f, 0}, {0, 1, 0, 0}}},
    {3, {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}},
    {1, {{-k16, 0.5f, -0.5f, k16}, {0.5f, -1, 0.5f, 0}, {-0.5f, 0, 0.5f, 0}, {k16, k23, k16, 0}}},
    {2, {{2, 1, -2, 1}, {-3, -2, 3, -1}, {0, 1, 0, 0}, {1, 0, 0, 0}}},
    {1, {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, -1, 1, 0}, {0, 1, 0, 0}}},
    {1, {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 0}}},
};

}  // namespace trapeze::vm
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

/// Arrays whose segments are more are gathered from; else, all segments are tried in turn.
constexpr int kFewSegments = 12;

/// The knots as they stand among the operands.
struct Knots {
    explicit Knots(Operands o)
        : operands(o.subspan(2)), array(operands.size() == 1 && operands[0].length > 0) {}
    int count() const { return array ? operands[0].length : static_cast<int>(operands.size()); }
    /// Component k of a knot, at lane i.
    HWY_INLINE V get(size_t i, int knot, int k) const {
        const Operand& o = operands[array ? 0 : static_cast<size_t>(knot)];
        return hn::Load(D(), o.data + (array ? static_cast<size_t>(knot) * o.element_stride : 0) +
                                 static_cast<size_t>(k) * o.stride + (i & o.lane_mask));
    }

    Operands operands;
    bool array;
};

/// Four knots of each lane's segment. A lane ends up with the knots of the last segment that its place has
/// reached. No gather: uniform knots are loaded as they lie, and comparing a few is cheaper.
HWY_INLINE void pick_in_turn(const Knots& knots, int step, int segments, V segment, size_t i, int k,
                             V (&out)[4]) {
    for (int j = 0; j < 4; ++j) out[j] = knots.get(i, j, k);
    for (int s = 1; s < segments; ++s) {
        const M reached = hn::Ge(segment, set(static_cast<float>(s)));
        for (int j = 0; j < 4; ++j) out[j] = hn::IfThenElse(reached, knots.get(i, s * step + j, k), out[j]);
    }
}

/// Loads knots from an array: each lane the four of its own segment.
HWY_INLINE void gather(const Operand& array, int step, V segment, size_t i, int k, V (&out)[4]) {
    const DI di;
    const size_t distance = array.element_stride;
    const VI first = hn::Mul(hn::ConvertTo(di, segment), hn::Set(di, static_cast<int32_t>(distance) * step));
    const float* data = array.data + static_cast<size_t>(k) * array.stride + (i & array.lane_mask);
    for (size_t j = 0; j < 4; ++j)
        out[j] = hn::GatherIndex(D(), data + j * distance, hn::Add(first, hn::Iota(di, 0)));
}

/// The curve at a value from 0 to 1 of each of the lanes from i on.
HWY_INLINE void curve_at(const SplineRule& rule, int width, const Knots& knots, size_t i, V value,
                         V (&results)[3]) {
    const int segments = (knots.count() - 4) / rule.step + 1;
    // Segments are equally long in the value; at 1 the last one ends.
    const V t = hn::Mul(value, set(static_cast<float>(segments)));
    const V segment = at_most(hn::Floor(t), set(static_cast<float>(segments - 1)));
    const V f = hn::Sub(t, segment);
    V weights[4];
    for (int j = 0; j < 4; ++j)
        weights[j] = step(step(step(set(rule.matrix[0][j]), f, rule.matrix[1][j]), f, rule.matrix[2][j]), f,
                          rule.matrix[3][j]);
    for (int k = 0; k < width; ++k) {
        V near[4];
        if (knots.array && segments > kFewSegments)
            gather(knots.operands[0], rule.step, segment, i, k, near);
        else
            pick_in_turn(knots, rule.step, segments, segment, i, k, near);
        results[k] = hn::Mul(weights[0], near[0]);
        for (int j = 1; j < 4; ++j) results[k] = hn::Add(results[k], hn::Mul(weights[j], near[j]));
    }
}

/// One function for all bases and widths: what differs is a table, which costs less than twelve copies of the
/// loop. Fewer than four knots have no segment, and give 0.
HWY_NOINLINE void run_spline(const SplineRule& rule, int width, size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input value(o[1]);
    const Knots knots(o);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        V results[3] = {hn::Zero(D()), hn::Zero(D()), hn::Zero(D())};
        if (knots.count() >= 4)
            curve_at(rule, width, knots, i, at_most(positive(value.get(i)), set(1)), results);
        for (int k = 0; k < width; ++k) out.put(results[k], i, k);
    }
}

/// Where in 0..1 the curve, which rises or falls throughout, has a value; the nearer end for what it has
/// nowhere.
HWY_NOINLINE void solve_spline(const SplineRule& rule, size_t lanes, Operands o) {
    constexpr int kHalvings = 25;  // down to what floats below 1 tell apart
    const Output out(o[0]);
    const Input value(o[1]);
    const Knots knots(o);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        if (knots.count() < 4) {
            out.put(hn::Zero(D()), i, 0);
            continue;
        }
        const V wanted = value.get(i);
        V first[3], last[3], there[3];
        curve_at(rule, 1, knots, i, hn::Zero(D()), first);
        curve_at(rule, 1, knots, i, set(1), last);
        const M falls = hn::Lt(last[0], first[0]);
        V low = hn::Zero(D()), high = set(1);
        for (int n = 0; n < kHalvings; ++n) {
            const V middle = hn::Mul(hn::Add(low, high), set(0.5f));
            curve_at(rule, 1, knots, i, middle, there);
            const M beyond = hn::Xor(hn::Lt(there[0], wanted), falls);
            low = hn::IfThenElse(beyond, middle, low), high = hn::IfThenElse(beyond, high, middle);
        }
        // Ends are met as they are.
        const M at_last =
            hn::Or(hn::And(falls, hn::Le(wanted, last[0])), hn::AndNot(falls, hn::Ge(wanted, last[0])));
        const M at_first =
            hn::Or(hn::And(falls, hn::Ge(wanted, first[0])), hn::AndNot(falls, hn::Le(wanted, first[0])));
        const V found = hn::Mul(hn::Add(low, high), set(0.5f));
        out.put(hn::IfThenElse(at_first, hn::Zero(D()), hn::IfThenElse(at_last, set(1), found)), i, 0);
    }
}

/// A kernel has no arguments but its operands: basis and width become part of its type.
template <SplineBasis basis, int width>
void spline(size_t lanes, Operands o) {
    run_spline(kSplineRules[static_cast<size_t>(basis)], width, lanes, o);
}

/// All pairs of basis and width share run_spline(); these are thin calls of it.
template <int width>
Kernel find_of_width(SplineBasis basis) {
    switch (basis) {
        case SplineBasis::CatmullRom:
            return spline<SplineBasis::CatmullRom, width>;
        case SplineBasis::Bezier:
            return spline<SplineBasis::Bezier, width>;
        case SplineBasis::BSpline:
            return spline<SplineBasis::BSpline, width>;
        case SplineBasis::Hermite:
            return spline<SplineBasis::Hermite, width>;
        case SplineBasis::Linear:
            return spline<SplineBasis::Linear, width>;
        case SplineBasis::Constant:
            return spline<SplineBasis::Constant, width>;
    }
    return nullptr;
}

template <SplineBasis basis>
void solve(size_t lanes, Operands o) {
    solve_spline(kSplineRules[static_cast<size_t>(basis)], lanes, o);
}

Kernel find_inverse(SplineBasis basis) {
    switch (basis) {
        case SplineBasis::CatmullRom:
            return solve<SplineBasis::CatmullRom>;
        case SplineBasis::Bezier:
            return solve<SplineBasis::Bezier>;
        case SplineBasis::BSpline:
            return solve<SplineBasis::BSpline>;
        case SplineBasis::Hermite:
            return solve<SplineBasis::Hermite>;
        case SplineBasis::Linear:
            return solve<SplineBasis::Linear>;
        case SplineBasis::Constant:
            break;  // it is level, and has no inverse
    }
    return nullptr;
}

Kernel find_spline(SplineBasis basis, int width) {
    return width == 1 ? find_of_width<1>(basis) : width == 3 ? find_of_width<3>(basis) : nullptr;
}

/// Without a basis: one that a text names is vm/named_ops.cpp's to look up.
Kernel choose_spline(std::span<const int> widths) {
    return widths.size() < 3 ? nullptr : find_spline(SplineBasis::CatmullRom, widths[0]);
}

constexpr KernelRow kRows[] = {{rsl::Op::Spline, choose_spline}};

Kernel find_splines(rsl::Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(find_spline);
HWY_EXPORT(find_inverse);

/// RISpec's names, and the spellings with and without a hyphen, and the short one, that shaders have.
std::optional<SplineBasis> spline_basis(std::string_view name) {
    constexpr std::pair<std::string_view, SplineBasis> kNames[] = {
        {"catmull-rom", SplineBasis::CatmullRom}, {"catmullrom", SplineBasis::CatmullRom},
        {"catrom", SplineBasis::CatmullRom},      {"bezier", SplineBasis::Bezier},
        {"bspline", SplineBasis::BSpline},        {"b-spline", SplineBasis::BSpline},
        {"hermite", SplineBasis::Hermite},        {"linear", SplineBasis::Linear},
        {"constant", SplineBasis::Constant},
    };
    for (const auto& [known, basis] : kNames)
        if (known == name) return basis;
    return std::nullopt;
}

std::optional<SplineBasis> solved_spline_basis(std::string_view name) {
    constexpr std::string_view kPrefix = "solve";
    if (!name.starts_with(kPrefix)) return std::nullopt;
    const auto basis = spline_basis(name.substr(kPrefix.size()));
    return basis == SplineBasis::Constant ? std::nullopt : basis;
}

Kernel find_spline_inverse(SplineBasis basis) {
    return HWY_DYNAMIC_DISPATCH(find_inverse)(basis);
}

Kernel find_spline_kernel(SplineBasis basis, int width) {
    return HWY_DYNAMIC_DISPATCH(find_spline)(basis, width);
}

Kernel find_named_spline(std::string_view name, int width) {
    if (const auto solved = solved_spline_basis(name))
        return width == 1 ? find_spline_inverse(*solved) : nullptr;
    const auto basis = spline_basis(name);
    return basis ? find_spline_kernel(*basis, width) : nullptr;
}

}  // namespace trapeze::vm

TRAPEZE_KERNEL_FAMILY(find_splines)
#endif
