/// Makes what chooses points on the shapes of a scene's area lights [decision 0030].
#pragma once

#include "core/diagnostics.h"
#include "core/scene/light_shape.h"
#include "core/scene/render_context.h"
#include "shade/lights/light_sampler.h"
#include "shade/maps/textures.h"
#include "shade/materials/material.h"

namespace trapeze {

/// Whether the light shines from primitives of the scene.
bool is_mesh_light(const Lamp& lamp);

/// Of all area lights but those of meshes. Those without an area are dark, with a warning.
void make_samplers(Materials& materials, Textures& textures, const RenderContext& context);

/// Of those of meshes; diagnostics may be null.
void make_mesh_samplers(Materials& materials, const LightMeshes& meshes, Diagnostics* diagnostics);

}  // namespace trapeze
