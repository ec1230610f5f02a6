#include "pipeline/rib/ris/ris_light_surfaces.h"

#include "pipeline/rib/ris/ris_parameters.h"
#include "shade/lights/light_area.h"

namespace trapeze::rib {
namespace {

constexpr float kRadius = 0.5f;

Shape quadric(Quadric::Kind kind, const std::array<float, 7>& values, int value_count) {
    Quadric q;
    q.kind = kind;
    q.values = values;
    q.value_count = value_count;
    return {q, {}};
}

std::optional<Shape> shape_of(LightShape::Kind kind) {
    switch (kind) {
        case LightShape::Kind::Rect:
            return Shape{PatchMesh(), {{points_of_square()}}};
        case LightShape::Kind::Disk:
            return quadric(Quadric::Kind::Disk, {0, kRadius, 360}, 3);
        case LightShape::Kind::Sphere:
            return quadric(Quadric::Kind::Sphere, {kRadius, -kRadius, kRadius, 360}, 4);
        case LightShape::Kind::Cylinder:
            return quadric(Quadric::Kind::Cylinder, {kRadius, -0.5f, 0.5f, 360}, 4);
        default:
            return {};
    }
}

}  // namespace

Parameter points_of_square() {
    return {"P",
            {StorageClass::Vertex, ValueType::Point, 1},
            {-kRadius, -kRadius, 0, kRadius, -kRadius, 0, -kRadius, kRadius, 0, kRadius, kRadius, 0},
            {}};
}

std::optional<LightSurface> surface_of(const LightInstance& light) {
    std::optional<Shape> shape = light.shape ? shape_of(light.shape->kind) : std::nullopt;
    if (!shape) return {};
    LightSurface made{std::move(*shape), M44f(), {}};
    if (light.shape->kind == LightShape::Kind::Cylinder)
        made.light_from_shape = M44f(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1);
    const ParameterList& given = light.shader.parameters;
    V3f radiance = triple_or(light.shader, "lightcolor", V3f(1, 1, 1));
    if (given.float_or("normalized", 0) != 0)
        radiance /=
            std::max(static_cast<float>(area_of(light.shape->kind, light.shader.camera_from_shader)), 1e-6f);
    made.shader.name = kLightSurfaceShader;
    made.shader.location = light.shader.location;
    made.shader.camera_from_shader = light.shader.camera_from_shader;
    set_triple(made.shader, "radiance", ValueType::Color, radiance);
    for (const char* name : {"focus", "coneangle", "conesoftness"})
        if (const Parameter* p = given.find(name)) made.shader.parameters.set(*p);
    return made;
}

}  // namespace trapeze::rib
