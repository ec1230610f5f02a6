#include "pipeline/rib/ris/ris_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/portable_math.h"
#include "core/scene/light_groups.h"

namespace trapeze::rib {
namespace {

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

/// Radiance that a light's colour, intensity and exposure (stops: powers of 2) make. The exposure is clamped
/// so that a damaged one makes a very bright light and not an infinite one.
V3f power(const RisParameters& p, float default_intensity = 1) {
    const float scale = p.number_or("intensity", default_intensity) *
                        portable::exp2(std::clamp(p.number_or("exposure", 0), -64.0f, 64.0f));
    V3f color(1, 1, 1);
    for (const char* name : {"lightColor", "envTint", "skyTint", "lightcolor"})
        if (const auto given = p.color(name)) color = *given;
    return color * (std::isfinite(scale) ? scale : 1.0f);
}

/// A light at the place and in the space of `from`, with its radiance as "lightcolor".
std::shared_ptr<LightInstance> make(const std::string& handle, const ShaderInstance& from,
                                    const V3f& radiance, LightShape::Kind kind, int samples) {
    auto light = std::make_shared<LightInstance>();
    light->handle = handle;
    light->shader.name = "rislight";
    light->shader.location = from.location;
    light->shader.camera_from_shader = from.camera_from_shader;
    set_triple(light->shader, "lightcolor", ValueType::Color, radiance);
    light->shape.emplace();
    light->shape->kind = kind;
    light->shape->samples = samples;
    if (kind == LightShape::Kind::Distant || kind == LightShape::Kind::Dome)
        set_number(light->shader, "isdistant", 1);
    return light;
}

/// How many samples the light asks for, 0 being as many as the renderer likes, whether it has shadows, and
/// its group.
void set_sampling(LightInstance& light, const RisParameters& p) {
    const float samples = p.number_or("fixedSampleCount", 0);
    if (samples >= 1)
        light.shape->samples =
            static_cast<int>(std::min(samples, static_cast<float>(LightShape::kMostSamples)));
    if (p.number_or("enableShadows", 1) == 0 || p.number_or("traceShadows", 1) == 0)
        set_number(light.shader, "traceshadows", 0);
    if (const auto color = p.color("shadowColor"))
        set_triple(light.shader, "shadowcolor", ValueType::Color, *color);
    if (std::string group = p.text("lightGroup"); !group.empty())
        set_text(light.shader, kLightGroupParameter, std::move(group));
}

constexpr float kSunAngle = 0.53f;  ///< that it takes in the sky, degrees

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
    constexpr float kSunIntensity = 50000;
    const V3f radiance = power(p, kSunIntensity);
    const float given = p.number_or("angleExtent", -1);
    if (given < 0 && is_brightness(radiance)) return radiance;
    const bool is_suns = given < 0 || p.number_or("areaNormalize", 0) != 0;
    return radiance * share_of_disk(is_suns ? kSunAngle : given);
}

/// The half angle, in radians, of a disk that takes so many degrees of the sky.
float half_angle(float degrees) {
    return std::clamp(degrees, 0.0f, 180.0f) * (std::numbers::pi_v<float> / 360);
}

/// A light near by, whose normalized form does not shine more when it is larger. Numbers are clamped to what
/// the shader can work with: they come from files of other programs.
std::shared_ptr<LightInstance> of_shape(const std::string& handle, const ShaderInstance& from,
                                        const RisParameters& p, LightShape::Kind kind, int samples) {
    auto light = make(handle, from, power(p), kind, samples);
    // The lights of the first versions (PxrStd...) are normalized in any case.
    const bool is_normalized = contains(from.name, "PxrStd") || p.number_or("areaNormalize", 0) != 0;
    set_number(light->shader, "normalized", is_normalized ? 1.0f : 0.0f);
    set_number(light->shader, "focus", std::clamp(p.number_or("emissionFocus", 0), 0.0f, 100.0f));
    set_number(light->shader, "coneangle", std::clamp(p.number_or("coneAngle", 90), 0.0f, 180.0f));
    set_number(light->shader, "conesoftness", std::clamp(p.number_or("coneSoftness", 0), 0.0f, 1.0f));
    set_sampling(*light, p);
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

/// On which sides it shines is open until its shape comes (place_mesh_light()).
std::shared_ptr<LightInstance> mesh_light(const std::string& handle, const ShaderInstance& shader,
                                          const RisParameters& parameters, int samples) {
    return of_shape(handle, shader, parameters, LightShape::Kind::Mesh, samples);
}

/// A flat shape shines to both sides, others outwards.
void place_mesh_light(LightInstance& light, const Shape& shape) {
    const Box box = box_of(shape);
    const V3f size = box.high - box.low;
    light.shape->two_sided = std::min({size.x, size.y, size.z}) <= 0.01f * std::max({size.x, size.y, size.z});
}

/// The colour is that which mesh_light() has computed from intensity and exposure; a disk of a known angle
/// takes that for its radiance, and lights by its share of the sky.
std::shared_ptr<LightInstance> far_light(const LightInstance& light, FarShape shape,
                                         const M44f& camera_from_shape, std::vector<M44f> moving_shape,
                                         float angle) {
    ShaderInstance from = light.shader;
    from.camera_from_shader = camera_from_shape;
    const V3f radiance = triple_or(from, "lightcolor", V3f(1, 1, 1));
    const int samples = light.shape->samples;
    const bool is_dome = shape == FarShape::Dome;
    const float share = !is_dome && angle > 0 && !is_brightness(radiance) ? share_of_disk(angle) : 1;
    auto made = make(light.handle, from, radiance * share,
                     is_dome ? LightShape::Kind::Dome : LightShape::Kind::Distant, samples);
    for (const char* name : {"traceshadows", "shadowcolor"})
        if (const Parameter* given = from.parameters.find(name)) made->shader.parameters.set(*given);
    made->shape->angle = half_angle(angle);
    // Exporters for Maya and Blender, whose suns shine along -z, write their matrices as they are. Not so
    // those of the later PxrDistantLight: it shines along +z.
    const M44f turned = M44f().setScale(V3f(1, 1, is_dome ? 1 : -1));
    made->shader.camera_from_shader = turned * camera_from_shape;
    for (M44f& pose : moving_shape) pose = turned * pose;
    made->moving_space = std::move(moving_shape);
    return made;
}

/// The place of a light that is a point here: the middle of its shape.
V3f middle_of(const Shape& shape) {
    const Box box = box_of(shape);
    return (box.low + box.high) * 0.5f;
}

/// Told by parts of the names: the plugins of all versions have theirs in common (PxrStdEnvMapLight,
/// PxrDomeLight).
std::shared_ptr<LightInstance> ris_light(const std::string& handle, const ShaderInstance& shader,
                                         const RisParameters& p, int samples) {
    using Kind = LightShape::Kind;
    const std::string_view name = shader.name;
    if (contains(name, "Distant")) {
        auto light = make(handle, shader, power_of_disk(p), Kind::Distant, samples);
        const float given = p.number_or("angleExtent", -1);
        light->shape->angle = half_angle(given < 0 ? kSunAngle : given);
        set_sampling(*light, p);
        return light;
    }
    if (contains(name, "Dome") || contains(name, "Env")) {
        auto light = make(handle, shader, power(p), Kind::Dome, samples);
        light->shape->map = p.text("lightColorMap");
        set_sampling(*light, p);
        return light;
    }
    constexpr std::pair<std::string_view, Kind> kShapes[] = {{"Rect", Kind::Rect},
                                                             {"Portal", Kind::Rect},
                                                             {"Disk", Kind::Disk},
                                                             {"Sphere", Kind::Sphere},
                                                             {"Cylinder", Kind::Cylinder}};
    for (const auto& [part, kind] : kShapes)
        if (contains(name, part)) return of_shape(handle, shader, p, kind, samples);
    return {};
}

/// A light of RSL, which casts no shadows. Camera space, along z: it has no transformation of its own.
std::shared_ptr<const LightInstance> headlight() {
    auto light = std::make_shared<LightInstance>();
    light->shader.name = "distantlight";
    set_triple(light->shader, "lightcolor", ValueType::Color, V3f(1, 1, 1));
    set_triple(light->shader, "from", ValueType::Point, V3f(0, 0, 0));
    set_triple(light->shader, "to", ValueType::Point, V3f(0, 0, 1));
    return light;
}

}  // namespace trapeze::rib
