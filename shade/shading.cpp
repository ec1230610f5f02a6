#include "shade/shading.h"

#include <fmt/format.h>

#include "shade/displace.h"
#include "shade/material.h"

namespace trapeze {
namespace {

/// A bound met but for rounding is kept.
constexpr float kBoundTolerance = 1.0001f;

void raise(std::atomic<float>& maximum, float value) {
    float seen = maximum.load(std::memory_order_relaxed);
    while (value > seen && !maximum.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {}
}

void store(const Plane3& planes, size_t vertices, Triples& out) {
    for (int k = 0; k < 3; ++k) out.c[k].assign(planes[k].begin(), planes[k].begin() + vertices);
}

}  // namespace

struct ShadeScratch::State {
    PlanePool pool;
};

ShadeScratch::ShadeScratch() : state(std::make_unique<State>()) {}
ShadeScratch::ShadeScratch(ShadeScratch&&) noexcept = default;
ShadeScratch& ShadeScratch::operator=(ShadeScratch&&) noexcept = default;
ShadeScratch::~ShadeScratch() = default;

struct Shading::Impl {
    explicit Impl(const RenderContext& render) : context(render), materials(render) {}

    const RenderContext& context;
    Materials materials;
};

Shading::Shading(const RenderContext& context) : impl_(std::make_unique<Impl>(context)) {}
Shading::~Shading() = default;

void Shading::shade(ShadingGrid& grid, ShadeScratch& scratch, ShadeStats& stats) const {
    const Camera& camera = impl_->context.camera;
    const Material& material = impl_->materials.of(grid.primitive_index);
    PlanePool& pool = scratch.state->pool;
    const size_t vertices = grid.vertex_count();
    if (material.displacement)
        raise(material.displacement_reach, displace_grid(*material.displacement, camera, grid, pool));

    pool.start(vertices);
    ShaderInput input(grid, camera, pool);
    Illumination lights(material.lights, input.P(), pool);
    const Plane3 Ci = pool.take3(), Oi = pool.take3();
    material.surface->shade(input, lights, Ci, Oi);
    store(Ci, vertices, grid.Ci);
    store(Oi, vertices, grid.Oi);
    stats.shaded_vertices += vertices;
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
