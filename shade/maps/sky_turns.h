/// The turns of gather("environment:MAP", ...): parts of the map, one after the other. No ray is sent.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "shade/maps/sky_parts.h"
#include "shade/vm/machine.h"

namespace trapeze {

/// One such block that is being run, in one thread. The operands must outlive it.
class SkyTurns final : public vm::GatherTurns {
  public:
    /// `seed`: of the render.
    SkyTurns(std::shared_ptr<const SkyParts> parts, vm::Run& run, const vm::Step& step,
             std::span<const vm::Operand> operands, uint32_t seed);

    Task<bool> next(vm::Run& run, const uint32_t* live) override;
    const float* hits() const override { return hits_.data(); }
    const float* misses() const override { return misses_.data(); }

  private:
    enum class From : uint8_t { Color, Direction, SolidAngle, RayDirection, RayOrigin, RayLength };
    struct Output {
        From from;
        vm::Operand operand;
    };
    struct Lane {
        size_t lane = 0;
        int samples = 0;
        uint32_t seed = 0;
    };
    void add_lane(size_t lane, uint32_t seed, const vm::Operand& samples);
    void tell(const Lane& lane, const SkyParts::Part& part) const;

    std::shared_ptr<const SkyParts> parts_;
    vm::Operand P_;
    std::vector<Output> outputs_;
    std::vector<Lane> lanes_;
    int turn_ = 0, most_ = 0;
    std::vector<float> hits_, misses_;
};

}  // namespace trapeze
