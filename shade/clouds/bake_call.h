/// One call of bake3d(): its arguments, and the points that it makes of a grid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shade/clouds/cloud_bakes.h"
#include "shade/vm/machine.h"

namespace trapeze {

class BakeCall {
  public:
    /// Reports, by the run, what is wrong with the arguments.
    BakeCall(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);

    /// The points of the lanes of a grid that run: a vertex each, or with "interpolate" a micropolygon each
    /// whose corners all run.
    BakedCall points_of(const vm::GridSpan& span) const;

  private:
    /// Values that are baked, and how they come to the space of the file.
    struct Value {
        CloudChannel channel;
        const vm::Operand* operand;
    };
    /// All numbers of a point, as BakedCall has them.
    using Numbers = std::vector<float>;

    void take_named(vm::Run& run, size_t i);
    void take_value(vm::Run& run, const std::string& name, const std::string& type,
                    const vm::Operand& operand);
    void choose_channels(vm::Run& run, const std::string& wanted);
    void set_space(vm::Run& run, const std::string& space);
    bool runs(size_t lane) const;
    V3f position(size_t lane) const;
    void take_numbers(size_t lane, float area, Numbers& numbers) const;
    std::vector<float> areas_of(const vm::GridSpan& span, std::vector<float>& of_vertices) const;
    void bake_vertices(const vm::GridSpan& span, BakedCall& baked) const;
    void bake_micropolygons(const vm::GridSpan& span, BakedCall& baked) const;
    static void add(Numbers numbers, BakedCall& baked);

    const vm::Step& step_;
    std::span<const vm::Operand> operands_;
    const vm::Operand *P_, *N_;
    const vm::Operand *radius_ = nullptr, *radius_scale_ = nullptr;
    const uint32_t* mask_ = nullptr;  ///< null: all lanes run
    std::string file_;
    bool interpolate_ = false, ascii_ = false;
    std::vector<Value> values_;
    std::optional<M44f> to_space_, normals_to_space_;  ///< nothing: they stay as they are
};

}  // namespace trapeze
