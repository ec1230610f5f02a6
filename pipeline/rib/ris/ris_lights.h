/// Lights of the path tracer (RIS), as area lights of the shading language [decision 0030]: all are
/// `rislight`, and each has its shape.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/scene/scene.h"
#include "pipeline/rib/ris/ris_parameters.h"

namespace trapeze::rib {

/// Whether a LightSource or AreaLightSource of this name is the path tracer's.
bool is_ris_light(std::string_view shader);

/// `shader` has the name, the place and the space. Not for lights that shine from shapes which are still to
/// come, which mesh_light() is for. `samples`: where the light does not say how many. Null: no light of this
/// name is known.
std::shared_ptr<LightInstance> ris_light(const std::string& handle, const ShaderInstance& shader,
                                         const RisParameters& parameters,
                                         int samples = LightShape::kDefaultSamples);

/// Shines from the geometry that follows it. `is_area_light`: the request was AreaLightSource, whose lights
/// always do.
bool is_mesh_light(std::string_view shader, bool is_area_light);
std::shared_ptr<LightInstance> mesh_light(const std::string& handle, const ShaderInstance& shader,
                                          const RisParameters& parameters,
                                          int samples = LightShape::kDefaultSamples);
/// Tells a mesh light of the first shape that it shines from.
void place_mesh_light(LightInstance& light, const Shape& shape);

/// Geometry "envsphere" and "distantlight": what a mesh light of them shines as. Angle: that which the
/// distant one takes in the sky, in degrees; 0 if unknown. `moving_shape`: camera_from_shape at the keys of
/// LightInstance::moving_space, if it moves. Neither has a place or a size: a dome shines from
/// all around, a direction like the sun.
enum class FarShape { Dome, Direction };
std::shared_ptr<LightInstance> far_light(const LightInstance& light, FarShape shape,
                                         const M44f& camera_from_shape, std::vector<M44f> moving_shape,
                                         float angle);

/// The middle of the box about the shape, in its space.
V3f middle_of(const Shape& shape);

/// A light from the eye along the view, for worlds of Bxdfs that nothing lights.
std::shared_ptr<const LightInstance> headlight();

}  // namespace trapeze::rib
