#include "pipeline/rays/light_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tessellate/tessellate.h"

namespace trapeze {
namespace {

/// Micropolygons along the longest side of a light: a circle becomes a polygon of some hundred sides, of
/// which the area is less by a thousandth.
constexpr float kAlongASide = 32;

/// About the longest side of a primitive, camera space; 0: not known.
float size_of(const Primitive& primitive) {
    const M44f& space = primitive.camera_from_object.front();
    if (const auto* quadric = std::get_if<Quadric>(&primitive.shape().topology)) {
        float largest = 0, stretch = 0;
        for (int i = 0; i + 1 < quadric->value_count; ++i)
            if (std::isfinite(quadric->values[static_cast<size_t>(i)]))
                largest = std::max(largest, std::abs(quadric->values[static_cast<size_t>(i)]));
        for (int row = 0; row < 3; ++row)
            stretch = std::max(stretch, V3f(space[row][0], space[row][1], space[row][2]).length());
        return 2 * largest * stretch;
    }
    const Parameter* points = primitive.shape().variables.find("P");
    if (!points) return 0;
    Box3f box;
    for (size_t i = 0; i + 2 < points->floats.size(); i += 3)
        box.extendBy(V3f(points->floats[i], points->floats[i + 1], points->floats[i + 2]) * space);
    const V3f size = box.isEmpty() ? V3f(0) : box.size();
    return std::max({size.x, size.y, size.z});
}

/// A scene of the light's primitives alone, each seen by rays and by no shader, and the camera for which a
/// pixel is what a micropolygon is to be.
struct LightScene {
    Scene scene;
    RenderContext context;

    LightScene(const RenderContext& of_frame, const LightInstance& light) : context(of_frame) {
        float size = 0;
        for (const Primitive& primitive : of_frame.scene->primitives) {
            if (primitive.emitter.get() != &light) continue;
            Primitive part = primitive;
            auto attributes = std::make_shared<Attributes>(*primitive.attributes);
            attributes->rays.transmission = true;
            attributes->shading_rate = 1;
            attributes->dice = {};
            attributes->surface = attributes->displacement = nullptr;
            part.attributes = std::move(attributes);
            scene.primitives.push_back(std::move(part));
            size = std::max(size, size_of(primitive));
        }
        scene.camera_from_world = of_frame.scene->camera_from_world;
        context.scene = &scene;
        context.motion = false;
        if (!(size > 0) || !std::isfinite(size)) return;
        Options& options = scene.options;
        constexpr int kPixels = 64;
        options.width = options.height = kPixels;
        const float reach = size / kAlongASide * kPixels / 2;
        options.screen_window = {-reach, reach, -reach, reach};
        context.camera = make_camera(options);
    }
    LightScene(const LightScene&) = delete;
    LightScene& operator=(const LightScene&) = delete;
};

/// Every other bit of a number, from the first on.
int every_other_bit(int bits) {
    int found = 0;
    for (int k = 0; k < 4; ++k) found |= (bits >> (2 * k) & 1) << k;
    return found;
}

/// Micropolygons in the order of a Z-shaped curve: those that follow each other are neighbours in
/// both directions, and so parts of the list are parts of the surface that are about as wide as long.
void add_triangles(const ShadingGrid& grid, LightMesh& mesh) {
    const auto add = [&](const V3f& a, const V3f& b, const V3f& c) {
        if (grid.reverse_orientation)
            mesh.triangles.push_back({a, c, b});
        else
            mesh.triangles.push_back({a, b, c});
    };
    const Triples& P = grid.P.front();
    for (int place = 0; place < 256; ++place) {
        const int i = every_other_bit(place), j = every_other_bit(place >> 1);
        if (i >= grid.shape.nu || j >= grid.shape.nv) continue;
        std::array<V3f, 4> corners;
        for (int k = 0; k < 4; ++k)
            corners[static_cast<size_t>(k)] =
                P.at(static_cast<size_t>(grid.shape.row_index(i + (k & 1), j + (k >> 1))));
        add(corners[0], corners[1], corners[2]);
        add(corners[3], corners[2], corners[1]);
    }
}

LightMesh mesh_of(const RenderContext& of_frame, const LightInstance& light, const Shading& shading,
                  size_t most_bytes) {
    const LightScene parts(of_frame, light);
    LightMesh mesh;
    if (parts.scene.primitives.empty()) return mesh;
    TessellationOptions options;
    options.depth_heights = shading.depth_heights();
    options.most_bytes = most_bytes, options.seen_by = SeenBy::Rays;
    const Tessellation tessellation(parts.context, options);
    DiceScratch scratch;
    ShadingGrid grid;
    for (size_t i = 0; i < tessellation.subpatches().size() && !of_frame.is_cancelled(); ++i) {
        tessellation.dice(i, grid, scratch);
        add_triangles(grid, mesh);
    }
    return mesh;
}

}  // namespace

void make_light_meshes(const RenderContext& context, Shading& shading, size_t most_bytes) {
    const std::vector<const LightInstance*> lights = shading.mesh_lights();
    if (lights.empty()) return;
    LightMeshes meshes;
    for (const LightInstance* light : lights) meshes[light] = mesh_of(context, *light, shading, most_bytes);
    shading.set_light_meshes(meshes);
}

}  // namespace trapeze
