#include "tessellate/surfaces/blobby/blobby_field.h"

#include <algorithm>
#include <cmath>

#include "tessellate/topology/placed_surface.h"

namespace trapeze {
namespace {

using BlobbyKind = BlobbyInstruction::Kind;

/// Sixteen floats of the request, row by row.
M44f matrix_at(const std::vector<float>& floats, size_t at) {
    M44f m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = floats[at + i];
    return m;
}

/// In doubles; false for a singular matrix and where the inverse is beyond floats.
bool invert(const M44f& m, M44f* inverse) {
    M44d d(m);
    if (!(std::abs(d.determinant()) > 0)) return false;
    *inverse = M44f(d.inverse());
    return std::all_of(&(*inverse)[0][0], &(*inverse)[0][0] + 16, [](float v) { return std::isfinite(v); });
}

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A leaf in its place. One with a matrix that cannot be inverted has no extent, nor one that reaches beyond
/// all numbers.
BlobbyLeaf placed(BlobbyLeaf leaf, const M44f& object_from_leaf) {
    leaf.object_from_leaf = object_from_leaf;
    leaf.ends = leaf.radius > 0 && invert(object_from_leaf, &leaf.leaf_from_object);
    const Box3f support = leaf.support();
    leaf.ends = leaf.ends && is_finite(support.min) && is_finite(support.max);
    return leaf;
}

/// The leaf of opcodes 1000 (constant), 1001 (ellipsoid) and 1002 (segment); others are 0 everywhere.
BlobbyLeaf leaf_of(int code, const std::vector<float>& floats, size_t at) {
    BlobbyLeaf leaf;
    if (code == 1001) return placed(leaf, matrix_at(floats, at));
    if (code == 1002) {
        leaf.begin = {floats[at], floats[at + 1], floats[at + 2]};
        leaf.end = {floats[at + 3], floats[at + 4], floats[at + 5]};
        leaf.radius = std::abs(floats[at + 6]);
        return placed(leaf, matrix_at(floats, at + 7));
    }
    leaf.ends = false;
    if (code == 1000) leaf.constant = floats[at];
    return leaf;
}

/// Without a ground the leaf is 0 everywhere: the depth map may not have been made yet.
BlobbyLeaf repelling_plane(const std::vector<float>& floats, size_t at, const GroundHeight& height) {
    BlobbyLeaf leaf;
    leaf.ends = false;
    if (height)
        leaf.ground = std::make_shared<RepellingGround>(
            RepellingGround{{floats[at], floats[at + 1], floats[at + 2], floats[at + 3]}, height});
    return leaf;
}

/// A small part of the bumps' extent.
float ground_step(std::span<const BlobbyLeaf> leaves) {
    Box3f box;
    for (const BlobbyLeaf& leaf : leaves)
        if (const Box3f support = leaf.support(); !support.isEmpty()) box.extendBy(support);
    const float diagonal = box.isEmpty() ? 1 : box.size().length();
    return std::isfinite(diagonal) ? std::max(1e-3f * diagonal, 1e-20f) : 1;
}

/// Subtract takes its second operand from its first, divide divides its first by its second. (RISpec's
/// table 5.3 names subtract's operands the other way about, and PRMan's Application Note 31 exchanges the
/// numbers 4 and 5; what programs write, and other renderers do, is this.)
BlobbyKind operator_kind(int code) {
    constexpr BlobbyKind kKinds[] = {BlobbyKind::Add,     BlobbyKind::Multiply, BlobbyKind::Maximum,
                                     BlobbyKind::Minimum, BlobbyKind::Subtract, BlobbyKind::Divide,
                                     BlobbyKind::Negate,  BlobbyKind::Same};
    return kKinds[code];
}

FieldValue scaled(const FieldValue& f, float s) {
    return {f.value * s, f.gradient * s};
}

/// What an operator makes of two values, with gradients by the rules of differentiation. A quotient by 0
/// counts as 0.
FieldValue combined(BlobbyKind kind, const FieldValue& a, const FieldValue& b) {
    switch (kind) {
        case BlobbyKind::Add:
            return {a.value + b.value, a.gradient + b.gradient};
        case BlobbyKind::Multiply:
            return {a.value * b.value, a.gradient * b.value + b.gradient * a.value};
        case BlobbyKind::Maximum:
            return a.value >= b.value ? a : b;
        case BlobbyKind::Minimum:
            return a.value <= b.value ? a : b;
        case BlobbyKind::Subtract:
            return {a.value - b.value, a.gradient - b.gradient};
        case BlobbyKind::Divide:
            if (b.value == 0) return {};
            return {a.value / b.value, (a.gradient - b.gradient * (a.value / b.value)) / b.value};
        default:
            return a;
    }
}

}  // namespace

/// The distance from the segment counts, in units of the radius; an ellipsoid is a segment of no length in a
/// space of its own.
FieldValue BlobbyLeaf::at(const V3f& p) const {
    if (ground) return ground->at(p);
    if (!ends) return {constant, {0, 0, 0}};
    const V3f local = transform_point(leaf_from_object, p), along = end - begin;
    const float length2 = along.dot(along);
    const float t = length2 > 0 ? std::clamp((local - begin).dot(along) / length2, 0.0f, 1.0f) : 0.0f;
    const V3f offset = (local - begin - along * t) / radius;
    const float rest = 1 - offset.dot(offset);
    if (!(rest > 0)) return {};
    // d/dp (1 - r^2)^3, along the offset from the segment; then by the inverse's transpose to object space.
    const V3f by_local = offset * (-6 * rest * rest / radius);
    const M44f& m = leaf_from_object;
    FieldValue f{rest * rest * rest, {0, 0, 0}};
    for (int i = 0; i < 3; ++i)
        f.gradient[i] = m[i][0] * by_local.x + m[i][1] * by_local.y + m[i][2] * by_local.z;
    return f;
}

/// Around each end a sphere in leaf space, which the matrix makes an ellipsoid: along an axis it reaches as
/// far as the column of the matrix is long.
Box3f BlobbyLeaf::support() const {
    Box3f box;
    if (!ends) return box;
    for (const V3f& centre : {begin, end}) {
        const V3f at = transform_point(object_from_leaf, centre);
        V3f half;
        for (int k = 0; k < 3; ++k) {
            const M44f& m = object_from_leaf;
            half[k] = radius * std::sqrt(m[0][k] * m[0][k] + m[1][k] * m[1][k] + m[2][k] * m[2][k]);
        }
        box.extendBy(at - half), box.extendBy(at + half);
    }
    return box;
}

/// Keeps the place along the segment and the offset from it in radii.
V3f BlobbyLeaf::carried(const V3f& p, const BlobbyLeaf& other) const {
    if (!ends || !other.ends) return p;
    const V3f local = transform_point(leaf_from_object, p), along = end - begin;
    const float length2 = along.dot(along);
    const float t = length2 > 0 ? std::clamp((local - begin).dot(along) / length2, 0.0f, 1.0f) : 0.0f;
    const V3f offset = (local - begin - along * t) * (other.radius / radius);
    return transform_point(other.object_from_leaf, other.begin + (other.end - other.begin) * t + offset);
}

/// Straight through the list, each instruction's result in its place: no recursion, whatever a file writes.
FieldValue BlobbyProgram::at(const V3f& p, std::span<const BlobbyLeaf> leaves,
                             std::vector<FieldValue>& results) const {
    if (instructions.empty()) return {};
    results.resize(instructions.size());
    for (size_t i = 0; i < instructions.size(); ++i) {
        const BlobbyInstruction& in = instructions[i];
        if (in.kind == BlobbyKind::Leaf)
            results[i] = leaves[in.leaf].at(p);
        else if (in.kind == BlobbyKind::Constant)
            results[i] = {in.constant, {0, 0, 0}};
        else {
            const int* const from = operands.data() + in.first_operand;
            FieldValue value = results[from[0]];
            for (int k = 1; k < in.operand_count; ++k) value = combined(in.kind, value, results[from[k]]);
            results[i] = in.kind == BlobbyKind::Negate ? scaled(value, -1) : value;
        }
    }
    return results.back();
}

/// Constant folding with all other leaves at 0: a sum of a thousand leaves becomes one of the few that reach
/// a block. The order of what is left stays, and so the rounding of its sums.
BlobbyProgram BlobbyProgram::reduced(std::span<const int> leaves) const {
    BlobbyProgram out;
    // By instruction: its number in `out`, or -1 and a constant.
    std::vector<int> number(instructions.size(), -1);
    std::vector<float> constant(instructions.size(), 0.0f);
    const auto emit = [&](const BlobbyInstruction& in) {
        out.instructions.push_back(in);
        return static_cast<int>(out.instructions.size()) - 1;
    };
    // Constants become instructions only where something that is kept reads them, once each.
    std::vector<int> constant_number(instructions.size(), -1);
    const auto as_number = [&](int i) {
        if (number[i] >= 0) return number[i];
        if (constant_number[i] < 0) constant_number[i] = emit({BlobbyKind::Constant, 0, constant[i], 0, 0});
        return constant_number[i];
    };
    for (size_t i = 0; i < instructions.size(); ++i) {
        const BlobbyInstruction& in = instructions[i];
        if (in.kind == BlobbyKind::Constant) {
            constant[i] = in.constant;
            continue;
        }
        if (in.kind == BlobbyKind::Leaf) {
            if (std::ranges::binary_search(leaves, in.leaf)) number[i] = emit(in);
            continue;
        }
        const std::span<const int> from(operands.data() + in.first_operand, in.operand_count);
        if (std::ranges::all_of(from, [&](int k) { return number[k] < 0; })) {
            // All operands are constant: so is the result.
            FieldValue value{constant[from[0]], {0, 0, 0}};
            for (size_t k = 1; k < from.size(); ++k)
                value = combined(in.kind, value, {constant[from[k]], {0, 0, 0}});
            constant[i] = in.kind == BlobbyKind::Negate ? -value.value : value.value;
            continue;
        }
        std::vector<int> kept;
        for (const int k : from)
            if (in.kind != BlobbyKind::Add || number[k] >= 0 || constant[k] != 0)
                kept.push_back(as_number(k));
        BlobbyInstruction copy = in;
        copy.first_operand = static_cast<int>(out.operands.size());
        copy.operand_count = static_cast<int>(kept.size());
        out.operands.insert(out.operands.end(), kept.begin(), kept.end());
        number[i] = emit(copy);
    }
    // The result comes last.
    if (!instructions.empty() && number.back() < 0) emit({BlobbyKind::Constant, 0, constant.back(), 0, 0});
    return out;
}

/// Opcodes from 1000 on are leaves, those below operators, as RISpec numbers them.
BlobbyField blobby_field(const Blobby& blobby, const FindGround& find_ground) {
    BlobbyField field;
    const std::vector<int>& code = blobby.code;
    for (size_t at = 0; at < code.size();) {
        const int op = code[at++];
        BlobbyInstruction in;
        if (op >= 1000) {
            in.kind = BlobbyKind::Leaf;
            in.leaf = static_cast<int>(field.leaves.size());
            if (op == 1003) {
                const std::string& name = blobby.strings[code[at++]];
                field.leaves.push_back(repelling_plane(blobby.floats, code[at++],
                                                       find_ground ? find_ground(name) : GroundHeight()));
            } else if (op == 1004) {  // a field of compiled code: 0
                field.leaves.emplace_back().ends = false;
                at += 5;
            } else {
                field.leaves.push_back(leaf_of(op, blobby.floats, code[at++]));
            }
            const BlobbyLeaf& leaf = field.leaves.back();
            if (leaf.ground) {
                field.grounds.push_back(in.leaf);
            } else if (!leaf.ends) {
                in.kind = BlobbyKind::Constant;
                in.constant = leaf.constant;
            }
        } else {
            in.kind = operator_kind(op);
            in.operand_count = op < 4 ? code[at++] : op < 6 ? 2 : 1;
            in.first_operand = static_cast<int>(field.program.operands.size());
            for (int k = 0; k < in.operand_count; ++k) field.program.operands.push_back(code[at++]);
        }
        field.program.instructions.push_back(in);
    }
    for (const int leaf : field.grounds) field.leaves[leaf].ground->step = ground_step(field.leaves);
    return field;
}

}  // namespace trapeze
