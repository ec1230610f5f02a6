/// What the frame must know of shaders before it traces rays for them.
#pragma once

#include <set>
#include <string>

#include "shade/materials/bound_shader.h"

namespace trapeze {

/// Whether the shader may trace rays, with the parameters that it has; those in `varied` may have any values.
/// Without it, that holds for all. `given_traced_map`: others may give it the name of rays for that of a map.
bool asks_for_rays(const BoundShader& shader, const std::set<std::string>* varied = nullptr,
                   bool given_traced_map = false);

/// Whether the shader knows the name by which rays are asked in place of a map.
bool knows_traced_map(const BoundShader& shader);

/// Whether all calls of the shader that may trace ask files of point clouds (occlusion(), "pointbased"), or
/// maps (indirectdiffuse()).
bool asks_clouds_alone(const BoundShader& shader);

/// Whether a surface shader makes another opacity than Os, which is the primitive's own.
bool changes_opacity(const rsl::Program& program);
/// Whether a surface that is opaque when a program begins is so when it ends: it sets Oi to nothing but Os
/// or 1.
bool keeps_opaque(const rsl::Program& program);
/// Whether what a vertex is told, by rays or by lights that ask for them, stays with the vertex: nothing that
/// looks at neighbours follows from it, nor which way the program goes, nor the opacity. Then the vertices
/// whose colour nobody wants need not be told.
bool keeps_answers_apart(const rsl::Program& program);
/// Whether a program says or writes anything besides its outputs.
bool leaves_traces(const rsl::Program& program);

}  // namespace trapeze
