/// Lights of the path tracer (RIS), as lights of the shading language: `rislight` for those of a shape, whose
/// power comes from their middle, `distantlight` for those far away, and `ambientlight` with two of these for
/// domes.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "pipeline/rib/ris/ris_parameters.h"

namespace trapeze::rib {

/// Whether a LightSource or AreaLightSource of this name is the path tracer's.
bool is_ris_light(std::string_view shader);

/// `shader` has the name, the place and the space. None for lights that shine from shapes which are still to
/// come, which mesh_light() is for.
std::vector<std::shared_ptr<const LightInstance>> ris_lights(const std::string& handle,
                                                             const ShaderInstance& shader,
                                                             const RisParameters& parameters);

/// Shines from the geometry that follows it.
bool is_mesh_light(std::string_view shader, bool is_area_light);
std::shared_ptr<LightInstance> mesh_light(const std::string& handle, const ShaderInstance& shader,
                                          const RisParameters& parameters);
/// Gives a mesh light the shape that it shines from, whose points are in shape space.
void place_mesh_light(LightInstance& light, const Shape& shape, const M44f& camera_from_shape);

/// Geometry "envsphere" and "distantlight": what a mesh light of them shines as. The first is
/// to take the place of `light`. Angle: that which the distant one takes in the sky, in degrees; 0 if
/// unknown.
enum class FarShape { Dome, Direction };
std::vector<std::shared_ptr<LightInstance>> far_lights(const LightInstance& light, FarShape shape,
                                                       const M44f& camera_from_shape, float angle);

/// The middle of the box about the shape, in its space.
V3f middle_of(const Shape& shape);

/// A light from the eye along the view, for worlds of Bxdfs that nothing lights.
std::shared_ptr<const LightInstance> headlight();

}  // namespace trapeze::rib
