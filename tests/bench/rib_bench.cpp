/// Speed of the RIB reader in bytes of RIB a second, on one core, from files in the page cache. Number arrays
/// dominate real scenes; many small requests of all kinds are the other extreme (small_requests.cpp).
#include <benchmark/benchmark.h>

#include <unistd.h>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>

#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/write/cat_rib.h"
#include "tests/bench/small_requests.h"

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

std::string in_world(const std::string& text) {
    return "WorldBegin\n" + text + "WorldEnd\n";
}

void read_scene(benchmark::State& state, const std::string& text) {
    const SceneFile scene(text);
    const std::vector<std::string> files{scene.path()};
    uint64_t bytes = 0, primitives = 0;
    std::optional<Scene> made;
    for (auto _ : state) {
        Diagnostics diagnostics;
        const ReadSummary summary = read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& world) {
            primitives = world.primitives.size();
            made = std::move(world);
        });
        state.PauseTiming();  // to give the scene's memory back is not reading
        made.reset();
        state.ResumeTiming();
        bytes += summary.bytes;
        if (diagnostics.count(Severity::Error) > 0) state.SkipWithError("the scene has errors");
    }
    state.SetBytesProcessed(static_cast<int64_t>(bytes));
    state.counters["bytes"] = static_cast<double>(bytes) / static_cast<double>(state.iterations());
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
    read_scene(state, in_world(mesh_text(700, "%.4g ")));
}

void mesh_nine_digits(benchmark::State& state) {
    read_scene(state, in_world(mesh_text(700, "%.9g ")));
}

void mesh_seventeen_digits(benchmark::State& state) {
    read_scene(state, in_world(mesh_text(700, "%.17g ")));
}

/// Text in RISpec's binary encoding.
std::string encoded(const std::string& text) {
    const SceneFile scene(in_world(text));
    const std::vector<std::string> files{scene.path()};
    rib::CatOptions options;
    options.encoding = rib::RibEncoding::Binary;
    Diagnostics diagnostics;
    std::string bytes;
    rib::cat_rib(files, options, diagnostics, [&](std::string_view more) { bytes += more; });
    return bytes;
}

BENCHMARK(mesh_short_numbers)->Unit(benchmark::kMillisecond);
BENCHMARK(mesh_nine_digits)->Unit(benchmark::kMillisecond);
BENCHMARK(mesh_seventeen_digits)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    for (const bench::SmallRequests& kind : bench::small_request_kinds()) {
        const std::string name = std::string("small/") + kind.name;
        const auto text = kind.text;
        benchmark::RegisterBenchmark(name.c_str(), [text](benchmark::State& state) {
            read_scene(state, in_world(text()));
        })->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark((name + "/binary").c_str(), [text](benchmark::State& state) {
            read_scene(state, encoded(text()));
        })->Unit(benchmark::kMillisecond);
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
