/// Samples of area lights: for each vertex of a batch of grids a place of a light's shape, and how the
/// surface lies when light comes from there [decision 0030].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/motion_turn.h"
#include "core/scene/vertex_motion.h"
#include "shade/materials/lamp.h"
#include "shade/vm/machine.h"

namespace trapeze {

/// From the eye to a point that the camera sees.
inline V3f eye_way(const vm::Context& surroundings, const V3f& point) {
    return surroundings.perspective ? point : V3f(0, 0, point.z);
}

/// Of one light at a time. One per thread.
class AreaSamples {
  public:
    /// As LightRig::start() has it. All must outlive the use.
    void start(const vm::Context& surroundings, size_t lanes, const Plane3& N, uint32_t seed,
               std::span<const M44f> held);

    /// One of a number of samples of the lamp with a number.
    struct Turn {
        uint32_t lamp = 0;    ///< of those that are run
        uint32_t number = 0;  ///< of all that light the surface
        int sample = 0, samples = 1;
    };
    /// Chooses a place of the light's shape for each vertex. Random numbers follow from the vertex and the
    /// lamp [decision 0019]: a vertex' places are well apart, and those of vertices have nothing in common.
    /// Returns when each is taken, where the light moves or rays have times of their own; else nothing.
    std::vector<float> take(const Turn& turn, const Lamp& lamp, const vm::Operand& P);
    /// Tells the light's shader what was taken: P, N and Ng are the sample's, and so are u, v, s, t, dPdu and
    /// dPdv of meshes; "__solidangle", "__radiance" and
    /// "__area" are what it stands for.
    void tell(const Lamp& lamp, vm::Registers& registers) const;
    /// Turns the ways to what was taken back to how surfaces lie as they are shaded; `L`: 3 planes.
    void turn_back(float* L) const;

  private:
    VertexMotion motion_of(const vm::GridSpan& span, size_t vertex) const;

    const vm::Context* surroundings_ = nullptr;
    size_t lanes_ = 0;
    Plane3 N_;
    uint32_t seed_ = 0;
    std::span<const M44f> held_;
    bool has_times_ = false;                 ///< some surface's rays have times of their own
    std::vector<MotionTurn> surface_turns_;  ///< of each grid, where it has
    std::vector<float> samples_;             ///< places, normals, radiances, solid angles and areas
    std::vector<float> turned_;              ///< the time at which a vertex' surface lies as it was sampled
};

}  // namespace trapeze
