/// What the camera sees of the path tracer's lights (RIS): their shapes, as bright as what they light takes
/// them for.
#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace trapeze::rib {

/// The surface shader of such shapes.
inline constexpr const char* kLightSurfaceShader = "rislightsurface";

/// "P" of a bilinear patch that is the path tracer's rectangular light: a square of width 1 about the origin,
/// whose normal is +z.
Parameter points_of_square();

/// A shape that is to be placed, and how.
struct LightSurface {
    Shape shape;
    M44f light_from_shape;  ///< a Cylinder of RISpec stands along z
    ShaderInstance shader;
};

/// Of a light of a simple shape, whose space at shutter open is that of its shader; nothing of others: meshes
/// are in the scene themselves, and what is in the sky is nowhere. In an object it is as bright as where the
/// object is defined.
std::optional<LightSurface> surface_of(const LightInstance& light);

}  // namespace trapeze::rib
