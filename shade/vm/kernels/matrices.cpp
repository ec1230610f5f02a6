/// Operations on matrices of 4 by 4, by rows, which row vectors are multiplied with from the left.
#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/matrices.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

/// A matrix for each lane of a vector, in sixteen of them: rows of four. Element (row, column) is m[4 row +
/// column], as RIB writes matrices; a translation is the last row.
struct Matrix {
    HWY_INLINE V operator()(int row, int column) const { return m[row * 4 + column]; }
    HWY_INLINE V3 row(int i) const { return {m[i * 4], m[i * 4 + 1], m[i * 4 + 2]}; }
    V m[16];
};

/// The components of a register of width 16 are the elements by rows.
HWY_INLINE Matrix read(const Input& in, size_t i) {
    Matrix m;
    for (int k = 0; k < 16; ++k) m.m[k] = in.get(i, k);
    return m;
}
HWY_INLINE void write(const Matrix& m, const Output& out, size_t i) {
    for (int k = 0; k < 16; ++k) out.put(m.m[k], i, k);
}

/// Row vectors go through a first, then b. Sums run in the order of k. The order is fixed, so that all widths
/// of vectors round alike.
HWY_INLINE Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            V sum = hn::Mul(a(row, 0), b(0, column));
            for (int k = 1; k < 4; ++k) sum = hn::Add(sum, hn::Mul(a(row, k), b(k, column)));
            out.m[row * 4 + column] = sum;
        }
    return out;
}

/// Minors of the first two rows and of the last two, of columns 01 02 03 12 13 23.
struct Minors {
    V first[6], last[6];
};
/// Twelve products of two rows each, which determinant and inverse are both made of.
HWY_INLINE Minors minors(const Matrix& m) {
    constexpr int kPairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    Minors result;
    for (int k = 0; k < 6; ++k) {
        const int a = kPairs[k][0], b = kPairs[k][1];
        result.first[k] = hn::Sub(hn::Mul(m(0, a), m(1, b)), hn::Mul(m(0, b), m(1, a)));
        result.last[k] = hn::Sub(hn::Mul(m(2, a), m(3, b)), hn::Mul(m(2, b), m(3, a)));
    }
    return result;
}
/// Laplace's expansion along the upper two rows: each minor of them times the one of the lower two rows and
/// the other columns, with alternating signs.
HWY_INLINE V determinant(const Minors& n) {
    V sum = hn::Mul(n.first[0], n.last[5]);
    sum = hn::Sub(sum, hn::Mul(n.first[1], n.last[4]));
    sum = hn::Add(sum, hn::Mul(n.first[2], n.last[3]));
    sum = hn::Add(sum, hn::Mul(n.first[3], n.last[2]));
    sum = hn::Sub(sum, hn::Mul(n.first[4], n.last[1]));
    return hn::Add(sum, hn::Mul(n.first[5], n.last[0]));
}

/// a x - b y + c z.
HWY_INLINE V alternating(V a, V x, V b, V y, V c, V z) {
    return hn::Add(hn::Sub(hn::Mul(a, x), hn::Mul(b, y)), hn::Mul(c, z));
}

/// By Laplace's expansion along the upper two rows; the identity where a matrix has none.
HWY_INLINE Matrix inverse(const Matrix& m) {
    const Minors n = minors(m);
    const V d = determinant(n), inverse_determinant = hn::Div(set(1), d);
    // Neither a determinant of 0 or NaN, nor one whose reciprocal is no float.
    const M regular =
        hn::And(hn::Gt(hn::Abs(d), hn::Zero(D())), hn::Lt(hn::Abs(inverse_determinant), set(3e38f)));
    Matrix out;
    for (int half = 0; half < 2; ++half) {
        const V(&s)[6] = half ? n.first : n.last;
        const int upper = half ? 3 : 1, lower = half ? 2 : 0;  // rows of m that the columns come from
        for (int k = 0; k < 2; ++k) {
            const int row = k ? lower : upper, column = half * 2 + k;
            const V cofactors[4] = {alternating(m(row, 1), s[5], m(row, 2), s[4], m(row, 3), s[3]),
                                    alternating(m(row, 0), s[5], m(row, 2), s[2], m(row, 3), s[1]),
                                    alternating(m(row, 0), s[4], m(row, 1), s[2], m(row, 3), s[0]),
                                    alternating(m(row, 0), s[3], m(row, 1), s[1], m(row, 2), s[0])};
            for (int i = 0; i < 4; ++i) {
                const V signed_cofactor = (i + column) % 2 ? hn::Neg(cofactors[i]) : cofactors[i];
                out.m[i * 4 + column] = hn::IfThenElse(regular, hn::Mul(signed_cofactor, inverse_determinant),
                                                       set(i == column ? 1.0f : 0.0f));
            }
        }
    }
    return out;
}

/// Both matrices are read whole before the product is written, for the output may be either.
void multiply(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) write(product(read(a, i), read(b, i)), out, i);
}

/// a / b is a times the inverse of b (RISpec 3.2, section 13).
void divide(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) write(product(read(a, i), inverse(read(b, i))), out, i);
}

/// Matrices are of 16 planes, row by row, for row vectors.
void invert(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) write(inverse(read(in, i)), out, i);
}

void determinant_of(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) out.put(determinant(minors(read(in, i))), i);
}

/// Translation, scaling and rotation come before the matrix, as those of the RI come before the current
/// transformation.
void translate(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]), by(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        Matrix m = read(in, i);
        const V3 v = by.get3(i);
        for (int k = 0; k < 4; ++k)
            m.m[12 + k] = hn::Add(dot(v.x, v.y, v.z, m(0, k), m(1, k), m(2, k)), m(3, k));
        write(m, out, i);
    }
}

/// A scaling in front of m multiplies its first three rows.
void scale_rows(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]), by(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        Matrix m = read(in, i);
        for (int row = 0; row < 3; ++row)
            for (int k = 0; k < 4; ++k) m.m[row * 4 + k] = hn::Mul(by.get(i, row), m(row, k));
        write(m, out, i);
    }
}

/// By an angle in radians about an axis; not at all where the axis is zero.
void rotate(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]), angle(o[2]), axis(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const Matrix m = read(in, i);
        const V3 line = axis.get3(i);
        const V inverse = inverse_length(line);
        const V3 a = scale(line, inverse);
        // Without an axis the angle is taken as 0, which leaves m as it was.
        const SineCosine turn = sin_cos(hn::IfThenZeroElse(hn::Eq(inverse, hn::Zero(D())), angle.get(i)));
        const V rest = hn::Sub(set(1), turn.cosine);
        const V3 s = scale(a, turn.sine), r = scale(a, rest);
        // Rodrigues' matrix for row vectors: cos I + (1 - cos) a a^T + sin [a]x, transposed.
        const V3 rotation[3] = {{hn::Add(hn::Mul(a.x, r.x), turn.cosine), hn::Add(hn::Mul(a.x, r.y), s.z),
                                 hn::Sub(hn::Mul(a.x, r.z), s.y)},
                                {hn::Sub(hn::Mul(a.y, r.x), s.z), hn::Add(hn::Mul(a.y, r.y), turn.cosine),
                                 hn::Add(hn::Mul(a.y, r.z), s.x)},
                                {hn::Add(hn::Mul(a.z, r.x), s.y), hn::Sub(hn::Mul(a.z, r.y), s.x),
                                 hn::Add(hn::Mul(a.z, r.z), turn.cosine)}};
        Matrix result = m;
        for (int row = 0; row < 3; ++row)
            for (int k = 0; k < 4; ++k)
                result.m[row * 4 + k] =
                    dot(rotation[row].x, rotation[row].y, rotation[row].z, m(0, k), m(1, k), m(2, k));
        write(result, out, i);
    }
}

/// Divided by w, unless it is 0. One division for three components, which may differ from three by a last
/// bit.
void transform_point(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input m(o[1]), in(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 p = in.get3(i);
        const auto column = [&](int k) HWY_ATTR {
            return hn::Add(dot(p.x, p.y, p.z, m.get(i, k), m.get(i, 4 + k), m.get(i, 8 + k)),
                           m.get(i, 12 + k));
        };
        const V w = column(3);
        const V divisor = hn::IfThenElse(hn::Eq(w, hn::Zero(D())), set(1), w);
        out.put3(scale({column(0), column(1), column(2)}, hn::Div(set(1), divisor)), i);
    }
}

/// Without the translation, and without a division: vectors have no place.
void transform_vector(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input m(o[1]), in(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = in.get3(i);
        const auto column = [&](int k) HWY_ATTR {
            return dot(v.x, v.y, v.z, m.get(i, k), m.get(i, 4 + k), m.get(i, 8 + k));
        };
        out.put3({column(0), column(1), column(2)}, i);
    }
}

/// By the inverse transpose of the upper 3 by 3 part: n.x b^c + n.y c^a + n.z a^b over the determinant, with
/// a, b, c the rows. A singular part leaves out the division.
void transform_normal(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input m(o[1]), in(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const auto row = [&](int k) HWY_ATTR { return V3{m.get(i, k), m.get(i, k + 1), m.get(i, k + 2)}; };
        const V3 a = row(0), b = row(4), c = row(8), n = in.get3(i);
        const V3 bc = cross(b, c);
        const V determinant = dot(a, bc);
        const V divisor = hn::IfThenElse(hn::Eq(determinant, hn::Zero(D())), set(1), determinant);
        const V3 sum = add(add(scale(bc, n.x), scale(cross(c, a), n.y)), scale(cross(a, b), n.z));
        out.put3(scale(sum, hn::Div(set(1), divisor)), i);
    }
}

constexpr KernelRow kRows[] = {
    {Op::MatrixMultiply, exactly<multiply, 16, 16, 16>},
    {Op::MatrixDivide, exactly<divide, 16, 16, 16>},
    {Op::Invert, exactly<invert, 16, 16>},
    {Op::Determinant, exactly<determinant_of, 1, 16>},
    {Op::TranslateMatrix, exactly<translate, 16, 16, 3>},
    {Op::ScaleMatrix, exactly<scale_rows, 16, 16, 3>},
    {Op::RotateMatrix, exactly<rotate, 16, 16, 1, 3>},
    {Op::TransformPoint, exactly<transform_point, 3, 16, 3>},
    {Op::TransformVector, exactly<transform_vector, 3, 16, 3>},
    {Op::TransformNormal, exactly<transform_normal, 3, 16, 3>},
};

Kernel find_matrices(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
TRAPEZE_KERNEL_FAMILY(find_matrices)
#endif
