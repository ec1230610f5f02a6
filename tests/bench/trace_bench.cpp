/// The ray tracer on a synthetic scene of a chosen number of micropolygons, 1280x720 at 8x8 samples, circles
/// of confusion up to 30 pixels: build, trace, counts and memory.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <random>

#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

enum Effects { kStill = 0, kMotion = 1, kDefocus = 2 };

/// Bumpy balls over a ground that runs under the camera, in grids of 16 x 16 micropolygons; with motion the
/// balls fly and turn.
void add_scene(GridMaker& maker, int micropolygons, bool motion) {
    constexpr int kBalls = 24, kSide = kMaxGridSide;
    std::mt19937 engine(1);
    const auto random = [&](float from, float to) {
        return std::uniform_real_distribution<float>(from, to)(engine);
    };
    const int patches =
        std::max(1, static_cast<int>(std::sqrt(micropolygons / (kBalls + 4.0) / (kSide * kSide) / 2)));
    for (int ball = 0; ball < kBalls; ++ball) {
        const V3f centre(random(-5, 5), random(-1.5f, 2.5f), random(5, 16));
        const V3f shift(random(-0.6f, 0.6f), random(-0.6f, 0.6f), random(-0.3f, 0.3f));
        const float radius = random(0.5f, 1.1f), turn = motion ? random(-0.5f, 0.5f) : 0.0f;
        for (int pu = 0; pu < 2 * patches; ++pu)
            for (int pv = 0; pv < patches; ++pv)
                maker.add(kSide, kSide, motion ? 2 : 1, [&](int i, int j, float t) {
                    const float u =
                        static_cast<float>(pu * kSide + i) / static_cast<float>(2 * patches * kSide);
                    const float v = static_cast<float>(pv * kSide + j) / static_cast<float>(patches * kSide);
                    const float phi = 6.2831853f * u + turn * t, theta = 3.1415927f * v;
                    const float r = radius * (1 + 0.05f * std::sin(20 * theta) * std::sin(15 * phi));
                    const V3f p(r * std::sin(theta) * std::cos(phi), r * std::cos(theta),
                                r * std::sin(theta) * std::sin(phi));
                    return centre + p + (motion ? shift * t : V3f(0));
                });
    }
    const int ground = 2 * patches * 2;
    for (int px = 0; px < ground; ++px)
        for (int pz = 0; pz < ground / 2; ++pz)
            maker.add(kSide, kSide, 1, [&](int i, int j, float) {
                const float u = static_cast<float>(px * kSide + i) / static_cast<float>(ground * kSide);
                const float v = static_cast<float>(pz * kSide + j) / static_cast<float>(ground / 2 * kSide);
                return V3f((u - 0.5f) * 40, -2.5f, v * 30 - 3);
            });
}

struct BenchScene {
    TestFrame frame;
    GridMaker maker;

    BenchScene(int micropolygons, int effects) : frame(1280, 720, 8, effects & kMotion, effects & kDefocus) {
        if (effects & kDefocus) {
            frame.options.f_stop = 2, frame.options.focal_length = 1, frame.options.focal_distance = 9;
            frame.update();
        }
        add_scene(maker, micropolygons, effects & kMotion);
    }
};

/// Seconds of the tree alone, on all threads.
void build(benchmark::State& state, const char* method_name) {
    const BenchScene scene(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    const StratifiedPattern pattern(scene.frame.context);
    std::string error;
    const auto sampler = choose_sampler(method_name, "", &error);
    if (!sampler) return state.SkipWithError(error.c_str());
    const auto count = static_cast<double>(scene.maker.grids().micropolygon_count());
    BuildStats stats;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        const auto method = sampler->prepare(scene.frame.context, scene.maker.grids());
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        stats = method->build_stats();
        state.SetIterationTime(taken.count() - stats.setup_seconds);
    }
    state.counters["mpolys"] = count;
    state.counters["setup_ms"] = 1000 * stats.setup_seconds;
    state.counters["tree_bytes/mpoly"] = static_cast<double>(stats.tree_bytes) / count;
    state.counters["grid_bytes/mpoly"] = static_cast<double>(scene.maker.grids().bytes()) / count;
    state.counters["mpolys/s"] = benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
}

/// Every 37th tile of the picture on one thread, samples made before.
void trace(benchmark::State& state, const char* method_name) {
    const BenchScene scene(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    const StratifiedPattern pattern(scene.frame.context);
    std::string error;
    const auto sampler = choose_sampler(method_name, "", &error);
    if (!sampler) return state.SkipWithError(error.c_str());
    const auto method = sampler->prepare(scene.frame.context, scene.maker.grids());
    const auto all = testing::tiles_of({0, 0, 1280, 720});
    std::vector<SampleTile> tiles;
    for (size_t i = 0; i < all.size(); i += 37) pattern.make_tile(all[i], tiles.emplace_back());
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
    for (auto _ : state)
        for (const SampleTile& tile : tiles) method->resolve(tile, hits, scratch, stats);
    const auto rays = static_cast<double>(stats.rays);
    state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
    state.counters["nodes/ray"] = static_cast<double>(stats.nodes_visited) / rays;
    state.counters["leaves/ray"] = static_cast<double>(stats.leaves_visited) / rays;
    state.counters["tests/ray"] = static_cast<double>(stats.predicate_tests) / rays;
    state.counters["tests/hit"] =
        static_cast<double>(stats.predicate_tests) / static_cast<double>(stats.predicate_hits);
}

void make_samples(benchmark::State& state) {
    const TestFrame frame(1280, 720, 8, state.range(0) & kMotion, state.range(0) & kDefocus);
    const StratifiedPattern pattern(frame.context);
    SampleTile tile;
    size_t samples = 0;
    for (auto _ : state) {
        pattern.make_tile({64, 64, 80, 80}, tile);
        benchmark::DoNotOptimize(tile.rays.data());
        samples += tile.size();
    }
    state.counters["samples/s"] =
        benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}

void build_arguments(benchmark::internal::Benchmark* bench) {
    bench->ArgsProduct({{2'000'000}, {kStill, kMotion}})
        ->ArgNames({"mpolys", "effects"})
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(build, raytrace, "raytrace")->Apply(build_arguments);
BENCHMARK_CAPTURE(build, raytrace_paper, "raytrace:tree=paper")->Apply(build_arguments);
BENCHMARK_CAPTURE(build, embree, "embree")->Apply(build_arguments);
BENCHMARK_CAPTURE(build, embree_quad, "embree:geometry=quad")->Apply(build_arguments);
BENCHMARK_CAPTURE(build, embree_low, "embree:quality=low")->Apply(build_arguments);

void trace_arguments(benchmark::internal::Benchmark* bench) {
    bench->ArgsProduct({{500'000, 2'000'000}, {kStill, kMotion, kDefocus, kMotion | kDefocus}})
        ->ArgNames({"mpolys", "effects"})
        ->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(trace, raytrace, "raytrace")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_1, "embree:mode=1")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_8, "embree:mode=8")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_16, "embree:mode=16")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_stream, "embree:mode=stream")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_quad_1, "embree:geometry=quad,mode=1")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_quad_16, "embree:geometry=quad,mode=16")->Apply(trace_arguments);
BENCHMARK_CAPTURE(trace, embree_quad_stream, "embree:geometry=quad,mode=stream")->Apply(trace_arguments);
BENCHMARK(make_samples)->Arg(kStill)->Arg(kMotion | kDefocus)->ArgName("effects");

}  // namespace
}  // namespace trapeze
