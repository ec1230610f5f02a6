/// What compositing costs a sample: resolving its hits and adding it to the film, on one thread; and what
/// writing a picture costs.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "composite/displays/write_displays.h"
#include "composite/film/film.h"
#include "composite/film/raster_harness.h"

namespace trapeze {
namespace {

constexpr int kColumns = 8, kRows = 8, kSamplesSide = 8;

enum class View { Empty, Constant, Smooth, Glass };

void film_add(benchmark::State& state, View view, const char* filter, float width) {
    testing::RasterScene scene(kColumns * kMaxGridSide, kRows * kMaxGridSide, kSamplesSide);
    scene.scene.options.filter = {filter, width, width};
    testing::GridLook look;
    look.color = [](int x, int y) {
        return V3f(static_cast<float>(x & 7), static_cast<float>(y & 7), 1) * 0.1f;
    };
    if (view == View::Glass) look.opacity = [](int, int) { return V3f(0.5f); };
    look.smooth = view == View::Smooth;
    Grids grids;
    testing::add_grids(grids, kColumns, kRows, look);

    std::vector<SampleTile> samples;
    std::vector<HitBuffer> hits;
    size_t count = 0;
    for (const PixelRect& tile : testing::tiles_of(scene.sampled())) {
        samples.push_back(testing::make_samples(scene, tile));
        hits.push_back(testing::make_hits(samples.back(), grids, kColumns, kRows,
                                          [&](float, float) { return view != View::Empty; }));
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
BENCHMARK_CAPTURE(film_add, constant_box1, View::Constant, "box", 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, constant_mitchell4, View::Constant, "mitchell", 4)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(film_add, constant_catmull_rom4, View::Constant, "catmull-rom", 4)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trapeze
