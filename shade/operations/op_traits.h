/// What the optimiser and the machine must know of an operation besides its arithmetic.
#pragma once

#include "shade/operations/op.h"

namespace trapeze::rsl {

/// A block's opening, middle or end, or a jump.
constexpr bool is_control(Op op) {
    return op >= Op::If && op <= Op::EndGather;
}

/// The output keeps what the operation does not set.
constexpr bool keeps_output(Op op) {
    switch (op) {
        case Op::SetComponent:
        case Op::SetMatrixElement:
        case Op::SetElement:
        case Op::TextureInfo:
        case Op::RayInfo:
            return true;
        default:
            return op >= Op::LightMessage && op <= Op::RendererInfo;
    }
}

/// Looks at more lanes than the one that it computes.
constexpr bool reads_neighbours(Op op) {
    return (op >= Op::Du && op <= Op::FilterStep) || (op >= Op::Texture && op <= Op::Bump);
}

/// Does nothing but set its outputs, so that it may go when nobody reads them.
constexpr bool is_pure(Op op) {
    return !is_control(op) && op != Op::Print;
}

/// Gives the same outputs for the same inputs wherever it stands in a run.
constexpr bool is_repeatable(Op op) {
    if (is_control(op) || keeps_output(op)) return false;
    switch (op) {
        case Op::Random:
        case Op::Print:
            return false;
        default:
            return !(op >= Op::Trace && op <= Op::ShaderName);
    }
}

/// Differs from vertex to vertex even with uniform inputs.
constexpr bool is_varying_by_itself(Op op) {
    return op == Op::Random || (op >= Op::Ambient && op <= Op::Phong) ||
           (op >= Op::Trace && op <= Op::IndirectDiffuse) ||
           (op >= Op::LightMessage && op <= Op::OppositeMessage);
}

/// Opens a block that a matching end closes.
constexpr bool opens_block(Op op) {
    return op == Op::If || op == Op::Loop || op == Op::Scope || op == Op::Illuminance ||
           op == Op::Illuminate || op == Op::Solar || op == Op::Gather;
}
constexpr bool closes_block(Op op) {
    return op == Op::EndIf || op == Op::EndLoop || op == Op::EndScope || op == Op::EndIlluminance ||
           op == Op::EndIlluminate || op == Op::EndSolar || op == Op::EndGather;
}
/// A loop that Break and Continue count.
constexpr bool opens_loop(Op op) {
    return op == Op::Loop || op == Op::Illuminance || op == Op::Gather;
}

}  // namespace trapeze::rsl
