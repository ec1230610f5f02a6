/// One call of texture3d(): its arguments, and what it finds at each lane.
#pragma once

#include <span>
#include <vector>

#include "shade/clouds/cloud_library.h"
#include "shade/vm/machine.h"

namespace trapeze {

class LookUpCall {
  public:
    /// Reports, by the run, what is wrong with the arguments. Without a library nothing is found.
    LookUpCall(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands,
               CloudLibrary* library);

    /// Sets the result and the variables of the lanes that run; `shares` is memory.
    void run(std::vector<CloudShare>& shares) const;

  private:
    /// A variable that is set, and the channel that it is set from.
    struct Output {
        const vm::Operand* operand;
        ChannelType type;
        size_t first;  ///< of its floats among a point's
    };
    void find_outputs(size_t named);
    void take_named(size_t i);
    void set_space(const std::string& space);
    void set(size_t lane, const std::vector<CloudShare>& shares) const;
    V3f back(ChannelType type, const V3f& value) const;

    vm::Run& run_;
    const vm::Step& step_;
    std::span<const vm::Operand> operands_;
    const LoadedCloud* cloud_ = nullptr;
    const vm::Operand *P_, *N_;
    const vm::Operand *radius_ = nullptr, *scale_ = nullptr;
    std::vector<Output> outputs_;
    bool moved_ = false;  ///< the cloud's space is another than the current one
    M44f to_space_, from_space_, normals_to_space_, normals_from_space_;
};

}  // namespace trapeze
