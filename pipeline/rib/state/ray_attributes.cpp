#include "pipeline/rib/state/ray_attributes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/scene/ray_groups.h"

namespace trapeze::rib {
namespace {

using HitMode = RayAttributes::HitMode;

float number_of(const Parameter& value) {
    return value.floats.empty() ? 0 : value.floats[0];
}

/// Depths are small; a number that is none counts as 0.
int depth_of(const Parameter& value) {
    constexpr float kMost = 1000;
    const float depth = number_of(value);
    return depth > 0 ? static_cast<int>(std::min(depth, kMost)) : 0;
}

/// "visibility" "string transmission", of PRMan before 13, and BMRT's "render" "string casts_shadows": what
/// rays see, and by whose opacity.
void set_old_transmission(std::string_view seen_as, RayAttributes& rays) {
    rays.transmission = seen_as != "transparent" && seen_as != "none";
    rays.transmission_hits = seen_as == "shader" || seen_as == "shade" ? HitMode::Shader
                             : seen_as == "opaque"                     ? HitMode::Opaque
                                                                       : HitMode::Primitive;
}

/// The three kinds of rays that can see a surface have a flag each; the older "trace" sets the two of
/// reflections and of gathered light together.
void set_visibility(const Parameter& value, RayAttributes& rays) {
    const std::string_view name = value.name;
    if (name == "transmission" && value.is_string())
        return set_old_transmission(value.strings.empty() ? std::string_view() : value.strings[0], rays);
    const bool is_on = number_of(value) != 0;
    if (name == "diffuse" || name == "trace") rays.diffuse = is_on;
    if (name == "specular" || name == "trace") rays.specular = is_on;
    if (name == "transmission") rays.transmission = is_on;
}

/// Who answers for what a ray hits: its shader, which is run there, or the primitive's own Color and Opacity.
/// Every word but "primitive" means the shader.
void set_hit_mode(std::string_view name, std::string_view text, RayAttributes& rays) {
    const HitMode mode = text == "primitive" ? HitMode::Primitive : HitMode::Shader;
    if (name == "transmissionhitmode") rays.transmission_hits = mode;
    if (name == "specularhitmode") rays.specular_hits = mode;
    if (name == "diffusehitmode") rays.diffuse_hits = mode;
}

}  // namespace

/// Values that nothing here knows change nothing; they are counted where attributes are
/// (recognises_attribute()).
void set_ray_attribute(std::string_view category, const Parameter& value, RayAttributes& rays) {
    const std::string_view name = value.name;
    if (category == "visibility") set_visibility(value, rays);
    // BMRT's: a bit for the camera, one for reflections, one for shadows.
    if (category == "render" && name == "visibility" && !value.floats.empty()) {
        const int bits = static_cast<int>(std::clamp(value.floats[0], 0.0f, 7.0f));
        rays.diffuse = rays.specular = (bits & 2) != 0;
        rays.transmission = (bits & 4) != 0;
    }
    // BMRT's: what follows casts shadows, by its Opacity unless it says that its shader is to be asked.
    if (category == "light" && name == "shadows" && !value.strings.empty() && value.strings[0] == "on")
        rays.transmission = true, rays.transmission_hits = RayAttributes::HitMode::Primitive;
    if (category == "render" && name == "casts_shadows" && !value.strings.empty())
        set_old_transmission(value.strings[0], rays);
    if (category == "shade" && !value.strings.empty()) set_hit_mode(name, value.strings[0], rays);
    if (category == "grouping" && name == "membership" && !value.strings.empty())
        change_membership(value.strings[0], rays.groups);
    if (category != "trace") return;
    if (name == "bias") rays.bias = std::max(number_of(value), 0.0f);
    if (name == "maxdiffusedepth") rays.max_diffuse = depth_of(value);
    if (name == "maxspeculardepth") rays.max_specular = depth_of(value);
    if (name == "displacements") rays.displaced = number_of(value) != 0;
    if (name == "samplemotion") rays.sample_motion = number_of(value) != 0;
}

}  // namespace trapeze::rib
