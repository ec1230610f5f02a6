#include "shade/named_values.h"

#include <algorithm>
#include <array>

namespace trapeze {
namespace {

NamedValue one(float number) {
    return {{number}, {}};
}
NamedValue three(const V3f& v) {
    return {{v.x, v.y, v.z}, {}};
}

NamedValue text_of(std::string text) {
    return {{}, {std::move(text)}};
}
template <size_t n>
NamedValue all_of(const std::array<float, n>& numbers) {
    return {{numbers.begin(), numbers.end()}, {}};
}

/// "inside" where normals are turned over by what Orientation and ReverseOrientation say together.
NamedValue orientation_of(const Attributes& attributes, const Primitive* primitive) {
    const bool mirrored = primitive && !primitive->camera_from_object.empty() &&
                          primitive->camera_from_object.front().determinant() < 0;
    return text_of(attributes.reverse_orientation != mirrored ? "inside" : "outside");
}

/// What requests of their own set, some of it under "Ri:" too.
std::optional<NamedValue> find_own(const Attributes& a, const Primitive* primitive, std::string_view name) {
    if (name == "ShadingRate" || name == "Ri:ShadingRate") return one(a.shading_rate);
    if (name == "Sides" || name == "Ri:Sides") return one(static_cast<float>(a.sides));
    if (name == "Matte" || name == "matte" || name == "Ri:Matte") return one(static_cast<float>(a.matte));
    if (name == "GeometricApproximation:motionfactor") return one(a.motion_factor);
    if (name == "GeometricApproximation:focusfactor") return one(a.focus_factor);
    if (name == "Ri:Color") return three(a.color);
    if (name == "Ri:Opacity") return three(a.opacity);
    if (name == "Ri:TextureCoordinates") return all_of(a.texture_coordinates);
    if (name == "Ri:ShadingInterpolation") return text_of(a.smooth_shading ? "smooth" : "constant");
    if (name == "Ri:Orientation") return orientation_of(a, primitive);
    if (name == "identifier:name") return text_of(a.name);
    return {};
}

NamedValue text_of(RayAttributes::HitMode mode) {
    using HitMode = RayAttributes::HitMode;
    return text_of(mode == HitMode::Shader ? "shader" : mode == HitMode::Opaque ? "opaque" : "primitive");
}

/// What holds of attributes that no request has set, of rays above all.
std::optional<NamedValue> find_default(const Attributes& a, std::string_view name) {
    const RayAttributes& rays = a.rays;
    const auto number = [](auto value) { return one(static_cast<float>(value)); };
    if (name == "visibility:camera") return number(a.visible_to_camera);
    if (name == "visibility:diffuse") return number(rays.diffuse);
    if (name == "visibility:specular") return number(rays.specular);
    if (name == "visibility:transmission") return number(rays.transmission);
    if (name == "trace:bias") return number(rays.bias);
    if (name == "trace:displacements") return number(rays.displaced);
    if (name == "trace:maxdiffusedepth") return number(rays.max_diffuse);
    if (name == "trace:maxspeculardepth") return number(rays.max_specular);
    if (name == "trace:samplemotion") return number(rays.sample_motion);
    if (name == "shade:transmissionhitmode") return text_of(rays.transmission_hits);
    if (name == "shade:specularhitmode") return text_of(rays.specular_hits);
    if (name == "shade:diffusehitmode" && rays.diffuse_hits) return text_of(*rays.diffuse_hits);
    if (name == "dice:binary") return number(a.dice.binary);
    if (name == "dice:rasterorient") return number(a.dice.raster_oriented);
    if (name == "cull:hidden") return number(a.cull_hidden);
    if (name == "derivatives:centered") return one(1);
    return {};
}

std::optional<NamedValue> find_user_value(const UserValues& values, std::string_view name) {
    const Parameter* const value = values.find(name);
    if (!value) return {};
    return value->strings.empty() ? NamedValue{value->floats, {}} : NamedValue{{}, value->strings};
}

/// Options that requests of their own set, without "Ri:".
std::optional<NamedValue> find_own(const Options& o, const Camera& camera, std::string_view name) {
    const auto width = static_cast<float>(camera.width), height = static_cast<float>(camera.height);
    if (name == "Format" || name == "DeviceResolution") return all_of<3>({width, height, o.pixel_aspect});
    if (name == "FormatResolution") return all_of<2>({width, height});
    if (name == "FormatPixelAspectRatio") return one(o.pixel_aspect);
    if (name == "FrameAspectRatio")
        return one(o.frame_aspect.value_or(o.pixel_aspect * width / std::max(height, 1.0f)));
    if (name == "CropWindow") return all_of(o.crop_window);
    if (name == "ScreenWindow") return all_of<4>({camera.left, camera.right, camera.bottom, camera.top});
    if (name == "DepthOfField") return all_of<3>({o.f_stop, o.focal_length, o.focal_distance});
    if (name == "Shutter") return all_of<2>({o.shutter_open, o.shutter_close});
    if (name == "Clipping") return all_of<2>({o.near_clip, o.far_clip});
    if (name == "PixelSamples") return all_of<2>({o.samples_x, o.samples_y});
    if (name == "Exposure") return all_of<2>({o.exposure_gain, o.exposure_gamma});
    if (name == "Frame" || name == "FrameBegin") return one(static_cast<float>(o.frame));
    if (name == "trace:maxdepth") return one(static_cast<float>(o.max_ray_depth));
    return {};
}

}  // namespace

std::optional<NamedValue> find_attribute_value(const Attributes& attributes, const Primitive* primitive,
                                               std::string_view name) {
    if (std::optional<NamedValue> own = find_own(attributes, primitive, name)) return own;
    if (std::optional<NamedValue> user = find_user_value(attributes.user, name)) return user;
    return find_default(attributes, name);
}

std::optional<NamedValue> find_option_value(const Options& options, const Camera& camera,
                                            std::string_view name) {
    constexpr std::string_view kOfRequests = "Ri:";
    if (name.starts_with(kOfRequests)) return find_own(options, camera, name.substr(kOfRequests.size()));
    if (std::optional<NamedValue> own = find_own(options, camera, name)) return own;
    return find_user_value(options.user, name);
}

}  // namespace trapeze
