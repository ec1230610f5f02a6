/// A shader with its layers (ShaderLayer, ConnectShaderLayers): run one after the other, outputs of earlier
/// ones becoming parameters of later ones. Most have one layer and no connections.
#pragma once

#include <vector>

#include "shade/materials/bound_shader.h"

namespace trapeze {

struct LayeredShader {
    /// One variable handed on: layer `to` takes the value that layer `from`, which runs before it, has in a
    /// variable of its own. Both are parameters or predefined variables.
    struct Connection {
        size_t from = 0, to = 0;                 ///< indices into layers
        rsl::RegisterId source = 0, target = 0;  ///< registers of the two programs
    };

    std::vector<const BoundShader*> layers;  ///< at least one, in the order they run; the last names it all
    std::vector<Connection> connections;

    const BoundShader& last() const { return *layers.back(); }

    /// Whether a layer asks for variables of the primitive by name, or may ask for the space named "object":
    /// grids of different primitives do not share these.
    bool asks_primitive() const;
    /// Whether a layer asks for values of the volume in front of the surface: by atmosphere() or incident().
    bool asks_volume() const;

    /// Copies what earlier layers have into the variables of layer `to`. registers[i] is layer i's, all of as
    /// many lanes.
    void connect(size_t to, std::span<vm::Registers* const> registers) const;
};

/// Whether a program asks for variables of the primitive by name: getvar().
bool asks_variables(const rsl::Program& program);

/// Names of a layer's parameters that connections set. They vary over grids, whatever the shader declares.
std::vector<std::string> connected_parameters(const ShaderInstance& instance, const std::string& layer);

/// Resolves the instance's connections; those that name no layer, no variable or another type are reported
/// and left out. `layers` are bound from instance.earlier_layers, as far as there are such shaders, and
/// instance.
LayeredShader make_layered(const ShaderInstance& instance, std::vector<const BoundShader*> layers,
                           Diagnostics* diagnostics);

}  // namespace trapeze
