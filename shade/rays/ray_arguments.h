/// What a call of the shading language was given: trace(P, R, "samples", 4, ...); also a gather block.
#pragma once

#include <optional>
#include <string_view>

#include "core/scene/scene.h"
#include "shade/vm/machine.h"

namespace trapeze {

/// A number that a call was given, of a lane.
struct LaneValue {
    const vm::Operand* operand = nullptr;
    float otherwise = 0;

    float at(size_t lane) const { return operand ? vm::Run::at(*operand, 0, lane) : otherwise; }
};

/// A call's arguments; angles in radians, lengths in camera space. They are the operands' values, as long as
/// these stay.
struct RayArguments {
    RayArguments(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands);

    V3f from_at(size_t lane) const;  ///< the first point
    V3f towards_at(
        size_t lane) const;  ///< a direction, a normal or the second point; of shadow(), to the light
    int samples_at(size_t lane) const;  ///< at least 1; of gather() 0 where it asks for less
    /// Of "samplecone", the half angle of the cone over which rays are spread.
    float sample_cone_at(size_t lane) const;
    /// Of "coneangle", the half angle of the part of the sky that is looked at; of gather() the angle that it
    /// is given.
    float cone_angle_at(size_t lane) const;
    float max_distance_at(size_t lane) const;  ///< "maxdist"; infinite where there is no bound

    LaneValue bias;                   ///< below 0: not given
    LaneValue falloff, falloff_mode;  ///< of occlusion: by distance; mode 0 exponential, 1 a power
    /// "distribution": all directions alike, or by the cosine.
    bool uniform_distribution = false;
    bool distant_light = false;  ///< of shadow(): the light is nowhere
    std::string_view label;      ///< "label", of the rays
    std::optional<V3f> opaque;   ///< "othreshold", of the first lane

  private:
    void take_text(std::string_view name, std::string_view text);

    const vm::Operand *from_ = nullptr, *towards_ = nullptr;
    const float* from_light_ = nullptr;  ///< three planes of so many lanes
    size_t lanes_ = 0;
    int least_samples_ = 1;
    LaneValue samples_, sample_cone_, cone_angle_, max_distance_;
};

}  // namespace trapeze
