/// Operands in vectors, and loops over lanes that apply a function of vectors to them: included by each file
/// of kernels once for each target. Functions are those of one component or one triple; the loops have no
/// branches and read all of a lane group's inputs before they write.
#if defined(TRAPEZE_SHADE_VM_OPERANDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SHADE_VM_OPERANDS_INL_H_
#undef TRAPEZE_SHADE_VM_OPERANDS_INL_H_
#else
#define TRAPEZE_SHADE_VM_OPERANDS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "shade/vm/kernels/kernel.h"
#include "shade/vm/kernels/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace kernels::HWY_NAMESPACE;
using kernels::HWY_NAMESPACE::dot;  // by name, to stand beside the overloads below
using kernels::HWY_NAMESPACE::inverse_length;

using M = hn::Mask<D>;
using Operands = std::span<const Operand>;

/// Where functions have a pole at 0, this stands for what is less.
inline constexpr float kLeastNormal = 1.17549435e-38f;

/// A triple of each lane.
struct V3 {
    V x, y, z;
};

/// Copies of what loops need of an operand: in registers, where stores cannot be thought to change them.
struct Input {
    HWY_INLINE explicit Input(const Operand& o) : data(o.data), lane_mask(o.lane_mask), stride(o.stride) {}
    HWY_INLINE V get(size_t i, int k = 0) const {
        return hn::Load(D(), data + static_cast<size_t>(k) * stride + (i & lane_mask));
    }
    HWY_INLINE V3 get3(size_t i) const { return {get(i, 0), get(i, 1), get(i, 2)}; }
    /// The lanes where a Bool is true: it has all bits of a lane set, or none.
    HWY_INLINE M mask(size_t i) const { return hn::MaskFromVec(get(i)); }

    const float* data;
    size_t lane_mask, stride;
};

/// A uniform output is one of kLanes lanes. It is written whole, at consecutive lanes, and so has no lane
/// mask.
struct Output {
    HWY_INLINE explicit Output(const Operand& o) : data(o.data), stride(o.stride) {}
    HWY_INLINE V get(size_t i, int k = 0) const {
        return hn::Load(D(), data + static_cast<size_t>(k) * stride + i);
    }
    HWY_INLINE void put(V v, size_t i, int k = 0) const {
        hn::Store(v, D(), data + static_cast<size_t>(k) * stride + i);
    }
    HWY_INLINE void put3(const V3& v, size_t i) const { put(v.x, i, 0), put(v.y, i, 1), put(v.z, i, 2); }
    /// A Bool, in the form that Input::mask() reads.
    HWY_INLINE void put_mask(M m, size_t i) const { put(hn::VecFromMask(D(), m), i); }

    float* data;
    size_t stride;
};

/// Lanes that one turn of a loop does: a power of two, at most kLanes.
HWY_INLINE size_t lane_count() {
    return hn::Lanes(D());
}

/// out[k] = function(in[k]...) for k < width.
template <auto function, int width, size_t... n>
HWY_INLINE void map_components(size_t lanes, Operands o, std::index_sequence<n...>) {
    const Output out(o[0]);
    const Input in[] = {Input(o[n + 1])...};
    for (size_t i = 0; i < lanes; i += lane_count()) {
        // All components are computed before one is stored: the output may be one of the inputs.
        V result[width];
        for (int k = 0; k < width; ++k) result[k] = function(in[n].get(i, k)...);
        for (int k = 0; k < width; ++k) out.put(result[k], i, k);
    }
}

/// How many inputs a function of vectors has, as indices.
template <class... In>
constexpr std::make_index_sequence<sizeof...(In)> inputs_of(V (*)(In...)) {
    return {};
}

/// The kernel that applies a function of vectors to each of `width` components by itself.
template <auto function, int width>
void by_component(size_t lanes, Operands o) {
    map_components<function, width>(lanes, o, inputs_of(function));
}

/// The kernel that applies a function of components to floats or triples; null for other widths.
template <auto function>
Kernel component_kernel(std::span<const int> widths) {
    if (widths.size() != inputs_of(function).size() + 1) return nullptr;
    return widths[0] == 1 ? by_component<function, 1> : widths[0] == 3 ? by_component<function, 3> : nullptr;
}

/// The function of Op::Move.
HWY_INLINE V same(V a) {
    return a;
}

/// True where the widths of the operands are these.
HWY_INLINE bool are(std::span<const int> widths, std::initializer_list<int> wanted) {
    return std::equal(widths.begin(), widths.end(), wanted.begin(), wanted.end());
}

/// Choosers (see KernelRow) of a kernel that serves operands of these widths alone, and of one that is asked
/// for with so many operands only of the widths that it expects.
template <Kernel kernel, int... wanted>
Kernel exactly(std::span<const int> widths) {
    return are(widths, {wanted...}) ? kernel : nullptr;
}
template <Kernel kernel, size_t count>
Kernel counted(std::span<const int> widths) {
    return widths.size() == count ? kernel : nullptr;
}

/// Floor that keeps the sign of x where the result is zero; the Floor() of some targets does not.
HWY_INLINE V floor_of(V x) {
    return hn::CopySign(hn::Floor(x), x);
}

HWY_INLINE V dot(const V3& a, const V3& b) {
    return dot(a.x, a.y, a.z, b.x, b.y, b.z);
}
HWY_INLINE V3 add(const V3& a, const V3& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 subtract(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 scale(const V3& a, V s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

/// Right-handed in its formula; space itself is left-handed, as RISpec's camera space is.
HWY_INLINE V3 cross(const V3& a, const V3& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE V inverse_length(const V3& a) {
    return inverse_length(a.x, a.y, a.z);
}

}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
