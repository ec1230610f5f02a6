/// Shading of whole grids of 16x16 micropolygons: vertices a second, through the room's door.

#include <benchmark/benchmark.h>

#include "shade/shading.h"

namespace trapeze {
namespace {

/// A grid that bends towards the viewer at z = 5 or so, in front of one primitive.
ShadingGrid bent_grid(const Scene& scene) {
    ShadingGrid grid;
    grid.shape = {16, 16};
    grid.primitive = &scene.primitives.front();
    const size_t count = grid.vertex_count();
    grid.P.resize(1);
    for (Triples* triples : {&grid.P[0], &grid.N, &grid.Ng, &grid.dPdu, &grid.dPdv}) triples->resize(count);
    grid.Cs.fill(count, V3f(0.8f, 0.5f, 0.2f));
    grid.Os.fill(count, V3f(1));
    for (int j = 0; j <= 16; ++j)
        for (int i = 0; i <= 16; ++i) {
            const float x = (static_cast<float>(i) - 8) / 16, y = (static_cast<float>(j) - 8) / 16;
            const V3f normal = V3f(x, y, -1).normalized();
            const size_t at = grid.shape.row_index(i, j);
            grid.P[0].set(at, V3f(x, y, 5 + (x * x + y * y) / 2));
            grid.N.set(at, normal), grid.Ng.set(at, normal);
            grid.dPdu.set(at, V3f(1, 0, x)), grid.dPdv.set(at, V3f(0, 1, y));
        }
    for (auto* plane : {&grid.u, &grid.v, &grid.s, &grid.t}) plane->assign(count, 0.5f);
    return grid;
}

Scene scene_with(const char* surface, const char* light, int lights, const char* displacement) {
    auto attributes = std::make_shared<Attributes>();
    ShaderInstance shader;
    shader.name = surface;
    attributes->surface = std::make_shared<ShaderInstance>(shader);
    if (displacement) {
        shader.name = displacement;
        attributes->displacement = std::make_shared<ShaderInstance>(shader);
    }
    for (int i = 0; i < lights; ++i) {
        auto instance = std::make_shared<LightInstance>();
        instance->shader.name = light;
        attributes->lights.push_back(instance);
    }
    Scene scene;
    scene.primitives.resize(1);
    scene.primitives[0].attributes = attributes;
    scene.primitives[0].camera_from_object = {M44f()};
    return scene;
}

void shade(benchmark::State& state, const char* surface, const char* light, int lights,
           const char* displacement) {
    const Scene scene = scene_with(surface, light, lights, displacement);
    RenderContext context;
    context.scene = &scene;
    const Shading shading(context);
    const ShadingGrid undisplaced = bent_grid(scene);
    ShadingGrid grid = undisplaced;
    ShadeScratch scratch;
    ShadeStats stats;
    for (auto _ : state) {
        if (displacement) grid.P = undisplaced.P;
        shading.shade(grid, scratch, stats);
        benchmark::DoNotOptimize(grid.Ci.c[0].data());
    }
    state.SetItemsProcessed(static_cast<int64_t>(stats.shaded_vertices));
}

void plastic_distant(benchmark::State& state) {
    shade(state, "plastic", "distantlight", 1, nullptr);
}
void plastic_spot(benchmark::State& state) {
    shade(state, "plastic", "spotlight", 1, nullptr);
}
void plastic_four_points(benchmark::State& state) {
    shade(state, "plastic", "pointlight", 4, nullptr);
}
void matte_distant(benchmark::State& state) {
    shade(state, "matte", "distantlight", 1, nullptr);
}
void dented_matte(benchmark::State& state) {
    shade(state, "matte", "distantlight", 1, "dented");
}

BENCHMARK(plastic_distant)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(plastic_spot)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(plastic_four_points)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(matte_distant)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(dented_matte)->Threads(1)->Threads(2)->UseRealTime();

}  // namespace
}  // namespace trapeze
