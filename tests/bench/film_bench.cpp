/// What compositing costs a sample: resolving its hits and adding it to the film, on one thread; and what
/// writing a picture costs.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "composite/displays/write_displays.h"
#include "composite/film/film.h"
#include "composite/film/raster_harness.h"
#include "tests/bench/run_benchmarks.h"

namespace trapeze {
namespace {

constexpr int kColumns = 4, kRows = 4, kSamplesSide = 8;

enum class View { Empty, Constant, Smooth, Glass, EightGlasses };

/// Each sample's hits in all layers, front to back.
HitBuffer one_behind_the_other(const std::vector<HitBuffer>& layers) {
    HitBuffer all;
    all.first.push_back(0);
    for (size_t s = 0; s < layers.front().size(); ++s) {
        for (const HitBuffer& layer : layers)
            all.hits.insert(all.hits.end(), layer.of(s).begin(), layer.of(s).end());
        all.first.push_back(static_cast<uint32_t>(all.hits.size()));
    }
    return all;
}

void film_add(benchmark::State& state, View view, const char* filter, float width) {
    testing::RasterScene scene(kColumns * kMaxGridSide, kRows * kMaxGridSide, kSamplesSide);
    scene.scene.options.filter = {filter, width, width};
    testing::GridLook look;
    look.color = [](int x, int y) {
        return V3f(static_cast<float>(x & 7), static_cast<float>(y & 7), 1) * 0.1f;
    };
    const int layers = view == View::EightGlasses ? 8 : 1;
    if (view >= View::Glass) look.opacity = [](int, int) { return V3f(0.5f); };
    look.smooth = view == View::Smooth || view == View::EightGlasses;
    Grids grids;
    for (int layer = 0; layer < layers; ++layer) {
        look.depth = static_cast<float>(1 + layer);
        testing::add_grids(grids, kColumns, kRows, look);
    }

    std::vector<SampleTile> samples;
    std::vector<HitBuffer> hits;
    size_t count = 0;
    for (const PixelRect& tile : testing::tiles_of(scene.sampled())) {
        samples.push_back(testing::make_samples(scene, tile));
        std::vector<HitBuffer> of_layers;
        for (int layer = 0; layer < layers; ++layer)
            of_layers.push_back(testing::make_hits(
                samples.back(), grids, kColumns, kRows, [&](float, float) { return view != View::Empty; },
                static_cast<uint32_t>(layer * kColumns * kRows)));
        hits.push_back(one_behind_the_other(of_layers));
        count += samples.back().size();
    }
    for (auto _ : state) {
        Film film(scene.context);
        for (size_t i = 0; i < samples.size(); ++i) film.add(samples[i], hits[i], grids);
        benchmark::DoNotOptimize(film.finish());
    }
    state.counters["samples/s"] =
        benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
    state.counters["s/sample"] =
        benchmark::Counter(static_cast<double>(count),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A noisy 1280x720 picture, which compresses badly, to a file.
void write_picture(benchmark::State& state, const char* extension) {
    testing::RasterScene scene(1280, 720, 1);
    const std::string path =
        (std::filesystem::temp_directory_path() / ("trapeze_film_bench" + std::string(extension))).string();
    scene.scene.options.displays = {{path, "file", "rgba", {}, {}}};
    Image image;
    image.width = 1280, image.height = 720, image.window = scene.context.camera.crop;
    image.rgba.resize(4 * 1280 * 720), image.z.resize(1280 * 720);
    for (size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = unit_float(hash(static_cast<uint32_t>(i)));
    for (auto _ : state)
        if (!write_displays(image, scene.context, {"film_bench", {}})) state.SkipWithError("not written");
    std::filesystem::remove(path);
}

BENCHMARK_CAPTURE(write_picture, exr, ".exr")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_picture, png, ".png")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, empty_gaussian2, View::Empty, "gaussian", 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, constant_gaussian2, View::Constant, "gaussian", 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, smooth_gaussian2, View::Smooth, "gaussian", 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, glass_gaussian2, View::Glass, "gaussian", 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, eight_glasses_gaussian2, View::EightGlasses, "gaussian", 2)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, constant_box1, View::Constant, "box", 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, constant_mitchell4, View::Constant, "mitchell", 4)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, constant_catmull_rom4, View::Constant, "catmull-rom", 4)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trapeze

int main(int argc, char** argv) {
    return trapeze::run_benchmarks(argc, argv);
}
