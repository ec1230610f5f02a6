#include "shade/vm/compile_shader.h"

#include <algorithm>

#include "shade/code/generate.h"
#include "shade/code/infer_storage.h"

namespace trapeze::vm {

/// The first shader stands in for a name that the source does not have: files are mostly named after the one
/// shader in them, and some hold it under another name.
std::unique_ptr<rsl::Program> compile_program(const rsl::Source& source, const rsl::CompileOptions& options,
                                              Diagnostics& diagnostics, std::string_view name,
                                              std::optional<rsl::ShaderKind> kind,
                                              const rsl::OptimiseOptions& optimiser) {
    const auto unit = rsl::compile_front(source, options, diagnostics);
    if (!unit || unit->shaders.empty()) return nullptr;
    const auto is_named = [&](const auto& shader) { return shader->name == name; };
    const std::string_view chosen =
        std::ranges::any_of(unit->shaders, is_named) ? name : unit->shaders.front()->name;
    const rsl::Shader* shader = nullptr;
    for (const auto& candidate : unit->shaders)
        if (candidate->name == chosen && (!shader || candidate->kind == kind)) shader = candidate.get();
    return compile_program(*shader, diagnostics, optimiser);
}

/// Null, with an error said, where the shader uses what the machine does not have.
std::unique_ptr<rsl::Program> compile_program(const rsl::Shader& shader, Diagnostics& diagnostics,
                                              const rsl::OptimiseOptions& optimiser) {
    std::unique_ptr<rsl::Program> program = rsl::generate(shader, diagnostics);
    if (program) rsl::optimise(*program, optimiser);
    return program;
}

/// Takes the program by value: storage is inferred in place, and another layout of the same program starts
/// from one in which it is not.
std::shared_ptr<const Executable> lay_out(rsl::Program program, const std::set<std::string>& varying,
                                          const LoopLimits& limits) {
    rsl::infer_storage(program, varying);
    return std::make_shared<const Executable>(std::move(program), limits);
}

/// All stages in a row; null where one of them has found an error, which it has reported.
std::shared_ptr<const Executable> compile_shader(const rsl::Source& source,
                                                 const rsl::CompileOptions& options, Diagnostics& diagnostics,
                                                 const rsl::OptimiseOptions& optimiser) {
    std::unique_ptr<rsl::Program> program = compile_program(source, options, diagnostics, {}, {}, optimiser);
    return program ? lay_out(std::move(*program)) : nullptr;
}

}  // namespace trapeze::vm
