/// The shading language's texture(), environment(), shadow(), bump() and textureinfo() over a render's
/// Textures.
#pragma once

#include "core/scene/scene.h"
#include "shade/maps/textures.h"
#include "shade/vm/context.h"

namespace trapeze {

/// Carries out the calls of one grid's shaders, in one thread. All it refers to must outlive it.
class MapService : public vm::Maps {
  public:
    /// `seed`: of the render.
    MapService(Textures& textures, const Scene& scene, uint32_t seed = 0)
        : textures_(textures), scene_(scene), seed_(seed) {}

    void look_up(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) override;
    void sky(std::string_view name, SourceLocation at, std::span<const V3f> directions,
             std::span<const float> widths, std::span<V3f> colors) override;
    std::unique_ptr<vm::GatherTurns> gather_sky(std::string_view name, vm::Run& run, const vm::Step& step,
                                                std::span<const vm::Operand> operands) override;

  private:
    const Textures::Picture* picture_of(vm::Run& run, const vm::Step& step, bool of_color);
    void texture(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);
    void environment(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);
    void shadow(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);
    void bump(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);
    void texture_info(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);

    Textures& textures_;
    const Scene& scene_;
    uint32_t seed_;
};

}  // namespace trapeze
