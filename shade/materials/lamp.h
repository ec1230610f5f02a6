/// A light of the scene, with what its shader needs.
#pragma once

#include <memory>
#include <vector>

#include "core/scene/light_shape.h"
#include "shade/lights/light_sampler.h"
#include "shade/materials/bound_shader.h"
#include "shade/materials/scene_spaces.h"

namespace trapeze {

/// A light of the scene, ready to run.
struct Lamp {
    std::unique_ptr<SceneSpaces> spaces;  ///< spaces by name, as the light's shader sees them
    std::unique_ptr<BoundShader> shader;
    /// The same with varying parameters where illuminance of any shader of the scene may send values for
    /// them ("send:light:NAME"); null where there are none.
    std::unique_ptr<BoundShader> told;
    V3f position;                 ///< the origin of its shader space, in camera space: P of the light shader
    bool asks_surface = false;    ///< by surface(): for variables of the surface that it shines on
    bool asks_variables = false;  ///< for those of the primitive that it shines on
    bool asks_place = false;      ///< where on the surface of an area light its point is (LightMesh::places)
    /// What it shines from, where its shader asks for points of that; else null.
    const LightInstance* area = nullptr;
    /// Of that: at shutter open, and of a light that moves in the middles of equal parts of the shutter, too
    /// (middle_of_part()). Null where it is nothing: the light is dark then.
    std::vector<std::unique_ptr<LightSampler>> samplers;

    bool moves() const { return samplers.size() > 1; }
    /// The nearest time at which its sampler has the light just where rays meet it; 0, shutter open, is one.
    float time_near(float time) const;
    const LightSampler* sampler_at(float time) const;
    size_t parts() const { return samplers.size() - 1; }

    /// How often the light's shader is run for a point, each time from another place.
    int turns() const;
};

}  // namespace trapeze
