#include "shade/materials/stand_in_light.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace trapeze {
namespace {

/// Intensities from here on are taken to be meant for lights that fade with the square of the distance:
/// without it they would be far too bright.
constexpr float kLargeIntensity = 5;

/// A name in lower case, letters and digits alone, so that coneAngle and cone_angle are one.
std::string plain(std::string_view name) {
    std::string result;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)))
            result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

using Names = std::initializer_list<std::string_view>;

bool has_any(std::string_view text, Names parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

/// The parameters given to the missing shader, found by the names that exporters give to such parameters.
class Given {
  public:
    explicit Given(const ShaderInstance& instance) : instance_(instance) {}

    /// The first parameter that has one of the names (as plain() writes them) and so many floats; null when
    /// none has.
    const Parameter* find(Names names, size_t floats) const {
        for (const std::string_view name : names)
            for (const Parameter& parameter : instance_.parameters.values)
                if (plain(parameter.name) == name && parameter.floats.size() == floats) return &parameter;
        return nullptr;
    }
    std::optional<float> number(Names names) const {
        const Parameter* found = find(names, 1);
        if (!found || !std::isfinite(found->floats[0])) return {};
        return found->floats[0];
    }

    /// The depth map of the light's shadows; empty if there is none, or if the renderer was to make it.
    std::string shadow_map() const {
        for (const std::string_view name :
             {"shadowname", "shadname", "shadowmap", "shadowmapname", "shadowfile"})
            for (const Parameter& parameter : instance_.parameters.values)
                if (plain(parameter.name) == name && parameter.strings.size() == 1 &&
                    parameter.strings[0] != "raytrace" && parameter.strings[0] != "autoshadow")
                    return parameter.strings[0];
        return {};
    }

  private:
    const ShaderInstance& instance_;
};

enum class LightKind { Ambient, Distant, Point, Spot };

/// The kind of light that a missing shader most likely was, by its name first, then by its parameters.
LightKind kind_of(std::string_view name, const Given& given) {
    if (has_any(name, {"ambient", "environment", "envlight", "occl", "indirect", "dome", "sky", "image"}))
        return LightKind::Ambient;
    if (has_any(name, {"distant", "direction", "infinite", "parallel", "sun", "solar"}))
        return LightKind::Distant;
    if (has_any(name, {"spot", "cone", "projector", "slide"}) || given.number({"coneangle", "hotspot"}))
        return LightKind::Spot;
    if (has_any(name, {"point", "omni", "area", "bulb"})) return LightKind::Point;
    return given.find({"from"}, 3) && given.find({"to"}, 3) ? LightKind::Distant : LightKind::Point;
}

/// Builds the standard light, in the missing one's place and space.
class Maker {
  public:
    Maker(const ShaderInstance& missing, std::string name) : given_(missing) {
        made_.name = std::move(name);
        made_.location = missing.location;
        made_.camera_from_shader = missing.camera_from_shader;
    }
    void take(const char* name, Names names, ValueType type) {
        const Parameter* found = given_.find(names, type == ValueType::Float ? 1 : 3);
        if (found) set(name, type, found->floats);
    }
    void set(const char* name, ValueType type, std::vector<float> values) {
        made_.parameters.set({name, {StorageClass::Uniform, type, 1}, std::move(values), {}});
    }
    void set_shadow_map(const std::string& file) {
        if (!file.empty())
            made_.parameters.set({"shadowname", {StorageClass::Uniform, ValueType::String, 1}, {}, {file}});
    }
    ShaderInstance made() && { return std::move(made_); }

  private:
    Given given_;
    ShaderInstance made_;
};

/// The power of the distance that the light is divided by. Values beyond 4 mean something else, such as a
/// falloff in degrees. Area lights fade with the square.
float falloff(std::string_view name, const Given& given) {
    const auto said = given.number({"decay", "decayrate", "falloff", "attenuation"});
    if (said && *said >= 0 && *said <= 4) return *said;
    if (has_any(name, {"area"})) return 2;
    return given.number({"intensity"}).value_or(1) >= kLargeIntensity ? 2.0f : 0.0f;
}

/// A cone's half angle in radians; angles above pi are whole cones in degrees.
float half_cone(float angle) {
    return angle > std::numbers::pi_v<float> ? angle * std::numbers::pi_v<float> / 360 : angle;
}

}  // namespace

ShaderInstance stand_in_light(const ShaderInstance& missing) {
    const Given given(missing);
    const LightKind kind = kind_of(plain(missing.name), given);
    const std::string shadow_map = given.shadow_map();
    const char* const name = kind == LightKind::Ambient   ? "ambientlight"
                             : kind != LightKind::Distant ? "standinlight"
                             : shadow_map.empty()         ? "distantlight"
                                                          : "shadowdistant";
    Maker maker(missing, name);
    maker.take("intensity", {"intensity", "lightintensity", "energy"}, ValueType::Float);
    maker.take("lightcolor", {"lightcolor", "lightcolour", "color", "colour", "cl"}, ValueType::Color);
    if (kind == LightKind::Ambient) return std::move(maker).made();
    maker.take("from", {"from"}, ValueType::Point);
    maker.take("to", {"to"}, ValueType::Point);
    maker.set_shadow_map(shadow_map);
    if (kind == LightKind::Distant) return std::move(maker).made();
    maker.set("falloff", ValueType::Float, {falloff(plain(missing.name), given)});
    if (kind == LightKind::Point) return std::move(maker).made();
    maker.set("spot", ValueType::Float, {1});
    if (const auto angle = given.number({"coneangle"})) {
        maker.set("coneangle", ValueType::Float, {half_cone(*angle)});
        maker.set("conedeltaangle", ValueType::Float,
                  {half_cone(given.number({"conedeltaangle"}).value_or(*angle / 8))});
    }
    // Names of 3D Studio Max: whole cones in degrees, "hotspot" inside and "falloff" outside.
    const auto inner = given.number({"hotspot"}), outer = given.number({"falloff"});
    if (inner && outer && *outer > 4) {
        constexpr float kHalfDegree = std::numbers::pi_v<float> / 360;
        maker.set("coneangle", ValueType::Float, {*outer * kHalfDegree});
        maker.set("conedeltaangle", ValueType::Float, {std::max(*outer - *inner, 0.0f) * kHalfDegree});
    }
    maker.take("beamdistribution", {"beamdistribution"}, ValueType::Float);
    return std::move(maker).made();
}

}  // namespace trapeze
