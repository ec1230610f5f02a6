#include "shade/area_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/portable_math.h"
#include "core/scene/poses.h"

namespace trapeze {
namespace {

/// A dome's picture is read at no more cells than these: what is smaller is a part of a cell.
constexpr int kMostColumns = 1024, kMostRows = 512;

/// Directions of the cells' middles, and their differences from cell to cell: what a lookup is filtered over.
struct DomeDirections {
    std::vector<float> planes[9];

    DomeDirections(int width, int height) {
        constexpr double kPi = std::numbers::pi;
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column) {
                const double down = kPi * (row + 0.5) / height, turn = 2 * kPi * (column + 0.5) / width;
                const double z = portable::cos(down), across = portable::sin(down);
                const double c = portable::cos(turn), s = portable::sin(turn);
                const double du = 2 * kPi / width, dv = kPi / height;
                const double values[] = {c * across,       s * across,      z,
                                         -s * across * du, c * across * du, 0,
                                         c * z * dv,       s * z * dv,      -across * dv};
                for (size_t k = 0; k < 9; ++k) planes[k].push_back(static_cast<float>(values[k]));
            }
    }
    ConstPlane3 triple(size_t first) const { return {planes[first], planes[first + 1], planes[first + 2]}; }
};

/// The picture of a dome; empty, which is white, where it cannot be read. What is not finite, or below zero,
/// is black.
DomeMap read_dome_map(Textures& textures, const std::string& name, const SourceLocation& location) {
    DomeMap map;
    const Textures::Picture* picture =
        textures.find(name, location, textures.reading_of_lookup("", true, location));
    const auto info = textures.info(name);
    if (!picture || !info || info->width < 1 || info->height < 1) return map;
    map.width = std::min(info->width, kMostColumns), map.height = std::min(info->height, kMostRows);
    MapOptions options;
    // Cells that are pixels have the pixels' values.
    if (map.width == info->width && map.height == info->height) options.filter = MapOptions::Filter::Nearest;
    const DomeDirections directions(map.width, map.height);
    const size_t count = directions.planes[0].size();
    std::vector<float> out[3];
    for (auto& plane : out) plane.resize(count);
    const Plane planes[] = {out[0], out[1], out[2]};
    textures.environment(picture, {directions.triple(0), directions.triple(3), directions.triple(6)}, options,
                         {count, {}}, planes);
    const auto valid = [](float x) { return std::isfinite(x) && x > 0 ? x : 0.0f; };
    for (size_t i = 0; i < count; ++i)
        map.colors.emplace_back(valid(out[0][i]), valid(out[1][i]), valid(out[2][i]));
    return map;
}

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
        DomeMap map;
        if (!shape.map.empty()) map = read_dome_map(textures, shape.map, light.shader.location);
        return make_dome_samplers(std::move(map), spaces);
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
