/// What gather() sends along with its rays to the shaders that they meet: "send:surface:NAME".
#pragma once

#include <span>
#include <vector>

#include "core/scene/shading_grid.h"
#include "shade/vm/machine.h"

namespace trapeze {

/// The values of one block. Texts are those of its beginning; numbers are read from the operands.
class SentValues {
  public:
    /// Takes a value whose name is an operand of the step. False where the name sends none.
    bool add(vm::Run& run, const vm::Step& step, size_t operand, std::span<const vm::Operand> operands);

    /// With planes of one number each, which mean nothing.
    std::span<const SentVariable> variables() const { return variables_; }
    size_t size() const { return planes_.size(); }  ///< numbers of all planes together
    /// Appends the numbers of a lane.
    void append(size_t lane, std::vector<float>& numbers) const;

  private:
    struct Plane {
        const float* data;
        size_t lane_mask;
    };
    std::vector<SentVariable> variables_;
    std::vector<Plane> planes_;  ///< of one variable after the other
};

}  // namespace trapeze
