#include "pipeline/rib/ris/ris_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"

namespace trapeze::rib {
namespace {

/// A dome's light comes from everywhere; what is under something, or behind, has less of it. Without rays
/// this is what tells forms apart: parts of the power that are ambient, from above and from the eye.
constexpr float kDomeAmbient = 0.3f, kDomeAbove = 0.3f, kDomeEye = 0.4f;

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

/// Radiance that a light's colour, intensity and exposure (stops: powers of 2) make.
V3f power(const RisParameters& p, float default_intensity = 1) {
    const float scale = p.number_or("intensity", default_intensity) *
                        portable::exp2(std::clamp(p.number_or("exposure", 0), -64.0f, 64.0f));
    V3f color(1, 1, 1);
    for (const char* name : {"lightColor", "envTint", "skyTint", "lightcolor"})
        if (const auto given = p.color(name)) color = *given;
    return color * (std::isfinite(scale) ? scale : 1.0f);
}

/// A light of RSL at the place and in the space of `from`, with its radiance as "lightcolor".
std::shared_ptr<LightInstance> make(const std::string& handle, const ShaderInstance& from, const char* name,
                                    const V3f& radiance) {
    auto light = std::make_shared<LightInstance>();
    light->handle = handle;
    light->shader.name = name;
    light->shader.location = from.location;
    light->shader.camera_from_shader = from.camera_from_shader;
    set_triple(light->shader, "lightcolor", ValueType::Color, radiance);
    return light;
}

/// A light from infinitely far, which shines along `direction` of its space.
std::shared_ptr<LightInstance> distant(const std::string& handle, const ShaderInstance& from,
                                       const V3f& radiance, const V3f& direction) {
    auto light = make(handle, from, "distantlight", radiance);
    set_triple(light->shader, "from", ValueType::Point, V3f(0, 0, 0));
    set_triple(light->shader, "to", ValueType::Point, direction);
    return light;
}

/// What a disk in the sky lights: a face turned to it is as bright as the disk times sin^2 of half the angle
/// that it takes.
float share_of_disk(float angle) {
    const float sine = portable::sin(std::clamp(angle, 0.0f, 180.0f) * (std::numbers::pi_v<float> / 360));
    return sine * sine;
}

/// Ten over a disk as small as the sun are not seen at all: they are from those who took it for the
/// brightness of what is lit.
bool is_brightness(const V3f& radiance) {
    return std::max({radiance.x, radiance.y, radiance.z}) <= 10;
}

/// A distant light is a disk as wide as the sun unless told, and its intensity is the radiance of the disk.
/// That of normalized ones does not change with the angle (taken as: is the sun's).
V3f power_of_disk(const RisParameters& p) {
    constexpr float kSunAngle = 0.53f, kSunIntensity = 50000;
    const V3f radiance = power(p, kSunIntensity);
    const float given = p.number_or("angleExtent", -1);
    if (given < 0 && is_brightness(radiance)) return radiance;
    const bool is_suns = given < 0 || p.number_or("areaNormalize", 0) != 0;
    return radiance * share_of_disk(is_suns ? kSunAngle : given);
}

/// Three lights: from all sides, from above, and from the eye (kDomeAmbient and the like).
std::vector<std::shared_ptr<LightInstance>> dome(const std::string& handle, const ShaderInstance& from,
                                                 const V3f& radiance) {
    ShaderInstance eye = from;
    eye.camera_from_shader = M44f();
    return {make(handle, from, "ambientlight", radiance * kDomeAmbient),
            distant(handle, from, radiance * kDomeAbove, V3f(0, 0, -1)),  // domes have their zenith at +z
            distant(handle, eye, radiance * kDomeEye, V3f(0, 0, 1))};
}

/// A `rislight`, whose normalized form does not shine more when it is larger.
std::shared_ptr<LightInstance> of_shape(const std::string& handle, const ShaderInstance& from,
                                        const RisParameters& p, const char* shape) {
    auto light = make(handle, from, "rislight", power(p));
    set_text(light->shader, "shape", shape);
    // The lights of the first versions (PxrStd...) are normalized in any case.
    const bool is_normalized = contains(from.name, "PxrStd") || p.number_or("areaNormalize", 0) != 0;
    set_number(light->shader, "normalized", is_normalized ? 1.0f : 0.0f);
    set_number(light->shader, "focus", std::clamp(p.number_or("emissionFocus", 0), 0.0f, 100.0f));
    set_number(light->shader, "coneangle", std::clamp(p.number_or("coneAngle", 90), 0.0f, 180.0f));
    set_number(light->shader, "conesoftness", std::clamp(p.number_or("coneSoftness", 0), 0.0f, 1.0f));
    return light;
}

/// A box about a shape, in object space.
struct Box {
    V3f low{0, 0, 0}, high{0, 0, 0};
};

/// Whole quadrics about z, but for hyperboloids and paraboloids, of which the first number is taken as a
/// radius.
Box box_of(const Quadric& q) {
    const auto& v = q.values;
    switch (q.kind) {
        case Quadric::Kind::Cylinder:
            return {V3f(-v[0], -v[0], v[1]), V3f(v[0], v[0], v[2])};
        case Quadric::Kind::Cone:
            return {V3f(-v[1], -v[1], 0), V3f(v[1], v[1], v[0])};
        case Quadric::Kind::Disk:
            return {V3f(-v[1], -v[1], v[0]), V3f(v[1], v[1], v[0])};
        case Quadric::Kind::Torus: {
            const float r = std::abs(v[0]) + std::abs(v[1]);
            return {V3f(-r, -r, -v[1]), V3f(r, r, v[1])};
        }
        default: {
            const float r = std::abs(v[0]);
            return {V3f(-r, -r, -r), V3f(r, r, r)};
        }
    }
}

Box box_of(const Shape& shape) {
    if (const auto* quadric = std::get_if<Quadric>(&shape.topology)) return box_of(*quadric);
    const Parameter* points = shape.variables.find("P");
    if (!points || points->floats.size() < 3) return {};
    Box box{V3f(kInfinity), V3f(-kInfinity)};
    for (size_t i = 0; i + 2 < points->floats.size(); i += 3)
        for (int axis = 0; axis < 3; ++axis) {
            const float x = points->floats[i + static_cast<size_t>(axis)];
            box.low[axis] = std::min(box.low[axis], x);
            box.high[axis] = std::max(box.high[axis], x);
        }
    return box;
}

}  // namespace

/// By the prefix of RIS's own plugins, with or without a folder before it.
bool is_ris_light(std::string_view shader) {
    const size_t slash = shader.find_last_of("/\\");
    const std::string_view name = slash == std::string_view::npos ? shader : shader.substr(slash + 1);
    return name.starts_with("Pxr");
}

/// PxrMeshLight, and area lights of the first versions, which have no shape of their own.
bool is_mesh_light(std::string_view shader, bool is_area_light) {
    if (contains(shader, "MeshLight")) return true;
    return is_area_light && contains(shader, "AreaLight");
}

std::shared_ptr<LightInstance> mesh_light(const std::string& handle, const ShaderInstance& shader,
                                          const RisParameters& parameters) {
    return of_shape(handle, shader, parameters, "sphere");
}

/// A flat shape shines from a rectangle, to both sides; others from a ball that fills their box.
void place_mesh_light(LightInstance& light, const Shape& shape, const M44f& camera_from_shape) {
    const Box box = box_of(shape);
    const V3f size = box.high - box.low, middle = (box.low + box.high) * 0.5f;
    int thin = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (size[axis] < size[thin]) thin = axis;
    const bool is_flat = size[thin] <= 0.01f * std::max({size.x, size.y, size.z});
    // Its z axis is the thin one; the other two have the lengths of the box.
    M44f box_axes;
    for (int row = 0; row < 3; ++row) {
        const int axis = (thin + 1 + row) % 3;
        for (int column = 0; column < 3; ++column) box_axes[row][column] = 0;
        box_axes[row][axis] = row == 2 && is_flat ? 1 : size[axis];
    }
    for (int column = 0; column < 3; ++column) box_axes[3][column] = middle[column];
    light.shader.camera_from_shader = box_axes * camera_from_shape;
    if (!is_flat) return;
    set_text(light.shader, "shape", "rect");
    set_number(light.shader, "twosided", 1);
}

std::vector<std::shared_ptr<LightInstance>> far_lights(const LightInstance& light, FarShape shape,
                                                       const M44f& camera_from_shape, float angle) {
    ShaderInstance from = light.shader;
    from.camera_from_shader = camera_from_shape;
    const Parameter* color = from.parameters.find("lightcolor");
    const V3f radiance = color && color->floats.size() == 3
                             ? V3f(color->floats[0], color->floats[1], color->floats[2])
                             : V3f(1, 1, 1);
    if (shape == FarShape::Dome) return dome(light.handle, from, radiance);
    // Exporters for Maya and Blender, whose suns shine along -z, write their matrices as they are. Not so
    // those of the later PxrDistantLight: it shines along +z.
    const float share = angle > 0 && !is_brightness(radiance) ? share_of_disk(angle) : 1;
    return {distant(light.handle, from, radiance * share, V3f(0, 0, -1))};
}

/// The place of a light that is a point here: the middle of its shape.
V3f middle_of(const Shape& shape) {
    const Box box = box_of(shape);
    return (box.low + box.high) * 0.5f;
}

std::vector<std::shared_ptr<const LightInstance>> ris_lights(const std::string& handle,
                                                             const ShaderInstance& shader,
                                                             const RisParameters& p) {
    const std::string_view name = shader.name;
    if (contains(name, "Distant")) return {distant(handle, shader, power_of_disk(p), V3f(0, 0, 1))};
    if (contains(name, "Dome") || contains(name, "Env")) {
        const auto lights = dome(handle, shader, power(p));
        return {lights.begin(), lights.end()};
    }
    const char* const shape = contains(name, "Rect") || contains(name, "Portal") ? "rect"
                              : contains(name, "Disk")                           ? "disk"
                                                                                 : "sphere";
    return {of_shape(handle, shader, p, shape)};
}

std::shared_ptr<const LightInstance> headlight() {
    return distant({}, {}, V3f(1, 1, 1), V3f(0, 0, 1));
}

}  // namespace trapeze::rib
