/// Shading of whole grids of 16x16 micropolygons: vertices a second, through the room's door; and what
/// compiling a shader takes. `--simd NAME` limits the instruction set, as the program's option does.
///
/// What a surface's time goes to shows in differences: "constant" is what any grid costs (variables in,
/// colours out), "plastic_unlit" adds the surface's own arithmetic, "plastic_distant" the light. Grids of one
/// micropolygon have a sixteenth of the lanes: what they cost is mostly the interpreter's, a step after the
/// other.
#include <OpenImageIO/imageio.h>
#include <benchmark/benchmark.h>

#include <algorithm>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading.h"
#include "shade/vm/compile_shader.h"
#include "tests/bench/run_benchmarks.h"

namespace trapeze {
namespace {

using testing::ShaderFolder;

/// A grid that bends towards the viewer at z = 5 or so, in front of one primitive.
ShadingGrid bent_grid(const Scene& scene, int side) {
    ShadingGrid grid;
    grid.shape = {static_cast<uint8_t>(side), static_cast<uint8_t>(side)};
    grid.primitive = &scene.primitives.front();
    const size_t count = grid.vertex_count();
    grid.P.resize(1);
    for (Triples* triples : {&grid.P[0], &grid.N, &grid.Ng, &grid.dPdu, &grid.dPdv}) triples->resize(count);
    for (auto* plane : {&grid.u, &grid.v, &grid.s, &grid.t}) plane->resize(count);
    grid.Cs.fill(count, V3f(0.8f, 0.5f, 0.2f));
    grid.Os.fill(count, V3f(1));
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const float x = (static_cast<float>(i) - 8) / 16, y = (static_cast<float>(j) - 8) / 16;
            const V3f normal = V3f(x, y, -1).normalized();
            const size_t at = grid.shape.row_index(i, j);
            grid.P[0].set(at, V3f(x, y, 5 + (x * x + y * y) / 2));
            grid.N.set(at, normal), grid.Ng.set(at, normal);
            grid.dPdu.set(at, V3f(1, 0, x)), grid.dPdv.set(at, V3f(0, 1, y));
            for (auto* plane : {&grid.u, &grid.s}) (*plane)[at] = x + 0.5f;
            for (auto* plane : {&grid.v, &grid.t}) (*plane)[at] = y + 0.5f;
        }
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

/// 512 x 512, three channels.
void write_stripes(const std::string& path) {
    constexpr int kSide = 512;
    std::vector<float> pixels;
    for (int i = 0; i < kSide * kSide * 3; ++i) pixels.push_back(static_cast<float>(i / 24 % 2));
    if (const auto file = OIIO::ImageOutput::create(path);
        file && file->open(path, OIIO::ImageSpec(kSide, kSide, 3, OIIO::TypeDesc::FLOAT)))
        file->write_image(OIIO::TypeDesc::FLOAT, pixels.data());
}

/// Shaders that are no standard ones, in a folder for as long as the program runs.
const std::string& shaders_of_the_bench() {
    static const ShaderFolder folder;
    static const bool written = [] {
        folder.write(
            "six_octaves",
            "surface six_octaves(float Kd = 0.8, veining = 3;) {"
            "  point PP = transform(\"shader\", P) * veining; float sum = 0, size = 1; uniform float i;"
            "  for (i = 0; i < 6; i += 1) { sum += abs(0.5 - noise(PP * size)) / size; size *= 2; }"
            "  color c = mix(color (0.2, 0.2, 0.5), color (1, 1, 0.9), smoothstep(0.1, 0.6, sum));"
            "  Oi = Os; Ci = Oi * c * Kd * diffuse(faceforward(normalize(N), I)); }");
        folder.write(
            "octaves_alone",
            "surface octaves_alone() { float sum = 0, size = 1; uniform float i;"
            "  for (i = 0; i < 6; i += 1) { sum += noise(P * size); size *= 2; } Ci = sum; Oi = 1; }");
        folder.write("textured",
                     "surface textured() { Oi = 1;"
                     "  Ci = texture(\"stripes.exr\", 0.5 + xcomp(P) / 2, 0.5 + ycomp(P) / 2); }");
        write_stripes(folder.path() + "/stripes.exr");
        return true;
    }();
    (void)written;
    return folder.path();
}

void shade(benchmark::State& state, const char* surface, const char* light, int lights,
           const char* displacement, int side = 16) {
    Scene scene = scene_with(surface, light, lights, displacement);
    scene.options.search_paths["shader"] = scene.options.search_paths["texture"] = {shaders_of_the_bench()};
    RenderContext context;
    context.scene = &scene;
    context.camera.plane_scale_x = 1 / 80.0f,
    context.camera.plane_scale_y = -1 / 80.0f;  // pixels of micropolygons
    const Shading shading(context);
    const ShadingGrid undisplaced = bent_grid(scene, side);
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

void constant(benchmark::State& state) {
    shade(state, "constant", "distantlight", 1, nullptr);
}
void plastic_unlit(benchmark::State& state) {
    shade(state, "plastic", "distantlight", 0, nullptr);
}
void plastic_one_micropolygon(benchmark::State& state) {
    shade(state, "plastic", "distantlight", 1, nullptr, 1);
}
void six_octaves(benchmark::State& state) {
    shade(state, "six_octaves", "distantlight", 1, nullptr);
}
void octaves_alone(benchmark::State& state) {
    shade(state, "octaves_alone", "distantlight", 0, nullptr);
}
void textured(benchmark::State& state) {
    shade(state, "textured", "distantlight", 0, nullptr);
}
void octaves_one_micropolygon(benchmark::State& state) {
    shade(state, "octaves_alone", "distantlight", 0, nullptr, 1);
}

/// 500 lines: functions, loops, conditions, built-in functions.
std::string long_shader() {
    std::string text;
    for (int f = 0; f < 20; ++f) {
        const std::string n = std::to_string(f);
        text += "float f" + n +
                "(point p; float x) {\n    float a = x, i;\n    for (i = 0; i < 3; i += 1)\n        "
                "a += noise(p * i) * " +
                n +
                ";\n    if (a > 0.5) {\n        a = smoothstep(0, 1, a);\n    } else {\n"
                "        a = clamp(a, 0, x);\n    }\n    return a;\n}\n";
    }
    text +=
        "surface long(float Kd = 1) {\n    float a = s, b = t;\n    color c = Cs;\n    vector v = "
        "normalize(I);\n";
    for (int k = 0; k < 55; ++k) {
        const std::string n = std::to_string(k % 20), m = std::to_string(k);
        text += "    a += f" + n + "(P + " + m + ", b);\n    c = mix(c, color (a, b, " + m +
                ") / 100, 0.5);\n    if (a > b)\n        b += length(v ^ vector (a, 1, 2));\n    v = "
                "normalize(v + a);\n";
    }
    return text + "    Oi = Os;\n    Ci = Oi * c * Kd * diffuse(normalize(N));\n}\n";
}

void compile_500_lines(benchmark::State& state) {
    const rsl::Source source{"long.sl", long_shader()};
    size_t instructions = 0;
    for (auto _ : state) {
        Diagnostics diagnostics;
        const auto executable = vm::compile_shader(source, {}, diagnostics);
        instructions = executable->code().size();
        benchmark::DoNotOptimize(executable->code().data());
    }
    state.counters["instructions"] = static_cast<double>(instructions);
}

BENCHMARK(plastic_distant)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(plastic_spot)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(plastic_four_points)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(matte_distant)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(dented_matte)->Threads(1)->Threads(2)->UseRealTime();
BENCHMARK(constant);
BENCHMARK(plastic_unlit);
BENCHMARK(plastic_one_micropolygon);
BENCHMARK(six_octaves);
BENCHMARK(octaves_alone);
BENCHMARK(octaves_one_micropolygon);
BENCHMARK(textured);
BENCHMARK(compile_500_lines)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trapeze

int main(int argc, char** argv) {
    return trapeze::run_benchmarks(argc, argv);
}
