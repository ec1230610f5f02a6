/// Components of triples, elements of matrices and arrays: putting together and taking apart.
#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/parts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

/// x rounded down, 0 to count - 1; 0 for NaN. Indices out of range are clamped, so that no shader reads or
/// writes outside its own registers.
HWY_INLINE VI index_below(V x, int count) {
    return hn::ConvertTo(DI(), at_most(positive(x), set(static_cast<float>(count - 1))));
}

/// Offsets of these lanes in planes `distance` floats apart.
HWY_INLINE VI offsets(VI index, size_t distance) {
    const DI di;
    return hn::Add(hn::Mul(index, hn::Set(di, static_cast<int32_t>(distance))), hn::Iota(di, 0));
}

/// Triple and Sixteen. All parts are read before any is written, for the output may be one of them.
template <int width>
void assemble(size_t lanes, Operands o) {
    const Output out(o[0]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        V parts[width];
        for (int k = 0; k < width; ++k) parts[k] = Input(o[static_cast<size_t>(k) + 1]).get(i);
        for (int k = 0; k < width; ++k) out.put(parts[k], i, k);
    }
}

/// comp(c, k) and c[k]; compares instead of gathering, which for three planes is quicker.
void component(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input v(o[1]), index(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V k = index.get(i);
        const V upper = hn::IfThenElse(hn::Lt(k, set(2)), v.get(i, 1), v.get(i, 2));
        out.put(hn::IfThenElse(hn::Not(hn::Ge(k, set(1))), v.get(i, 0), upper), i);
    }
}

/// setcomp(c, k, x) and c[k] = x: all three components are rewritten, so that no lane needs a scatter.
void set_component(size_t lanes, Operands o) {
    const Output v(o[0]);
    const Input index(o[1]), in(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const VI k = index_below(index.get(i), 3);
        const V x = in.get(i);
        for (int j = 0; j < 3; ++j)
            v.put(hn::IfThenElse(hn::RebindMask(D(), hn::Eq(k, hn::Set(DI(), j))), x, v.get(i, j)), i, j);
    }
}

/// Which of the sixteen planes an element lies in: they go by rows of four.
HWY_INLINE VI matrix_index(V row, V column) {
    return hn::Add(hn::ShiftLeft<2>(index_below(row, 4)), index_below(column, 4));
}

/// An element for each lane: planes are m.stride floats apart, and lane i of one is its float i.
void matrix_element(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input m(o[1]), row(o[2]), column(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const VI at = offsets(matrix_index(row.get(i), column.get(i)), m.stride);
        out.put(hn::GatherIndex(D(), m.data + (i & m.lane_mask), at), i);
    }
}

/// Sets one float of a matrix, another one in each lane; the other elements keep what they have.
void set_matrix_element(size_t lanes, Operands o) {
    const Output m(o[0]);
    const Input row(o[1]), column(o[2]), x(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const VI at = offsets(matrix_index(row.get(i), column.get(i)), m.stride);
        hn::ScatterIndex(x.get(i), D(), m.data + i, at);
    }
}

/// The operand of one element of an array, at an index that all lanes share; clamped to the array, and NaN
/// is 0, as in index_below().
Operand element_at(const Operand& array, float index) {
    const float last = static_cast<float>(std::max(array.length, 1) - 1);
    Operand element = array;
    element.data += static_cast<size_t>(index > 0 ? std::min(index, last) : 0) * array.element_stride;
    return element;
}

/// array[index]. Mostly the index is uniform, and the element is copied; else each lane gathers its own.
template <int width>
void element(size_t lanes, Operands o) {
    // The same element for all lanes: its planes are copied as they lie.
    if (o[2].lane_mask == 0)
        return by_component<same, width>(lanes, std::array{o[0], element_at(o[1], o[2].data[0])});
    const Output out(o[0]);
    const Input array(o[1]), index(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const VI at = offsets(index_below(index.get(i), std::max(o[1].length, 1)), o[1].element_stride);
        V values[width];
        for (size_t k = 0; k < width; ++k)
            values[k] = hn::GatherIndex(D(), array.data + (i & array.lane_mask) + k * array.stride, at);
        for (int k = 0; k < width; ++k) out.put(values[k], i, k);
    }
}

/// array[index] = value: the one element, or by lane. Other elements keep what they have.
template <int width>
void set_element(size_t lanes, Operands o) {
    // The same element for all lanes: its planes are written as they lie.
    if (o[1].lane_mask == 0)
        return by_component<same, width>(lanes, std::array{element_at(o[0], o[1].data[0]), o[2]});
    const Output array(o[0]);
    const Input index(o[1]), in(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const VI at = offsets(index_below(index.get(i), std::max(o[0].length, 1)), o[0].element_stride);
        for (int k = 0; k < width; ++k)
            hn::ScatterIndex(in.get(i, k), D(), array.data + i + static_cast<size_t>(k) * array.stride, at);
    }
}

/// Op::Clear: a local array without an initial value starts as zeros whenever its declaration is reached, and
/// not as what its planes held before.
template <int width>
void clear(size_t lanes, Operands o) {
    for (int e = 0; e < o[0].length; ++e)
        for (size_t k = 0; k < width; ++k)
            std::fill_n(o[0].data + static_cast<size_t>(e) * o[0].element_stride + k * o[0].stride, lanes,
                        0.0f);
}

Kernel find_clear(std::span<const int> widths) {
    if (are(widths, {1})) return clear<1>;
    if (are(widths, {3})) return clear<3>;
    return are(widths, {16}) ? clear<16> : nullptr;
}

/// Widths are those of the result, the array's elements and the index.
Kernel find_element(std::span<const int> widths) {
    if (are(widths, {1, 1, 1})) return element<1>;
    if (are(widths, {3, 3, 1})) return element<3>;
    return are(widths, {16, 16, 1}) ? element<16> : nullptr;
}

Kernel find_set_element(std::span<const int> widths) {
    if (widths.size() != 3) return nullptr;
    return widths[0] == 1    ? set_element<1>
           : widths[0] == 3  ? set_element<3>
           : widths[0] == 16 ? set_element<16>
                             : nullptr;
}

constexpr KernelRow kRows[] = {
    {Op::Triple, exactly<assemble<3>, 3, 1, 1, 1>},
    {Op::Sixteen, counted<assemble<16>, 17>},
    {Op::Component, exactly<component, 1, 3, 1>},
    {Op::SetComponent, exactly<set_component, 3, 1, 1>},
    {Op::MatrixElement, exactly<matrix_element, 1, 16, 1, 1>},
    {Op::SetMatrixElement, exactly<set_matrix_element, 16, 1, 1, 1>},
    {Op::Element, find_element},
    {Op::SetElement, find_set_element},
    {Op::Clear, find_clear},
};

Kernel find_parts(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
TRAPEZE_KERNEL_FAMILY(find_parts)
#endif
