#include "shade/area_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "core/scene/poses.h"
#include "shade/maps/read_sky_picture.h"

namespace trapeze {
namespace {

/// A dome's picture is read at no more columns than these, and half as many rows: what is smaller is a part
/// of a cell.
constexpr int kMostColumns = 1024;

/// A light that moves is known in so many parts of the shutter.
constexpr size_t kParts = 64;

/// Where the light is, camera space: as the shutter opens, and if it moves in the middles of its parts, too.
/// Rays meet what it shines on without the camera's motion. It may be all that moves.
std::vector<M44f> spaces_of(const LightInstance& light, const RenderContext& context) {
    std::vector<M44f> spaces{light.shader.camera_from_shader};
    const std::vector<M44f> poses =
        held_poses(light.moving_space.empty() ? spaces : light.moving_space, context.scene->held_from_camera);
    if (poses.size() > 1)
        for (size_t part = 0; part < kParts; ++part)
            spaces.push_back(pose_at<M44f>(poses, middle_of_part(part, kParts)));
    return spaces;
}

/// Of all but meshes, one for each space.
std::vector<std::unique_ptr<LightSampler>> samplers_of(const LightInstance& light, Textures& textures,
                                                       std::span<const M44f> spaces) {
    using Kind = LightShape::Kind;
    const LightShape& shape = *light.shape;
    if (shape.kind == Kind::Dome) {
        // White where it cannot be read.
        SkyPicture sky;
        if (!shape.map.empty())
            sky = read_sky_picture(textures, shape.map, light.shader.location, kMostColumns);
        return make_dome_samplers(std::move(sky), spaces);
    }
    std::vector<std::unique_ptr<LightSampler>> samplers;
    for (const M44f& space : spaces) {
        if (shape.kind == Kind::Sphere)
            samplers.push_back(make_sphere_sampler(space));
        else if (shape.kind == Kind::Cylinder)
            samplers.push_back(make_cylinder_sampler(space));
        else if (shape.kind == Kind::Distant)
            samplers.push_back(make_distant_sampler(shape.angle, space));
        else
            samplers.push_back(make_flat_sampler(shape, space));
    }
    return samplers;
}

void report_dark(const LightInstance& light, Diagnostics* diagnostics) {
    if (!diagnostics) return;
    const char* const why =
        light.shape->kind == LightShape::Kind::Dome ? "its map is black" : "what it shines from has no area";
    diagnostics->warning(light.shader.location,
                         fmt::format("the light \"{}\" is dark: {}", light.handle, why),
                         "dark-area-light " + light.handle);
}

}  // namespace

bool is_mesh_light(const Lamp& lamp) {
    return lamp.area && lamp.area->shape->kind == LightShape::Kind::Mesh;
}

void make_samplers(Materials& materials, Textures& textures, const RenderContext& context) {
    for (Lamp* lamp : materials.lamps()) {
        if (!lamp->area || is_mesh_light(*lamp)) continue;
        lamp->samplers = samplers_of(*lamp->area, textures, spaces_of(*lamp->area, context));
        if (lamp->turns() == 0) report_dark(*lamp->area, context.diagnostics);
    }
}

void make_mesh_samplers(Materials& materials, const LightMeshes& meshes, Diagnostics* diagnostics) {
    for (Lamp* lamp : materials.lamps()) {
        if (!is_mesh_light(*lamp)) continue;
        const auto of_light = meshes.find(lamp->area);
        if (of_light != meshes.end())
            for (const LightMesh& mesh : of_light->second)
                lamp->samplers.push_back(make_mesh_sampler(mesh, lamp->area->shape->two_sided));
        if (lamp->turns() == 0) report_dark(*lamp->area, diagnostics);
    }
}

}  // namespace trapeze
