#include "shade/shading.h"

#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "shade/answer_hits.h"
#include "shade/area_lights.h"
#include "shade/clouds/cloud_bakes.h"
#include "shade/clouds/cloud_library.h"
#include "shade/clouds/scene_surfels.h"
#include "shade/grid_run.h"
#include "shade/materials/named_maps.h"
#include "shade/materials/sent_names.h"
#include "shade/rays/ray_programs.h"
#include "shade/take_aovs.h"

namespace trapeze {
namespace {

/// Whether shaders that run on a material's surfaces say or write anything besides their outputs.
bool any_leaves_traces(const Material& material) {
    const auto any = [](const LayeredShader* shader) {
        return shader && std::ranges::any_of(shader->layers, [](const BoundShader* layer) {
                   return leaves_traces(layer->program());
               });
    };
    return any(material.surface) || any(material.atmosphere) ||
           std::ranges::any_of(material.lights,
                               [](const Lamp* lamp) { return leaves_traces(lamp->shader->program()); });
}

/// Whether what rays tell a vertex stays with it.
bool tells_vertices_apart(const Material& material) {
    const auto keeps = [](const LayeredShader* shader) {
        return !shader ||
               (shader->layers.size() == 1 && keeps_answers_apart(shader->layers.front()->program()));
    };
    return keeps(material.surface) && keeps(material.atmosphere) && keeps(material.interior) &&
           keeps(material.exterior) && std::ranges::all_of(material.lights, [](const Lamp* lamp) {
               return keeps_answers_apart(lamp->shader->program());
           });
}

/// Displacement beyond the bound by this factor is not reported: it is rounding.
constexpr float kBoundTolerance = 1.0001f;

/// Whether a shader leaves what is opaque as it is.
bool leaves_opaque(const LayeredShader& shader) {
    return std::ranges::all_of(shader.layers,
                               [](const BoundShader* layer) { return keeps_opaque(layer->program()); });
}

/// Whether nothing shines through a primitive, whatever its surface shader does.
bool is_opaque(const Primitive& primitive, const LayeredShader& surface) {
    const bool own = primitive.attributes->opacity == V3f(1, 1, 1) &&
                     (primitive.shape_keys.empty() || !primitive.shape().variables.find("Os"));
    return own && leaves_opaque(surface);
}

}  // namespace

struct ShadeScratch::State {
    GridRunScratch run;
    std::vector<ShadingGrid*> batch;
    RayWalkScratch hits;
    std::unique_ptr<ShadeScratch> deeper;  ///< for hits of the rays of what is shaded with this one
};

ShadeScratch::ShadeScratch() : state(std::make_unique<State>()) {}
ShadeScratch::ShadeScratch(ShadeScratch&&) noexcept = default;
ShadeScratch& ShadeScratch::operator=(ShadeScratch&&) noexcept = default;
ShadeScratch::~ShadeScratch() = default;

struct Shading::Impl {
    explicit Impl(const RenderContext& render, const Access& may)
        : context(render),
          access(may),
          textures(render.scene->options, render.diagnostics, may, render.colors),
          clouds(render.scene->options, render.diagnostics, may),
          materials(render, may),
          aovs(aov_layout(render.scene->options)),
          volumes(render.scene->primitives) {
        make_samplers(materials, textures, render);
        if (render.diagnostics)
            report_missing_aovs(aovs, materials, render.scene->options, *render.diagnostics);
        for (uint32_t i = 0; i < render.scene->primitives.size(); ++i)
            volumes.add(i, materials.of(i).interior, materials.of(i).exterior);
        for (const Material& material : materials.all())
            if (tells_vertices_apart(material)) apart.insert(&material);
    }

    Task<> shade(std::span<ShadingGrid* const> grids, ShadeScratch& scratch, ShadeStats& stats, int depth,
                 const HitVisit& visit, bool of_discs = false) const;
    ShadeSurfels surfel_shader() const;
    void take_surfel_stats(ShadeStats& stats) const;

    std::vector<const BoundShader*> asking_shaders() const;
    bool gives_traced_map() const;

    const RenderContext& context;
    const Access& access;
    mutable Textures textures;             ///< thread-safe
    mutable CloudLibrary clouds;           ///< thread-safe
    mutable CloudBakes bakes;              ///< thread-safe
    mutable SceneSurfels surfels{clouds};  ///< thread-safe
    mutable std::mutex surfel_mutex;
    mutable ShadeStats surfel_stats;  ///< of shading discs, until a call takes them for its own
    Materials materials;
    AovLayout aovs;
    VolumeTable volumes;
    std::set<const Material*> apart;  ///< tells_vertices_apart()
    size_t batch_vertices() const {
        constexpr size_t kFew = 256, kMany = 4096, kRaysOfVertex = 16;
        return rays ? std::clamp(rays->rays_at_once() / kRaysOfVertex, kFew, kMany) : kFew;
    }

    const RayScene* rays = nullptr;
    size_t known_endless = 0;  ///< endless shaders at the last found_endless_loops()
};

Shading::Shading(const RenderContext& context, const Access& access)
    : impl_(std::make_unique<Impl>(context, access)) {}
Shading::~Shading() = default;

void Shading::shade(ShadingGrid& grid, ShadeScratch& scratch, ShadeStats& stats) const {
    ShadingGrid* const one[] = {&grid};
    shade(one, scratch, stats);
}

void Shading::shade(std::span<ShadingGrid* const> grids, ShadeScratch& scratch, ShadeStats& stats) const {
    impl_->shade(grids, scratch, stats, 0, {}).get();
    impl_->take_surfel_stats(stats);
}

void Shading::Impl::take_surfel_stats(ShadeStats& stats) const {
    const std::lock_guard lock(surfel_mutex);
    stats += std::exchange(surfel_stats, {});
}

/// For one thread, which has a scratch of its own: it may be in the midst of shading.
ShadeSurfels Shading::Impl::surfel_shader() const {
    return [this, scratch = std::make_shared<ShadeScratch>()](std::span<ShadingGrid* const> grids,
                                                              const HitVisit& visit) {
        if (context.is_cancelled()) return;
        ShadeStats stats;
        shade(grids, *scratch, stats, 1, visit, true).get();
        const std::lock_guard lock(surfel_mutex);
        surfel_stats += stats;
    };
}

/// `depth`: bounces of rays between the camera and the grids, which are visited by the last of them. What
/// rays hit has no output variables. `of_discs`: all this is of the scene's discs.
Task<> Shading::Impl::shade(std::span<ShadingGrid* const> grids, ShadeScratch& scratch, ShadeStats& stats,
                            int depth, const HitVisit& visit, bool of_discs) const {
    if (!visit.shades) co_return answer_hits(*visit.outputs, {}, {}, {}, grids);
    ShadeScratch::State& state = *scratch.state;
    RayService service;
    if (rays) {
        service.scene = rays;
        service.shade = [&](std::span<ShadingGrid* const> hits, const HitVisit& of_hits) {
            if (!state.deeper) state.deeper = std::make_unique<ShadeScratch>();
            return shade(hits, *state.deeper, stats, depth + 1, of_hits, of_discs);
        };
        service.depth = depth;
        service.visit = visit;
        service.seed = context.seed;
        service.held_from_camera = context.scene->held_from_camera;
        service.max_depth = context.scene->options.max_ray_depth;
        service.volumes = &volumes;
        service.scratch = &state.hits;
        service.stats = &stats.rays;
    }
    std::vector<ShadingGrid*>& batch = state.batch;
    for (size_t first = 0; first < grids.size();) {
        const Material& material = materials.of(grids[first]->primitive_index);
        const RayMedium& medium = grids[first]->medium;
        const Material* const left =
            medium.primitive != RayMedium::kNone ? &materials.of(medium.primitive) : nullptr;
        batch.clear();
        size_t vertices = 0, next = first;
        const size_t most = known_endless ? 1 : batch_vertices();
        for (; next < grids.size() && (batch.empty() || vertices < most); ++next) {
            ShadingGrid& grid = *grids[next];
            if (&materials.of(grid.primitive_index) != &material ||
                !can_share_run(material, left, *grids[first], grid))
                break;
            batch.push_back(&grid);
            vertices += grid.vertex_count();
        }
        GridRun run(context, textures, material, batch, state.run, rays ? &service : nullptr,
                    {&clouds, depth == 0 ? &bakes : nullptr, &surfels, of_discs}, left);
        const AovLayout none;
        co_await run.run(depth == 0 ? aovs : none, visit.outputs);
        stats.shaded_vertices += vertices;
        first = next;
    }
}

/// The shaders that may ask for rays.
std::vector<const BoundShader*> Shading::Impl::asking_shaders() const {
    std::set<std::string> varied = variables_of(*context.scene);
    // What area lights' shaders are told of each sample (LightRig).
    varied.insert({"__solidangle", "__radiance", "__area"});
    // What illuminance gives to lights.
    varied.insert(materials.sent_names().begin(), materials.sent_names().end());
    // What connections bring to layers is not known here.
    std::set<const BoundShader*> connected;
    for (const Material& material : materials.all())
        for (const LayeredShader* shader : {material.surface, material.displacement, material.atmosphere})
            if (shader && shader->layers.size() > 1)
                connected.insert(shader->layers.begin(), shader->layers.end());
    const std::vector<const BoundShader*> shaders = materials.shaders();
    std::set<const BoundShader*> of_area_lights, told;
    for (const Lamp* lamp : materials.lamps()) {
        if (lamp->area) of_area_lights.insert(lamp->shader.get());
        if (lamp->told && gives_traced_map()) told.insert(lamp->shader.get());
    }
    const bool any_seen = std::ranges::any_of(context.scene->primitives, [](const Primitive& primitive) {
        return primitive.attributes->rays.seen();
    });
    std::vector<const BoundShader*> asking;
    std::ranges::copy_if(shaders, std::back_inserter(asking), [&](const BoundShader* shader) {
        return asks_for_rays(*shader, connected.contains(shader) ? nullptr : &varied,
                             told.contains(shader)) &&
               (any_seen || !of_area_lights.contains(shader));
    });
    return asking;
}

/// Whether what is sent to lights may be the name of rays for that of a shadow map.
bool Shading::Impl::gives_traced_map() const {
    return std::ranges::any_of(materials.shaders(), [](const BoundShader* shader) {
        std::set<std::string> names;
        add_sent_names(shader->program(), names);
        return !names.empty() && knows_traced_map(*shader);
    });
}

bool Shading::asks_rays() const {
    return !impl_->asking_shaders().empty();
}

bool Shading::asks_clouds_alone() const {
    return !impl_->gives_traced_map() &&
           std::ranges::all_of(impl_->asking_shaders(),
                               [](const BoundShader* shader) { return trapeze::asks_clouds_alone(*shader); });
}

std::vector<Shading::MeshLight> Shading::mesh_lights() const {
    std::vector<MeshLight> lights;
    for (const Lamp* lamp : impl_->materials.lamps())
        if (is_mesh_light(*lamp)) lights.push_back({lamp->area, lamp->asks_place});
    return lights;
}

void Shading::set_light_meshes(const LightMeshes& meshes) {
    make_mesh_samplers(impl_->materials, meshes, impl_->context.diagnostics);
}

size_t Shading::batch_vertices() const {
    return impl_->batch_vertices();
}

void Shading::set_rays(const RayScene* rays) {
    impl_->rays = rays;
    impl_->surfels.set_scene(rays, [impl = impl_.get()] { return impl->surfel_shader(); });
}

void Shading::displace(std::span<ShadingGrid* const> grids, ShadeScratch& scratch) const {
    for (ShadingGrid* grid : grids) {
        const Material& material = impl_->materials.of(grid->primitive_index);
        if (material.attributes->rays.displaced)
            GridRun(impl_->context, impl_->textures, material, {&grid, 1}, scratch.state->run, nullptr,
                    {&impl_->clouds, nullptr, nullptr, false})
                .run_displacement()
                .get();
        grid->Ci = grid->Cs, grid->Oi = grid->Os;
    }
}

bool Shading::keeps_opacity(uint32_t primitive) const {
    const Material& material = impl_->materials.of(primitive);
    const RayAttributes& rays = material.attributes->rays;
    using HitMode = RayAttributes::HitMode;
    return (rays.transmission_hits != HitMode::Shader && rays.diffuse_hits != HitMode::Shader) ||
           std::ranges::none_of(material.surface->layers,
                                [](const BoundShader* layer) { return changes_opacity(layer->program()); }) ||
           is_opaque(impl_->context.scene->primitives[primitive], *material.surface);
}

bool Shading::may_stay_unshaded(uint32_t primitive) const {
    const Material& material = impl_->materials.of(primitive);
    // Where a ray crosses parts of a solid that it does not see tells what it sees of the solid.
    if (impl_->context.scene->primitives[primitive].solid >= 0) return false;
    // A surface that says P may move it; one that only says so is warned about, which takes that it runs.
    return material.attributes->cull_hidden && !material.displacement && !material.surface_moves &&
           !material.surface_only_sets_P && !any_leaves_traces(material);
}

bool Shading::may_ask_for_some(uint32_t primitive) const {
    return impl_->apart.contains(&impl_->materials.of(primitive));
}

bool Shading::hides_for_sure(uint32_t primitive) const {
    const Material& material = impl_->materials.of(primitive);
    return is_opaque(impl_->context.scene->primitives[primitive], *material.surface) &&
           (!material.atmosphere || leaves_opaque(*material.atmosphere));
}

bool Shading::can_be_parted(const ShadingGrid& grid) const {
    return !impl_->known_endless && impl_->materials.of(grid.primitive_index).shades_vertices_apart;
}

bool Shading::found_endless_loops() {
    const size_t known = std::exchange(impl_->known_endless, impl_->materials.endless_count());
    if (impl_->known_endless > known) impl_->bakes.clear(), impl_->surfels.forget_colors();
    return impl_->known_endless > known;
}

void Shading::limit_clouds(size_t bytes) {
    impl_->clouds.set_limit(bytes), impl_->bakes.set_limit(bytes);
}

void Shading::write_bakes() {
    if (!impl_->context.diagnostics) return;
    const Scene& scene = *impl_->context.scene;
    impl_->bakes.write({scene.camera_from_world, screen_from_camera(impl_->context.camera),
                        static_cast<float>(scene.options.width), static_cast<float>(scene.options.height)},
                       impl_->access, *impl_->context.diagnostics);
}

bool Shading::may_bake() const {
    return std::ranges::any_of(impl_->materials.shaders(), [](const BoundShader* shader) {
        return std::ranges::any_of(shader->program().code,
                                   [](const rsl::Instruction& i) { return i.op == rsl::Op::Bake3d; });
    });
}

void Shading::leave_out_bakes() {
    if (impl_->context.diagnostics) impl_->bakes.leave_out(*impl_->context.diagnostics);
}

FindDepthHeight Shading::depth_heights() const {
    return [impl = impl_.get()](const std::string& name, SourceLocation location) {
        return impl->textures.height_over(name, location, impl->context.scene->camera_from_world);
    };
}

std::function<bool(uint32_t)> Shading::displacing_surfaces() const {
    return [impl = impl_.get()](uint32_t primitive) {
        return impl->materials.of(primitive).surface_displaces();
    };
}

void Shading::report_displacement_bounds() const {
    Diagnostics* diagnostics = impl_->context.diagnostics;
    if (!diagnostics) return;
    for (const Material& material : impl_->materials.all()) {
        const float bound = material.attributes->displacement_bound;
        const float reach = material.displacement_reach.load(std::memory_order_relaxed);
        if (reach <= bound * kBoundTolerance) continue;
        if (material.surface_only_sets_P) {
            const ShaderInstance& shader = material.surface->last().instance();
            diagnostics->warning(
                shader.location,
                fmt::format("Surface \"{}\" sets P: the surface is not displaced, since there "
                            "is no Attribute \"displacementbound\" (a bound of {:.4g} in camera "
                            "space is needed)",
                            shader.name, reach),
                "surface-moves " + shader.name);
            continue;
        }
        std::string needed = fmt::format("a bound of {:.4g} in camera space is needed", reach);
        const float sphere = material.attributes->user.float_or("displacementbound", "sphere", 0);
        if (sphere > 0 && bound > 0)
            needed = fmt::format("\"sphere\" {:.4g} is needed where {:.4g} is given", sphere * reach / bound,
                                 sphere);
        const bool by_surface = !material.displacement;
        const ShaderInstance& shader =
            (by_surface ? material.surface : material.displacement)->last().instance();
        diagnostics->warning(
            shader.location,
            fmt::format("{} \"{}\" moves the surface beyond Attribute \"displacementbound\", and "
                        "parts may be missing: {}",
                        by_surface ? "Surface" : "Displacement", shader.name, needed));
    }
}

}  // namespace trapeze
