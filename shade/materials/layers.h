/// A shader with its layers (ShaderLayer, ConnectShaderLayers): run one after the other, outputs of earlier
/// ones becoming parameters of later ones. Most have one layer and no connections.
#pragma once

#include <vector>

#include "shade/materials/bound_shader.h"

namespace trapeze {

struct LayeredShader {
    /// A parameter or predefined variable of layer `to` takes what layer `from`, which runs before it, has in
    /// one of its own.
    struct Connection {
        size_t from = 0, to = 0;
        rsl::RegisterId source = 0, target = 0;
    };

    std::vector<const BoundShader*> layers;  ///< at least one, in the order they run; the last names it all
    std::vector<Connection> connections;

    const BoundShader& last() const { return *layers.back(); }

    /// Whether a layer may ask for the space named "object".
    bool asks_object_space() const;

    /// Copies what earlier layers have into the variables of layer `to`. registers[i] is layer i's, all of as
    /// many lanes.
    void connect(size_t to, std::span<vm::Registers* const> registers) const;
};

/// The parameters of a layer that connections set: they vary over grids.
std::vector<std::string> connected_parameters(const ShaderInstance& instance, const std::string& layer);

/// Resolves the instance's connections; those that name no layer, no variable or another type are reported
/// and left out. `layers` are bound from instance.earlier_layers, as far as there are such shaders, and
/// instance.
LayeredShader make_layered(const ShaderInstance& instance, std::vector<const BoundShader*> layers,
                           Diagnostics* diagnostics);

}  // namespace trapeze
