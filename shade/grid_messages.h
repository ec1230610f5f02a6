/// What the shaders of a grid may ask of each other, of the attributes and of the options (RISpec 3.2,
/// section 15.8).
#pragma once

#include "core/scene/render_context.h"
#include "shade/vm/context.h"
#include "shade/vm/registers.h"

namespace trapeze {

/// Answers for the run that goes on. Each find() is false for a name that is not known, or known by another
/// type; then the shader's variable keeps its value.
class GridMessages : public vm::Messages {
  public:
    explicit GridMessages(const RenderContext& context) : context_(context) {}

    /// Registers of the shaders that have run on the grid, or run now; null where there is none. They have
    /// the lanes of the run.
    const vm::Registers* surface = nullptr;
    const vm::Registers* displacement = nullptr;
    const vm::Registers* atmosphere = nullptr;
    const Attributes* attributes = nullptr;
    const Primitive* primitive = nullptr;       ///< that the attributes are of; it may be null
    std::span<const ShadingGrid* const> grids;  ///< of the shader that runs; none: it asks for no variables

    bool find(rsl::Op what, std::string_view name, rsl::Type type, const vm::Operand& out,
              std::span<std::string> texts, const vm::Registers* light) override;
    std::string shader_name(std::string_view kind) override;

  private:
    bool find_variable(std::string_view name, rsl::Type type, const vm::Operand& out,
                       std::span<std::string> texts) const;

    const RenderContext& context_;
};

}  // namespace trapeze
