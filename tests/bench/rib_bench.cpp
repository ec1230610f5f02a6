/// Speed of the RIB reader in bytes of ASCII RIB a second, on one core, from files in the page cache. Number
/// arrays dominate real scenes; many small requests are the other extreme.
#include <benchmark/benchmark.h>

#include <unistd.h>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "pipeline/rib/read_rib.h"

namespace {

using namespace trapeze;

/// A scene file that lives as long as the benchmark.
class SceneFile {
  public:
    explicit SceneFile(const std::string& text)
        : path_(std::filesystem::temp_directory_path() / ("rib_bench_" + std::to_string(getpid()) + ".rib")) {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~SceneFile() { std::filesystem::remove(path_); }
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;
    std::string path() const { return path_.string(); }

  private:
    std::filesystem::path path_;
};

void read_scene(benchmark::State& state, const std::string& text) {
    const SceneFile scene("WorldBegin\n" + text + "WorldEnd\n");
    const std::vector<std::string> files{scene.path()};
    uint64_t bytes = 0, primitives = 0;
    for (auto _ : state) {
        Diagnostics diagnostics;
        const ReadSummary summary = read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& world) {
            primitives = world.primitives.size();
            benchmark::DoNotOptimize(world);
        });
        bytes += summary.bytes;
        if (diagnostics.count(Severity::Error) > 0) state.SkipWithError("the scene has errors");
    }
    state.SetBytesProcessed(static_cast<int64_t>(bytes));
    state.counters["primitives"] = static_cast<double>(primitives);
}

/// A subdivision mesh of a square grid of quads, its points written with so many digits.
std::string mesh_text(int side, const char* format) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> jitter(-0.5f, 0.5f);
    std::string text = "SubdivisionMesh \"catmull-clark\" [";
    char number[64];
    for (int face = 0; face < side * side; ++face) text += face % 32 == 31 ? "4\n" : "4 ";
    text += "]\n[";
    for (int v = 0; v < side; ++v)
        for (int u = 0; u < side; ++u) {
            const int corner = v * (side + 1) + u;
            std::snprintf(number, sizeof number, "%d %d %d %d\n", corner, corner + 1, corner + side + 2,
                          corner + side + 1);
            text += number;
        }
    text += "]\n\"P\" [";
    for (int v = 0; v <= side; ++v)
        for (int u = 0; u <= side; ++u) {
            for (const float x : {static_cast<float>(u), static_cast<float>(v), 0.0f}) {
                std::snprintf(number, sizeof number, format, static_cast<double>(x + jitter(random)));
                text += number;
            }
            text += '\n';
        }
    return text + "]\n";
}

void mesh_short_numbers(benchmark::State& state) {
    read_scene(state, mesh_text(700, "%.4g "));
}

void mesh_nine_digits(benchmark::State& state) {
    read_scene(state, mesh_text(700, "%.9g "));
}

void mesh_seventeen_digits(benchmark::State& state) {
    read_scene(state, mesh_text(700, "%.17g "));
}

void small_requests(benchmark::State& state) {
    std::string text;
    char line[256];
    for (int i = 0; i < 50000; ++i) {
        std::snprintf(line, sizeof line,
                      "AttributeBegin\n  Color [%.3f 0.5 0.25]\n  Translate %d 0.5 -1.25\n  Rotate 30 0 1 0\n"
                      "  Surface \"plastic\" \"Kd\" [0.5] \"roughness\" [0.1]\n  Sphere 1 -1 1 360\n"
                      "AttributeEnd\n",
                      i % 100 * 0.01, i);
        text += line;
    }
    read_scene(state, text);
}

BENCHMARK(mesh_short_numbers)->Unit(benchmark::kMillisecond);
BENCHMARK(mesh_nine_digits)->Unit(benchmark::kMillisecond);
BENCHMARK(mesh_seventeen_digits)->Unit(benchmark::kMillisecond);
BENCHMARK(small_requests)->Unit(benchmark::kMillisecond);

}  // namespace
