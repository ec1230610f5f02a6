#include "shade/shading.h"

#include <fmt/format.h>

#include "shade/displace.h"
#include "shade/grid_messages.h"
#include "shade/grid_shader.h"
#include "shade/map_service.h"
#include "shade/material.h"
#include "shade/take_aovs.h"

namespace trapeze {
namespace {

/// A bound met but for rounding is kept.
constexpr float kBoundTolerance = 1.0001f;

void raise(std::atomic<float>& maximum, float value) {
    float seen = maximum.load(std::memory_order_relaxed);
    while (value > seen && !maximum.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {}
}

}  // namespace

struct ShadeScratch::State {
    PlanePool pool;
    vm::Machine machine;
    LightRig lights;
};

ShadeScratch::ShadeScratch() : state(std::make_unique<State>()) {}
ShadeScratch::ShadeScratch(ShadeScratch&&) noexcept = default;
ShadeScratch& ShadeScratch::operator=(ShadeScratch&&) noexcept = default;
ShadeScratch::~ShadeScratch() = default;

struct Shading::Impl {
    explicit Impl(const RenderContext& render)
        : context(render),
          textures(render.scene->options, render.diagnostics),
          materials(render),
          aovs(aov_layout(render.scene->options)) {
        if (render.diagnostics)
            report_missing_aovs(aovs, materials, render.scene->options, *render.diagnostics);
    }

    const RenderContext& context;
    Textures textures;
    Materials materials;
    AovLayout aovs;
};

namespace {

/// The shaders of one grid, one after the other.
class GridRun {
  public:
    GridRun(const RenderContext& context, Textures& textures, const Material& material, ShadingGrid& grid,
            PlanePool& pool, vm::Machine& machine, LightRig& lights)
        : context_(context),
          material_(material),
          grid_(grid),
          pool_(pool),
          machine_(machine),
          lights_(lights),
          maps_(textures, *context.scene),
          messages_(context),
          points_(points_of(grids())) {
        messages_.attributes = material.attributes;
        messages_.lights = &lights_;
    }

    /// `aovs` are those that the grid is to carry.
    void run(const AovLayout& aovs) {
        if (material_.displacement) displace();
        for (int k = 0; k < 3; ++k) grid_.Ci.c[k] = grid_.Cs.c[k], grid_.Oi.c[k] = grid_.Os.c[k];
        color(*material_.surface, false, messages_.surface);
        if (material_.atmosphere) color(*material_.atmosphere, true, messages_.atmosphere);
        if (!aovs.empty()) take_aovs(aovs, *messages_.surface, writable_grids());
    }

  private:
    std::span<ShadingGrid* const> writable_grids() { return {&grid_pointer_, 1}; }
    std::span<const ShadingGrid* const> grids() { return {&const_grid_pointer_, 1}; }

    /// The shader's frame after it has run.
    vm::Frame& run_shader(const BoundShader& shader, bool shaded, const vm::Frame*& announced) {
        vm::Frame& frame = machine_.frame(shader.executable());
        frame.start(points_.lanes);
        shader.set_parameters(frame, grids());
        set_variables(frame, grids(), context_, shaded);
        announced = &frame;
        messages_.running = shader.program().name;
        const SceneSpaces spaces(*context_.scene, context_.camera, &shader.instance(), grid_.primitive);
        vm::Context surroundings;
        surroundings.points = &points_;
        surroundings.spaces = &spaces;
        surroundings.maps = &maps_;
        surroundings.lights = &lights_;
        surroundings.messages = &messages_;
        surroundings.diagnostics = context_.diagnostics;
        surroundings.near_clip = context_.camera.near_clip, surroundings.far_clip = context_.camera.far_clip;
        lights_.start(machine_, material_.lights, surroundings, points_.lanes, variable_planes(frame, "N"));
        machine_.run(frame, surroundings);
        return frame;
    }

    void displace() {
        const BoundShader& shader = *material_.displacement;
        const vm::Frame& frame = run_shader(shader, false, messages_.displacement);
        Displaced displaced;
        if (writes_variable(shader.program(), "N")) displaced.N = variable_planes(frame, "N");
        if (!writes_variable(shader.program(), "P")) {
            // Bumps: the surface stays, and shades as if it did not.
            for (int k = 0; k < 3 && displaced.N.size(); ++k)
                grid_.N.c[k].assign(
                    displaced.N[k].begin(),
                    displaced.N[k].begin() + static_cast<std::ptrdiff_t>(grid_.vertex_count()));
            return;
        }
        displaced.P = variable_planes(frame, "P");
        raise(material_.displacement_reach, displace_grid(displaced, grid_, pool_));
    }

    void color(const BoundShader& shader, bool shaded, const vm::Frame*& announced) {
        take_colors(run_shader(shader, shaded, announced), writable_grids());
    }

    const RenderContext& context_;
    const Material& material_;
    ShadingGrid& grid_;
    ShadingGrid* grid_pointer_ = &grid_;
    const ShadingGrid* const_grid_pointer_ = &grid_;
    PlanePool& pool_;
    vm::Machine& machine_;
    LightRig& lights_;
    MapService maps_;
    GridMessages messages_;
    vm::Points points_;
};

}  // namespace

Shading::Shading(const RenderContext& context) : impl_(std::make_unique<Impl>(context)) {}
Shading::~Shading() = default;

void Shading::shade(ShadingGrid& grid, ShadeScratch& scratch, ShadeStats& stats) const {
    ShadeScratch::State& state = *scratch.state;
    const Material& material = impl_->materials.of(grid.primitive_index);
    GridRun(impl_->context, impl_->textures, material, grid, state.pool, state.machine, state.lights)
        .run(impl_->aovs);
    stats.shaded_vertices += grid.vertex_count();
}

void Shading::report_displacement_bounds() const {
    Diagnostics* diagnostics = impl_->context.diagnostics;
    if (!diagnostics) return;
    for (const Material& material : impl_->materials.all()) {
        const float bound = material.attributes->displacement_bound;
        const float reach = material.displacement_reach.load(std::memory_order_relaxed);
        if (reach <= bound * kBoundTolerance) continue;
        std::string needed = fmt::format("a bound of {:.4g} in camera space is needed", reach);
        const auto given = material.attributes->user.find("displacementbound");
        const float sphere =
            given == material.attributes->user.end() ? 0 : given->second.float_or("sphere", 0);
        if (sphere > 0 && bound > 0)
            needed = fmt::format("\"sphere\" {:.4g} is needed where {:.4g} is given", sphere * reach / bound,
                                 sphere);
        const ShaderInstance& shader = *material.attributes->displacement;
        diagnostics->warning(
            shader.location,
            fmt::format("Displacement \"{}\" moves the surface beyond Attribute \"displacementbound\", and "
                        "parts may be missing: {}",
                        shader.name, needed));
    }
}

}  // namespace trapeze
