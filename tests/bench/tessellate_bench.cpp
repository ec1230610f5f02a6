/// Micropolygons a second from bound, split and dice with evaluation, on all the threads that TBB has; static
/// surfaces, one key. What limits it: evaluating positions and derivatives, then normals.
#include <benchmark/benchmark.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "tessellate/dicing_harness.h"

namespace trapeze {
namespace {

using testing::TestScene;

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

void set_picture(TestScene& scene) {
    scene.scene.options.width = 1280, scene.scene.options.height = 720;
}

std::shared_ptr<const Shape> bspline_torus(int nu, int nv) {
    PatchMesh mesh;
    mesh.bicubic = true;
    mesh.nu = nu, mesh.nv = nv;
    mesh.u_wraps = mesh.v_wraps = true;
    mesh.u_basis = mesh.v_basis = M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0) * (1 / 6.0f);
    mesh.u_step = mesh.v_step = 1;
    std::vector<float> P;
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const float theta = kTurn * static_cast<float>(i) / static_cast<float>(nu);
            const float phi = kTurn * static_cast<float>(j) / static_cast<float>(nv);
            const float r = 1 + 0.4f * std::cos(phi);
            P.insert(P.end(), {r * std::cos(theta), r * std::sin(theta), 0.4f * std::sin(phi)});
        }
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    return testing::shape_of(mesh, variables);
}

std::shared_ptr<const Shape> subdivision_torus(int nu, int nv) {
    const std::shared_ptr<const Shape> patches = bspline_torus(nu, nv);
    SubdivisionMesh mesh;
    mesh.vertex_count = nu * nv;
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const int i1 = (i + 1) % nu, j1 = (j + 1) % nv;
            mesh.vertices_per_face.push_back(4);
            mesh.vertices.insert(mesh.vertices.end(), {j * nu + i, j * nu + i1, j1 * nu + i1, j1 * nu + i});
        }
    return testing::shape_of(mesh, patches->variables);
}

TestScene& place(TestScene& scene, std::shared_ptr<const Shape> shape, int keys) {
    set_picture(scene);
    std::vector<M44f> matrices;
    for (int k = 0; k < keys; ++k) {
        M44f turn;
        turn.rotate(V3f(0.8f + 0.02f * static_cast<float>(k), 0, 0));
        matrices.push_back(turn * testing::translation(0, 0, 2.2f));
    }
    return scene.add({std::move(shape)}, matrices);
}

struct Worker {
    DiceScratch scratch;
    ShadingGrid grid;
};

void run(benchmark::State& state, TestScene& scene) {
    const RenderContext context = scene.context();
    tbb::enumerable_thread_specific<Worker> workers;
    int64_t micropolygons = 0;
    size_t bytes = 0, subpatches = 0;
    for (auto _ : state) {
        const Tessellation tessellation(context);
        workers.clear();
        tbb::parallel_for(size_t{0}, tessellation.subpatches().size(), [&](size_t i) {
            Worker& worker = workers.local();
            tessellation.dice(i, worker.grid, worker.scratch);
            benchmark::DoNotOptimize(worker.grid.P[0].c[0].data());
        });
        micropolygons += static_cast<int64_t>(tessellation.stats().micropolygons);
        bytes = tessellation.bytes(), subpatches = tessellation.subpatches().size();
    }
    state.SetItemsProcessed(micropolygons);  // micropolygons a second
    state.counters["subpatches"] = static_cast<double>(subpatches);
    state.counters["bytes_per_subpatch"] = static_cast<double>(bytes) / static_cast<double>(subpatches);
    state.counters["micropolygons_per_subpatch"] =
        static_cast<double>(micropolygons) / static_cast<double>(state.iterations() * subpatches);
}

void split_only(benchmark::State& state, TestScene& scene) {
    const RenderContext context = scene.context();
    int64_t micropolygons = 0;
    for (auto _ : state) micropolygons += static_cast<int64_t>(Tessellation(context).stats().micropolygons);
    state.SetItemsProcessed(micropolygons);
}

/// range(0): motion keys.
void sphere(benchmark::State& state) {
    TestScene scene;
    place(scene, testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360})),
          static_cast<int>(state.range(0)));
    run(state, scene);
}
BENCHMARK(sphere)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// range(0), range(1): control points along u, motion keys.
void patch_mesh(benchmark::State& state) {
    TestScene scene;
    const int n = static_cast<int>(state.range(0));
    place(scene, bspline_torus(n, n / 2), static_cast<int>(state.range(1)));
    run(state, scene);
}
BENCHMARK(patch_mesh)
    ->Args({20, 1})
    ->Args({20, 2})
    ->Args({400, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void subdivision_mesh(benchmark::State& state) {
    TestScene scene;
    const int n = static_cast<int>(state.range(0));
    place(scene, subdivision_torus(n, n / 2), static_cast<int>(state.range(1)));
    run(state, scene);
}
BENCHMARK(subdivision_mesh)
    ->Args({20, 1})
    ->Args({20, 2})
    ->Args({400, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Cubic hairs of one segment, four control points, that lie all over the picture; about a pixel wide.
std::shared_ptr<const Shape> hairs(int count, float length) {
    Curves curves;
    curves.cubic = true;
    curves.basis = M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0);
    curves.vertices_per_curve.assign(count, 4);
    std::vector<float> P;
    for (int i = 0; i < count; ++i) {
        // Low-discrepancy places and directions; the golden ratio and its square root's like.
        const auto part = [i](float step) { return std::fmod(static_cast<float>(i) * step, 1.0f); };
        const V3f root(3.4f * part(0.618034f) - 1.7f, 1.8f * part(0.754878f) - 0.9f, 0.5f * part(0.569840f));
        const float angle = kTurn * part(0.466921f);
        for (int k = 0; k < 4; ++k) {
            const float along = length * static_cast<float>(k) / 3,
                        turn = angle + 0.2f * static_cast<float>(k);
            const V3f p = root + V3f(std::cos(turn), std::sin(turn), 0.3f) * along;
            P.insert(P.end(), {p.x, p.y, p.z});
        }
    }
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    variables.set(testing::parameter("constantwidth", StorageClass::Constant, ValueType::Float, {0.003f}));
    return testing::shape_of(curves, variables);
}

/// range(0), range(1): hundredths of the picture's height that a hair is long, motion keys.
void curves(benchmark::State& state) {
    TestScene scene;
    place(scene, hairs(20000, 0.02f * static_cast<float>(state.range(0))), static_cast<int>(state.range(1)));
    run(state, scene);
}
BENCHMARK(curves)
    ->Args({1, 1})
    ->Args({4, 1})
    ->Args({4, 2})
    ->Args({16, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// range(0): motion keys.
void points(benchmark::State& state) {
    std::vector<float> P;
    for (int i = 0; i < 100000; ++i) {
        const auto part = [i](float step) { return std::fmod(static_cast<float>(i) * step, 1.0f); };
        P.insert(P.end(),
                 {3.4f * part(0.618034f) - 1.7f, 1.8f * part(0.754878f) - 0.9f, 0.5f * part(0.569840f)});
    }
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    variables.set(testing::parameter("constantwidth", StorageClass::Constant, ValueType::Float, {0.01f}));
    TestScene scene;
    place(scene, testing::shape_of(Points{100000}, variables), static_cast<int>(state.range(0)));
    run(state, scene);
}
BENCHMARK(points)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void split_sphere(benchmark::State& state) {
    TestScene scene;
    place(scene, testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360})), 1);
    split_only(state, scene);
}
BENCHMARK(split_sphere)->Unit(benchmark::kMillisecond)->UseRealTime();

void split_subdivision(benchmark::State& state) {
    TestScene scene;
    place(scene, subdivision_torus(400, 200), 1);
    split_only(state, scene);
}
BENCHMARK(split_subdivision)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace trapeze
