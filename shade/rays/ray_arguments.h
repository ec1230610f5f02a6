/// What a call of the shading language was given: trace(P, R, "samples", 4, ...); also a gather block.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/scene.h"
#include "shade/rays/sent_values.h"
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
    /// "samples", or "minsamples" where that is more; at least 1, of gather() 0 where it asks for less.
    int samples_at(size_t lane) const;
    /// Of "samplecone", or "blur" without it, the half angle of the cone over which rays are spread.
    float sample_cone_at(size_t lane) const;
    /// Of "coneangle", the half angle of the part of the sky that is looked at; of gather() the angle that it
    /// is given.
    float cone_angle_at(size_t lane) const;
    float max_distance_at(size_t lane) const;  ///< "maxdist"; infinite where there is no bound
    /// How much a hit at a distance counts for occlusion().
    float falloff_at(float distance, size_t lane) const;
    RayFilter::Sides sides() const { return filter_.sides; }  ///< "hitsides"
    /// Of "hitsides", "subset" and "excludesubset"; null where all hits count.
    const RayFilter* only() const { return filters_ ? &filter_ : nullptr; }
    /// The first argument, if it is a text: a map, a category.
    std::string_view map() const { return map_; }

    LaneValue bias;                   ///< below 0: not given
    LaneValue falloff, falloff_mode;  ///< of occlusion: by distance; mode 0 exponential, 1 a power
    LaneValue sample_base;            ///< "samplebase": the part of a micropolygon from which rays begin
    LaneValue point_based;            ///< not 0: discs of a cloud are asked, not rays
    LaneValue max_solid_angle, clamp;
    std::string cloud, cloud_space = "world";  ///< "filename", "coordsystem"
    /// "distribution": all directions alike, or by the cosine.
    bool uniform_distribution = false;
    bool distant_light = false;                      ///< of shadow(): the light is nowhere
    int channel = 0;                                 ///< of environment() as a float
    std::string label;                               ///< "label", of the rays
    std::optional<V3f> opaque;                       ///< "othreshold", of the first lane
    std::optional<RayAttributes::HitMode> hit_mode;  ///< "hitmode"
    std::string environment_map, environment_space = "world";
    /// What is set besides the result, by name: "environmentdir".
    struct Output {
        std::string_view name;
        const vm::Operand* operand;
    };
    std::vector<Output> outputs;
    bool sets(std::string_view name) const;  ///< whether it is one of the outputs
    SentValues sent;                         ///< of gather(): "send:surface:NAME"

  private:
    void take_text(std::string_view name, const std::string& text);

    const vm::Operand *from_ = nullptr, *towards_ = nullptr;
    const float* from_light_ = nullptr;  ///< three planes of so many lanes
    size_t lanes_ = 0;
    int least_samples_ = 1;
    std::string_view map_;
    RayFilter filter_;
    bool filters_ = false;
    LaneValue samples_, min_samples_, sample_cone_, blur_, cone_angle_, max_distance_;
};

}  // namespace trapeze
