/// A shader with the parameter values of one instance of it in a scene.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene/shading_grid.h"
#include "shade/vm/executable.h"
#include "shade/vm/machine.h"

namespace trapeze {

struct ShaderInstance;

/// A shader and the values of its parameters, which are found once for a render. Immutable, so all threads
/// share it.
class BoundShader {
  public:
    /// Values of the instance that do not fit a parameter's type are reported (diagnostics may be null) and
    /// the default holds. Points, vectors, normals and matrices of the instance are in shader space. The
    /// instance must outlive this.
    BoundShader(std::shared_ptr<const vm::Executable> executable, const ShaderInstance& instance,
                const vm::Spaces& spaces, Diagnostics* diagnostics);

    /// Sets the parameters in registers that have been started. A primitive variable of a parameter's name
    /// and type replaces it (RISpec 3.2, section 5), and what a ray has brought along both.
    void set_parameters(vm::Registers& registers, std::span<const ShadingGrid* const> grids) const;

    /// Warns of what rays bring along for a parameter that is of another type.
    void report_sent(const ShadingGrid& grid, Diagnostics& diagnostics) const;

    /// Whether each vertex has a value of its own.
    bool varies(const rsl::ProgramParameter& parameter) const {
        return executable_->places()[parameter.id].kind == vm::Place::Kind::Varying;
    }

    /// Computes the defaults that follow from the point (Executable::has_run_default) of parameters that
    /// nothing else gives, once the registers have their parameters and predefined variables. `given`: those
    /// that have been given another value, as indices of program().parameters.
    Task<> set_run_defaults(vm::Machine& machine, vm::Registers& registers, const vm::Context& context,
                            std::span<const ShadingGrid* const> grids,
                            std::span<const size_t> given = {}) const;

    /// The shader's laid-out code, by which machines know their registers for it.
    const std::shared_ptr<const vm::Executable>& executable() const { return executable_; }
    const rsl::Program& program() const { return executable_->program(); }
    const ShaderInstance& instance() const { return instance_; }

    /// A parameter's value: floats or texts, by its type.
    struct Value {
        std::vector<float> floats;  ///< all elements, each of 1, 3 or 16 components
        std::vector<std::string> texts;
    };
    /// Values of program().parameters, as they hold where no primitive variable replaces them; points,
    /// vectors and normals in camera space.
    const std::vector<Value>& values() const { return values_; }

  private:
    bool take_from_instance(const rsl::ProgramParameter& parameter, Value& value,
                            Diagnostics* diagnostics) const;

    std::shared_ptr<const vm::Executable> executable_;
    const ShaderInstance& instance_;
    std::vector<Value> values_;         ///< of program().parameters
    std::vector<size_t> run_defaults_;  ///< parameters that wait for the run: their values are 0
};

/// Whether a variable of this type can take a primitive variable's values, with as many elements.
bool can_take(const rsl::Type& type, const GridVariable& variable);

/// What stands in place of a parameter of a program's: what a ray has brought along for it, else the
/// primitive variable of its name, if the parameter can take the values and has as many elements; null when
/// there is none.
const GridVariable* suitable_variable(const ShadingGrid& grid, const rsl::Program& program,
                                      const rsl::ProgramParameter& parameter);

}  // namespace trapeze
