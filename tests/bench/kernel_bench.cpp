/// The grid machine's kernels on a grid of 16x16 micropolygons: processor time for each vertex ("vertex") and
/// vertices a second. All inputs are varying.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <random>

#include "shade/vm/kernels/color.h"
#include "shade/vm/kernels/kernel.h"
#include "shade/vm/kernels/light_kernels.h"
#include "shade/vm/kernels/neighbours.h"
#include "shade/vm/kernels/spline.h"
#include "tests/bench/fused_plastic.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

constexpr size_t kVertices = 17 * 17, kLanesOfGrid = padded_size(kVertices);

/// Planes of random numbers for operands of some widths.
class Planes {
  public:
    Planes(const std::vector<int>& widths, float low, float high) {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> number(low, high);
        size_t planes = 0;
        for (int width : widths) planes += static_cast<size_t>(width);
        memory_ = std::make_unique<Group[]>(planes * kLanesOfGrid / kLanes);
        float* next = memory_[0].lanes;
        for (size_t i = 0; i < planes * kLanesOfGrid; ++i) next[i] = number(random);
        for (int width : widths) {
            Operand& o = operands.emplace_back();
            o.data = next, o.lane_mask = ~size_t{0}, o.stride = width == 1 ? 0 : kLanesOfGrid;
            next += static_cast<size_t>(width) * kLanesOfGrid;
        }
    }
    std::vector<Operand> operands;

  private:
    struct alignas(64) Group {
        float lanes[kLanes];
    };
    std::unique_ptr<Group[]> memory_;
};

template <class Call>
void measure(benchmark::State& state, const Call& call) {
    for (auto _ : state) {
        call();
        benchmark::ClobberMemory();
    }
    const double vertices = static_cast<double>(state.iterations()) * kVertices;
    state.SetItemsProcessed(static_cast<int64_t>(vertices));
    state.counters["vertex"] =
        benchmark::Counter(vertices, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void run(benchmark::State& state, Kernel kernel, const std::vector<int>& widths, float low, float high) {
    const Planes planes(widths, low, high);
    if (!kernel) return state.SkipWithError("no such kernel");
    measure(state, [&] { kernel(kLanesOfGrid, planes.operands); });
}

void op(benchmark::State& state, Op what, std::vector<int> widths, float low, float high) {
    run(state, find_kernel(what, widths), widths, low, high);
}

BENCHMARK_CAPTURE(op, add, Op::Add, {1, 1, 1}, 0, 1);
BENCHMARK_CAPTURE(op, add_triples, Op::Add, {3, 3, 3}, 0, 1);
BENCHMARK_CAPTURE(op, mix_triples, Op::Mix, {3, 3, 3, 1}, 0, 1);
BENCHMARK_CAPTURE(op, divide, Op::Divide, {1, 1, 1}, 1, 2);
BENCHMARK_CAPTURE(op, mod, Op::Mod, {1, 1, 1}, 1, 2);
BENCHMARK_CAPTURE(op, smoothstep, Op::SmoothStep, {1, 1, 1, 1}, 0, 1);
BENCHMARK_CAPTURE(op, less, Op::Less, {1, 1, 1}, 0, 1);
BENCHMARK_CAPTURE(op, select_triples, Op::Select, {3, 1, 3, 3}, 0, 1);
BENCHMARK_CAPTURE(op, sqrt, Op::Sqrt, {1, 1}, 0, 1);
BENCHMARK_CAPTURE(op, sin, Op::Sin, {1, 1}, -9, 9);
BENCHMARK_CAPTURE(op, atan2, Op::Atan2, {1, 1, 1}, -1, 1);
BENCHMARK_CAPTURE(op, acos, Op::Acos, {1, 1}, -1, 1);
BENCHMARK_CAPTURE(op, exp, Op::Exp, {1, 1}, -9, 9);
BENCHMARK_CAPTURE(op, log, Op::Log, {1, 1}, 0, 9);
BENCHMARK_CAPTURE(op, pow, Op::Pow, {1, 1, 1}, 0, 3);
BENCHMARK_CAPTURE(op, normalize, Op::Normalize, {3, 3}, -1, 1);
BENCHMARK_CAPTURE(op, refract, Op::Refract, {3, 3, 3, 1}, 0, 1);
BENCHMARK_CAPTURE(op, transform_point, Op::TransformPoint, {3, 16, 3}, 0, 1);
BENCHMARK_CAPTURE(op, matrix_multiply, Op::MatrixMultiply, {16, 16, 16}, 0, 1);
BENCHMARK_CAPTURE(op, invert, Op::Invert, {16, 16}, 0, 1);
BENCHMARK_CAPTURE(op, noise_1d, Op::Noise, {1, 1}, -9, 9);
BENCHMARK_CAPTURE(op, noise_2d, Op::Noise, {1, 1, 1}, -9, 9);
BENCHMARK_CAPTURE(op, noise_3d, Op::Noise, {1, 3}, -9, 9);
BENCHMARK_CAPTURE(op, noise_3d_triple, Op::Noise, {3, 3}, -9, 9);
BENCHMARK_CAPTURE(op, noise_4d, Op::Noise, {1, 3, 1}, -9, 9);
BENCHMARK_CAPTURE(op, noise_4d_triple, Op::Noise, {3, 3, 1}, -9, 9);
BENCHMARK_CAPTURE(op, pnoise_3d, Op::PeriodicNoise, {1, 3, 3}, -9, 9);
BENCHMARK_CAPTURE(op, cellnoise_3d, Op::CellNoise, {1, 3}, -9, 9);
BENCHMARK_CAPTURE(op, cellnoise_3d_triple, Op::CellNoise, {3, 3}, -9, 9);
BENCHMARK_CAPTURE(op, spline_of_7, Op::Spline, {1, 1, 1, 1, 1, 1, 1, 1, 1}, 0, 1);
BENCHMARK_CAPTURE(op, spline_of_7_triples, Op::Spline, {3, 1, 3, 3, 3, 3, 3, 3, 3}, 0, 1);

void rgb_to_hsv(benchmark::State& state) {
    run(state, find_color_conversion("rgb", "hsv"), {3, 3}, 0, 1);
}
void diffuse(benchmark::State& state) {
    const Planes p({3, 3, 3, 3}, 0, 1);
    const auto& o = p.operands;
    measure(state, [&] { add_diffuse(kLanesOfGrid, o[1], o[2], o[3], 1, o[0]); });
}
void specular(benchmark::State& state) {
    const Planes p({3, 3, 3, 1, 3, 3}, 0, 1);
    const auto& o = p.operands;
    measure(state, [&] { add_specular(kLanesOfGrid, o[1], o[2], o[3], o[4], o[5], 1, o[0]); });
}
void plastic_in_one_loop(benchmark::State& state) {
    const Planes p({3, 3, 3, 3, 3, 3}, 0, 1);
    const auto& o = p.operands;
    measure(state, [&] { fused_plastic(kLanesOfGrid, o[2], o[3], o[4], o[5], o[0], o[1]); });
}
void normals(benchmark::State& state) {
    const Planes p({3, 3}, 0, 1);
    const GridSpan span{0, {16, 16}, false};
    measure(state, [&] { calculate_normals({&span, 1}, kLanesOfGrid, p.operands[1], p.operands[0]); });
}
void derivatives_u(benchmark::State& state) {
    const Planes p({3, 3, 1, 1}, 0, 1);
    const GridSpan span{0, {16, 16}, false};
    const auto& o = p.operands;
    measure(state, [&] { derivative_u({&span, 1}, kLanesOfGrid, 3, o[1], o[2], o[3], o[0]); });
}

BENCHMARK(rgb_to_hsv);
BENCHMARK(diffuse);
BENCHMARK(specular);
BENCHMARK(plastic_in_one_loop);
BENCHMARK(normals);
BENCHMARK(derivatives_u);

}  // namespace
}  // namespace trapeze::vm
