/// From a shader's text to what the grid machine runs. All who compile shaders do it by these calls; only
/// tests of a single stage call that one alone.
///
///     text ── parse, analyse ──▶ tree ── generate, optimise ──▶ program ── lay out ──▶ executable
///             rsl/front_end.h            code/generate.h, optimise.h       code/infer_storage.h,
///             vm/executable.h
///
/// A program does not depend on the scene; which of its registers hold a value for each vertex does, for a
/// primitive may bring one for each where the shader declares one for all. So one program may be laid out
/// several times.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "shade/code/optimise.h"
#include "shade/code/program.h"
#include "shade/rsl/front_end.h"
#include "shade/vm/executable.h"

namespace trapeze::vm {

/// The program of a shader in a source: of the one named so, or else of the first; where two have its name (a
/// class of RSL 2 that shades and displaces), of the wanted kind. Null, and all errors reported, when the
/// source has errors or the shader is too large; null without a word when there is no shader in it.
std::unique_ptr<rsl::Program> compile_program(const rsl::Source& source, const rsl::CompileOptions& options,
                                              Diagnostics& diagnostics, std::string_view name = {},
                                              std::optional<rsl::ShaderKind> kind = {},
                                              const rsl::OptimiseOptions& optimiser = {});

/// The program of a shader that has been parsed and analysed. Null, and reported, when it is too large.
std::unique_ptr<rsl::Program> compile_program(const rsl::Shader& shader, Diagnostics& diagnostics,
                                              const rsl::OptimiseOptions& optimiser = {});

/// The program ready to run, in which the named parameters are varying besides those that it declares so.
std::shared_ptr<const Executable> lay_out(rsl::Program program, const std::set<std::string>& varying = {},
                                          const LoopLimits& limits = {});

/// All stages in a row, for the first shader of a source and no parameter that the scene makes vary. Null
/// where there is no program.
std::shared_ptr<const Executable> compile_shader(const rsl::Source& source,
                                                 const rsl::CompileOptions& options, Diagnostics& diagnostics,
                                                 const rsl::OptimiseOptions& optimiser = {});

}  // namespace trapeze::vm
