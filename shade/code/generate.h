/// From the checked tree to three-address code.
#pragma once

#include "core/diagnostics.h"
#include "shade/code/program.h"
#include "shade/rsl/syntax/ast.h"

namespace trapeze::rsl {

/// Functions are inlined; a shader whose code would have more instructions than this is refused.
inline constexpr size_t kMaxInstructions = 200'000;

/// The shader's code, neither optimised nor with storage inferred; the shader has passed the analysis.
/// Null, and an error reported, when it is too large.
std::unique_ptr<Program> generate(const Shader& shader, Diagnostics& diagnostics);

}  // namespace trapeze::rsl
