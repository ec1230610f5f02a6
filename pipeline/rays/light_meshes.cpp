#include "pipeline/rays/light_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/motion_keys.h"
#include "core/portable_math.h"
#include "pipeline/rays/held_scene.h"
#include "pipeline/rays/round_shapes.h"
#include "tessellate/tessellate.h"

namespace trapeze {
namespace {

/// Micropolygons along the longest side of a light: a circle becomes a polygon of some hundred sides, of
/// which the area is less by a thousandth.
constexpr float kAlongASide = 32;

/// Normals turn by so much, radians, across a micropolygon: as on a circle of some forty sides, of which the
/// area is less by a thousandth, too. More than that, in the mean, and the primitive is diced more finely.
constexpr double kTurn = 0.15;
/// A light has no more micropolygons than about these because they turn.
constexpr double kMostMicropolygons = 1 << 18;
/// A light that moves is known in so many parts of the shutter; in fewer, where that would be more
/// micropolygons than above.
constexpr size_t kMostParts = 64;
/// Of dicing. Where few micropolygons do not tell how much it turns, the next ones do.
constexpr int kMostTries = 3;

/// The longest side of a box about all of a quadric's circles, in its space.
float size_of(const Quadric& quadric) {
    const auto& v = quadric.values;
    switch (quadric.kind) {
        case Quadric::Kind::Sphere:
            return 2 * std::abs(v[0]);
        case Quadric::Kind::Cone:
            return std::max(std::abs(v[0]), 2 * std::abs(v[1]));
        case Quadric::Kind::Cylinder:
        case Quadric::Kind::Paraboloid:
            return std::max(2 * std::abs(v[0]), std::abs(v[2] - v[1]));
        case Quadric::Kind::Hyperboloid:
            return std::max(
                {2 * V2f(v[0], v[1]).length(), 2 * V2f(v[3], v[4]).length(), std::abs(v[5] - v[2])});
        case Quadric::Kind::Disk:
            return 2 * std::abs(v[1]);
        case Quadric::Kind::Torus:
            return 2 * (std::abs(v[0]) + std::abs(v[1]));
    }
    return 0;
}

/// About the longest side of a primitive, camera space; 0: not known.
float size_of(const Primitive& primitive) {
    const M44f& space = primitive.camera_from_object.front();
    if (const auto* quadric = std::get_if<Quadric>(&primitive.shape().topology)) {
        float stretch = 0;
        for (int row = 0; row < 3; ++row)
            stretch = std::max(stretch, V3f(space[row][0], space[row][1], space[row][2]).length());
        const float size = size_of(*quadric) * stretch;
        return std::isfinite(size) ? size : 0;
    }
    const Parameter* points = primitive.shape().variables.find("P");
    if (!points) return 0;
    Box3f box;
    for (size_t i = 0; i + 2 < points->floats.size(); i += 3)
        box.extendBy(V3f(points->floats[i], points->floats[i + 1], points->floats[i + 2]) * space);
    const V3f size = box.isEmpty() ? V3f(0) : box.size();
    return std::max({size.x, size.y, size.z});
}

/// A scene of the light's primitives alone, but for those that are balls, each seen by rays, displaced where
/// rays meet it so, and the camera for which a pixel is what a micropolygon is to be.
struct LightScene {
    Scene scene;
    std::vector<uint32_t> numbers;  ///< of the primitives in the frame's scene
    RenderContext context;

    LightScene(const RenderContext& of_frame, const LightInstance& light) : context(of_frame) {
        float size = 0;
        for (size_t i = 0; i < of_frame.scene->primitives.size(); ++i) {
            const Primitive& primitive = of_frame.scene->primitives[i];
            if (primitive.emitter.get() != &light || are_balls(primitive)) continue;
            scene.primitives.push_back(primitive);
            numbers.push_back(static_cast<uint32_t>(i));
            set_rate(scene.primitives.size() - 1, 1);
            size = std::max(size, size_of(primitive));
        }
        scene.camera_from_world = of_frame.scene->camera_from_world;
        context.scene = &scene;
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

    /// A primitive's micropolygons take so many of the camera's pixels.
    void set_rate(size_t primitive, float rate) {
        auto attributes = std::make_shared<Attributes>(*scene.primitives[primitive].attributes);
        attributes->rays.transmission = true;
        attributes->shading_rate = rate;
        attributes->dice = {};
        attributes->surface = nullptr;
        if (!attributes->rays.displaced) attributes->displacement = nullptr;
        scene.primitives[primitive].attributes = std::move(attributes);
    }
};

/// How much a primitive's normals turn across the micropolygons that it has.
struct Turning {
    double micropolygons = 0, area = 0;
    double squares = 0;  ///< of the angles, radians, by area

    void add(const ShadingGrid& grid) {
        const Triples& P = grid.P.front();
        for (int j = 0; j < grid.shape.nv; ++j)
            for (int i = 0; i < grid.shape.nu; ++i) {
                const auto at = [&](int du, int dv) {
                    return static_cast<size_t>(grid.shape.row_index(i + du, j + dv));
                };
                const size_t corners[] = {at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
                const double part = static_cast<double>((P.at(corners[3]) - P.at(corners[0]))
                                                            .cross(P.at(corners[2]) - P.at(corners[1]))
                                                            .length());
                ++micropolygons;
                if (!(part > 0) || !std::isfinite(part)) continue;
                area += part;
                for (const auto& [from, to] : {std::pair{0, 1}, {2, 3}, {0, 2}, {1, 3}})
                    squares += part / 2 * angle2(grid.Ng.at(corners[from]), grid.Ng.at(corners[to]));
            }
    }

    /// By how much sides have to be shorter.
    double factor() const { return area > 0 ? std::max(1.0, std::sqrt(squares / area) / kTurn) : 1; }

  private:
    static double angle2(const V3f& a, const V3f& b) {
        const double angle =
            portable::atan2(static_cast<double>(a.cross(b).length()), static_cast<double>(a.dot(b)));
        return angle * angle;
    }
};

/// Has primitives of which normals turn too much across a micropolygon diced more finely; false: there are
/// none.
bool refine(LightScene& parts, const std::vector<Turning>& turnings) {
    double micropolygons = 0, wanted = 0;
    for (const Turning& turning : turnings) {
        micropolygons += turning.micropolygons;
        wanted += turning.micropolygons * turning.factor() * turning.factor();
    }
    const double least = wanted > kMostMicropolygons ? std::sqrt(kMostMicropolygons / wanted) : 1;
    if (micropolygons >= kMostMicropolygons) return false;
    bool any = false;
    for (size_t i = 0; i < turnings.size(); ++i) {
        // A little more than that is a matter of rounding.
        const double factor = turnings[i].factor() * least;
        if (factor < 1.15) continue;
        const float rate = parts.scene.primitives[i].attributes->shading_rate;
        parts.set_rate(i, rate / static_cast<float>(factor * factor));
        any = true;
    }
    return any;
}

/// Every other bit of a number, from the first on.
int every_other_bit(int bits) {
    int found = 0;
    for (int k = 0; k < 4; ++k) found |= (bits >> (2 * k) & 1) << k;
    return found;
}

/// Micropolygons in the order of a Z-shaped curve: those that follow each other are neighbours in
/// both directions, and so parts of the list are parts of the surface that are about as wide as long.
void add_triangles(const ShadingGrid& grid, float time, bool with_places, LightMesh& mesh) {
    const auto add = [&](size_t a, size_t b, size_t c) {
        if (grid.reverse_orientation) std::swap(b, c);
        const auto at = [&](size_t vertex) { return place_at(grid, vertex, time); };
        mesh.triangles.push_back({at(a), at(b), at(c)});
        if (!with_places) return;
        LightMesh::Place& place = mesh.places.emplace_back();
        for (size_t k = 0; const size_t vertex : {a, b, c}) {
            place.uv[k] = V2f(grid.u[vertex], grid.v[vertex]);
            place.st[k++] = V2f(grid.s[vertex], grid.t[vertex]);
        }
        place.dPdu = grid.dPdu.at(a), place.dPdv = grid.dPdv.at(a);
    };
    for (int place = 0; place < 256; ++place) {
        const int i = every_other_bit(place), j = every_other_bit(place >> 1);
        if (i >= grid.shape.nu || j >= grid.shape.nv) continue;
        std::array<size_t, 4> corners{};
        for (int k = 0; k < 4; ++k)
            corners[static_cast<size_t>(k)] =
                static_cast<size_t>(grid.shape.row_index(i + (k & 1), j + (k >> 1)));
        add(corners[0], corners[1], corners[2]);
        add(corners[3], corners[2], corners[1]);
    }
}

/// What of a light is a grid, where it is at a time of the shutter.
void add_grid(const ShadingGrid& grid, float time, bool with_places, LightMesh& mesh) {
    if (are_tubes(*grid.primitive))
        add_tubes(grid, time, mesh);
    else
        add_triangles(grid, time, with_places, mesh);
}

/// Dices a light's primitives.
class LightDicer {
  public:
    LightDicer(const LightScene& parts, const Shading& shading, const TessellationOptions& options)
        : parts_(parts), shading_(shading), tessellation_(parts.context, options) {}

    /// Calls use(grid, primitive) for each grid, the primitive by its number in the light's scene.
    template <class Use>
    void for_each_grid(const Use& use) {
        for (size_t i = 0; i < tessellation_.subpatches().size() && !parts_.context.is_cancelled(); ++i) {
            ShadingGrid* const grid = &grid_;
            tessellation_.dice(i, *grid, dice_);
            const uint32_t primitive = grid->primitive_index;
            grid->primitive_index = parts_.numbers[primitive];
            if (grid->primitive->attributes->displacement) shading_.displace({&grid, 1}, shade_);
            use(*grid, primitive);
        }
    }

  private:
    const LightScene& parts_;
    const Shading& shading_;
    const Tessellation tessellation_;
    DiceScratch dice_;
    ShadeScratch shade_;
    ShadingGrid grid_;
};

/// What of a light are balls, where they are at a time.
void add_balls_of(const RenderContext& of_frame, const LightInstance& light, float time, LightMesh& mesh) {
    for (const Primitive& primitive : of_frame.scene->primitives)
        if (primitive.emitter.get() == &light && are_balls(primitive)) add_balls(primitive, time, mesh);
}

/// Whether the light has balls that move.
bool balls_move(const RenderContext& of_frame, const LightInstance& light) {
    return of_frame.motion &&
           std::ranges::any_of(of_frame.scene->primitives, [&](const Primitive& primitive) {
               return primitive.emitter.get() == &light && are_balls(primitive) && primitive.key_count() > 1;
           });
}

/// The meshes of a light that moves, behind that at shutter open: all that has been diced, and the balls.
void add_parts_of_shutter(const RenderContext& of_frame, const Shading::MeshLight& light, LightDicer& dicer,
                          std::vector<LightMesh>& meshes) {
    const LightMesh& open = meshes.front();
    const size_t pieces = open.triangles.size() + open.tubes.size() + open.balls.size();
    const size_t parts = std::clamp<size_t>(
        static_cast<size_t>(kMostMicropolygons) / std::max<size_t>(pieces, 1), 2, kMostParts);
    meshes.resize(1 + parts);
    dicer.for_each_grid([&](const ShadingGrid& grid, uint32_t) {
        for (size_t part = 0; part < parts; ++part)
            add_grid(grid, middle_of_part(part, parts), light.asks_place, meshes[1 + part]);
    });
    for (size_t part = 0; part < parts; ++part)
        add_balls_of(of_frame, *light.light, middle_of_part(part, parts), meshes[1 + part]);
}

std::vector<LightMesh> meshes_of(const RenderContext& of_frame, const Shading::MeshLight& light,
                                 const Shading& shading, size_t most_bytes) {
    LightScene parts(of_frame, *light.light);
    std::vector<LightMesh> meshes(1);
    LightMesh& mesh = meshes.front();
    bool moves = balls_move(of_frame, *light.light);
    TessellationOptions options;
    options.depth_heights = shading.depth_heights();
    options.most_bytes = most_bytes, options.seen_by = SeenBy::Rays;
    for (int tries = 1; !of_frame.is_cancelled(); ++tries) {
        LightDicer dicer(parts, shading, options);
        std::vector<Turning> turnings(parts.scene.primitives.size());
        mesh = {};
        add_balls_of(of_frame, *light.light, 0, mesh);
        dicer.for_each_grid([&](const ShadingGrid& grid, uint32_t primitive) {
            add_grid(grid, 0, light.asks_place, mesh);
            moves |= grid.P.size() > 1;
            turnings[primitive].add(grid);
        });
        if (tries < kMostTries && refine(parts, turnings)) continue;
        if (moves) add_parts_of_shutter(of_frame, light, dicer, meshes);
        break;
    }
    return meshes;
}

}  // namespace

void make_light_meshes(const RenderContext& context, Shading& shading, size_t most_bytes) {
    const std::vector<Shading::MeshLight> lights = shading.mesh_lights();
    if (lights.empty()) return;
    // Rays meet the scene without the camera's motion, and at one time where none asks for others.
    RenderContext of_rays = context;
    of_rays.motion = rays_sample_motion(context);
    const std::unique_ptr<const Scene> held = of_rays.motion ? held_scene(*context.scene) : nullptr;
    if (held) of_rays.scene = held.get();
    LightMeshes meshes;
    for (const Shading::MeshLight& light : lights)
        meshes[light.light] = meshes_of(of_rays, light, shading, most_bytes);
    shading.set_light_meshes(meshes);
}

}  // namespace trapeze
