/// What the compiler and the machine must know of an operation besides its arithmetic: its row of
/// op_table.def, and questions about it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "shade/operations/op.h"

namespace trapeze::rsl {

/// The source files of kernels in vm/kernels: arithmetic that needs nothing but its operands.
enum class KernelFamily : uint8_t {
    None,
    Arithmetic,
    Bools,
    Elementary,
    Parts,
    Geometry,
    Light,
    Matrices,
    Noise,
    Splines
};

/// The source files of functions in vm that ask what is around a run, or handle texts.
enum class ContextFamily : uint8_t {
    None,
    Texts,
    Arrays,
    Names,
    Neighbours,
    Random,
    Maps,
    Clouds,
    Lights,
    Rays,
    Messages
};

/// Traits of operations, bits of OpRow::traits.
namespace op_traits {

enum : uint32_t {
    kPlain = 0,            ///< a function of its inputs, lane by lane, as often as one likes
    kControl = 1 << 0,     ///< a block's opening, middle or end, or a jump
    kOpens = 1 << 1,       ///< opens a block that a matching end closes
    kDivides = 1 << 2,     ///< the middle of a block: its first half ends here
    kCloses = 1 << 3,      ///< the end of a block
    kLoops = 1 << 4,       ///< opens a block that runs in turns, which Break and Continue count
    kKeeps = 1 << 5,       ///< the output keeps what the operation does not set
    kNeighbours = 1 << 6,  ///< looks at more lanes than the one that it computes
    kEffect = 1 << 7,      ///< does more than set its outputs
    kOnce = 1 << 8,        ///< may give other outputs for the same inputs elsewhere in a run
    kVaries = 1 << 9,      ///< differs from vertex to vertex even with uniform inputs
    kAsks = 1 << 10,       ///< follows from the point, maps, lights or other shaders besides its inputs
    kRewritten = 1 << 11,  ///< code generation writes it as other operations
    /// Leaves lanes alone that do not run by itself: its output may get other memory while it runs.
    kMasksItself = 1 << 15,
    // Predefined variables that it reads without the source naming them.
    kNeedsP = 1 << 12,   ///< P, in front of its inputs; and N, for lights that ask the surface
    kNeedsUV = 1 << 13,  ///< u and v, behind its inputs
    kNeedsNg = 1 << 14,  ///< Ng, where the third input is left out
};

}  // namespace op_traits

/// The name of a map that asks for rays instead, as shaders of PRMan have it.
inline constexpr std::string_view kTracedMap = "raytrace";
/// In front of a map's name: the category of gather() that asks the map, and sends no rays.
inline constexpr std::string_view kOfEnvironment = "environment:";

/// u and v of the surface that is shaded, under names that no source has: for derivatives in lights, whose
/// own u and v are others, and where a parameter is called u or v.
inline constexpr std::string_view kSurfaceU = "surface:u", kSurfaceV = "surface:v";
/// Predefined variables that no source can name, inputs of Op::RayWay.
inline constexpr std::string_view kRayOrigin = "ray:origin", kRayWay = "ray:way";

/// Op::Random's immediate: the call's number in the program, and whether all vertices of a grid get the same.
namespace random_call {
inline constexpr int32_t kOfGrid = 1 << 30;
}

struct OpRow {
    Op op;
    std::string_view name;      ///< as the listing of a program has it
    std::string_view operands;  ///< one of its forms, in the letters of op_table.def
    KernelFamily kernels;
    ContextFamily context;
    uint32_t traits;
};

namespace op_traits {

/// All operations in the order of Op.
inline constexpr OpRow kRows[] = {
#define TRAPEZE_OP(name, operands, kernels, context, traits) \
    {Op::name, #name, operands, KernelFamily::kernels, ContextFamily::context, traits},
#include "shade/operations/op_table.def"
#undef TRAPEZE_OP
};

constexpr bool has(Op op, uint32_t traits) {
    return (kRows[static_cast<size_t>(op)].traits & traits) != 0;
}

}  // namespace op_traits

constexpr std::span<const OpRow> op_table() {
    return op_traits::kRows;
}
constexpr const OpRow& row_of(Op op) {
    return op_traits::kRows[static_cast<size_t>(op)];
}

constexpr bool is_control(Op op) {
    return op_traits::has(op, op_traits::kControl);
}
constexpr bool opens_block(Op op) {
    return op_traits::has(op, op_traits::kOpens);
}
constexpr bool divides_block(Op op) {
    return op_traits::has(op, op_traits::kDivides);
}
constexpr bool closes_block(Op op) {
    return op_traits::has(op, op_traits::kCloses);
}
constexpr bool opens_loop(Op op) {
    return op_traits::has(op, op_traits::kLoops);
}
constexpr bool keeps_output(Op op) {
    return op_traits::has(op, op_traits::kKeeps);
}
constexpr bool reads_neighbours(Op op) {
    return op_traits::has(op, op_traits::kNeighbours);
}
constexpr bool is_varying_by_itself(Op op) {
    return op_traits::has(op, op_traits::kVaries);
}
/// Whether the result is known only in a run, even where all inputs are.
constexpr bool asks_surroundings(Op op) {
    return op_traits::has(op, op_traits::kAsks);
}
/// Whether the operation may send rays into the scene.
constexpr bool sends_rays(Op op) {
    return op == Op::Gather ||
           (row_of(op).context == ContextFamily::Rays && op != Op::RayInfo && op != Op::RayWay &&
            op != Op::RayLevel && op != Op::RayLabel && op != Op::IsIndirectRay && op != Op::IsShadowRay);
}
constexpr bool masks_itself(Op op) {
    return op_traits::has(op, op_traits::kMasksItself);
}
/// Whether the operation may go when nobody reads its outputs.
constexpr bool is_pure(Op op) {
    return !op_traits::has(op, op_traits::kControl | op_traits::kEffect);
}
/// Whether the operation gives the same outputs for the same inputs wherever it stands in a run, so that one
/// result may serve for two.
constexpr bool is_repeatable(Op op) {
    return !op_traits::has(op,
                           op_traits::kControl | op_traits::kEffect | op_traits::kOnce | op_traits::kKeeps);
}

}  // namespace trapeze::rsl
