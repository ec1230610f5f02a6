/// The shading language's front end: text in, checked tree out (RISpec 3.2, sections 11 to 15). What follows
/// on it, up to code that runs, is shade/vm/compile_shader.h.
#pragma once

#include <memory>

#include "core/diagnostics.h"
#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/printer.h"
#include "shade/rsl/syntax/source.h"

namespace trapeze::rsl {

/// The tree as written, not analysed. Null when there were errors; all are reported.
std::unique_ptr<TranslationUnit> parse(const Source& source, const CompileOptions& options,
                                       Diagnostics& diagnostics);

/// The checked tree: see ast.h for what the analysis completes. Null when there were errors; all are reported
/// (of very many, the first fifty).
std::unique_ptr<TranslationUnit> compile_front(const Source& source, const CompileOptions& options,
                                               Diagnostics& diagnostics);

}  // namespace trapeze::rsl
