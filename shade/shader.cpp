#include "shade/shader.h"

namespace trapeze {
namespace {

const GridVariable* variable_of_type(const ShadingGrid& grid, std::string_view name, int floats,
                                     std::initializer_list<ValueType> types) {
    const GridVariable* variable = grid.find(name);
    if (!variable || variable->declaration.floats_per_item() != floats) return nullptr;
    if (variable->planes.size() != static_cast<size_t>(floats)) return nullptr;
    for (const std::vector<float>& plane : variable->planes)
        if (plane.empty()) return nullptr;
    for (ValueType type : types)
        if (variable->declaration.type == type) return variable;
    return nullptr;
}

}  // namespace

ConstPlane3 ShaderInput::load_triples(const std::array<std::span<const float>, 3>& values) {
    const Plane3 planes = pool_.take3();
    for (int k = 0; k < 3; ++k) load(values[k], vertices(), planes[k]);
    return planes;
}

ConstPlane3 ShaderInput::loaded(Variable variable, const Triples& values) {
    if (!planes_[variable]) planes_[variable] = load_triples({values.c[0], values.c[1], values.c[2]});
    return *planes_[variable];
}

ConstPlane3 ShaderInput::I() {
    if (camera_.perspective) return P();
    if (!planes_[kI]) {
        const Plane3 along = pool_.take3();
        fill(0, along.x), fill(0, along.y), fill(1, along.z);
        planes_[kI] = along;
    }
    return *planes_[kI];
}

ConstPlane ShaderInput::value(const FloatParameter& parameter) {
    const Plane plane = pool_.take();
    const GridVariable* variable =
        variable_of_type(grid_, parameter.name, 1, {ValueType::Float, ValueType::Integer});
    if (!variable)
        fill(parameter.value, plane);
    else
        load(variable->planes[0], variable->uniform ? 1 : vertices(), plane);
    return plane;
}

ConstPlane3 ShaderInput::value(const ColorParameter& parameter) {
    const Plane3 planes = pool_.take3();
    const GridVariable* variable = variable_of_type(grid_, parameter.name, 3, {ValueType::Color});
    for (int k = 0; k < 3; ++k) {
        if (!variable)
            fill(parameter.value[k], planes[k]);
        else
            load(variable->planes[k], variable->uniform ? 1 : vertices(), planes[k]);
    }
    return planes;
}

std::string_view ShaderInput::value(const StringParameter& parameter) const {
    const GridVariable* variable = grid_.find(parameter.name);
    return variable && !variable->strings.empty() ? std::string_view(variable->strings.front())
                                                  : std::string_view(parameter.value);
}

const std::vector<Illumination::Arriving>& Illumination::arriving() {
    if (evaluated_) return arriving_;
    evaluated_ = true;
    arriving_.reserve(lights_.size());
    for (const LightShader* shader : lights_) {
        LightShader::Light light;
        if (!shader->is_ambient()) light.L = pool_.take3(), light.direction = pool_.take3();
        light.Cl = pool_.take3();
        shader->illuminate(P_, light);
        arriving_.push_back({shader->is_ambient(), light.L, light.direction, light.Cl});
    }
    return arriving_;
}

}  // namespace trapeze
