/// What a call of the shading language was given: trace(P, R, "samples", 4, ...).
#pragma once

#include "core/scene/scene.h"
#include "shade/vm/machine.h"

namespace trapeze {

/// A number that a call was given, of a lane.
struct LaneValue {
    const vm::Operand* operand = nullptr;
    float otherwise = 0;

    float at(size_t lane) const { return operand ? vm::Run::at(*operand, 0, lane) : otherwise; }
};

/// A call's arguments; angles in radians, lengths in camera space.
struct RayArguments {
    RayArguments(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);

    V3f from_at(size_t lane) const;  ///< the first point
    V3f towards_at(
        size_t lane) const;  ///< a direction, a normal or the second point; of shadow(), to the light
    int samples_at(size_t lane) const;  ///< at least 1
    /// Of "samplecone", the half angle of the cone over which rays are spread.
    float sample_cone_at(size_t lane) const;
    /// Of "coneangle", the half angle of the part of the sky that is looked at.
    float cone_angle_at(size_t lane) const;
    float max_distance_at(size_t lane) const;  ///< "maxdist"; infinite where there is no bound

    LaneValue bias;                     ///< below 0: not given
    LaneValue falloff, falloff_mode;    ///< of occlusion: by distance; mode 0 exponential, 1 a power
    bool uniform_distribution = false;  ///< else by the cosine
    bool distant_light = false;         ///< of shadow(): the light is nowhere

  private:
    const vm::Operand *from_ = nullptr, *towards_ = nullptr;
    const float* from_light_ = nullptr;  ///< three planes of so many lanes
    size_t lanes_ = 0;
    LaneValue samples_, sample_cone_, cone_angle_, max_distance_;
};

}  // namespace trapeze
