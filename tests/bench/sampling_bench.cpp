/// Visibility methods on synthetic scenes, in turns in one run: build, trace, counts and memory, and the
/// ratio of medians to the first method. With several numbers of threads each method takes a turn with each.
///
///   sampling_bench [--methods "raytrace embree ..."] [--scenes "0 3 5"] [--rounds N] [--threads "1 2"]
///   [--areas N] [--simd best|avx512|avx2|sse4]
///
/// Every Nth area of 64x64 pixels is sampled (N grows with the samples), and times are scaled to the whole
/// picture. Each method has its natural pattern and size of tile; samples are made before the clock runs.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <sstream>
#include <string>

#include "core/simd/simd_limit.h"
#include "sample/visibility.h"
#include "sampling_scenes.h"

namespace trapeze {
namespace {

using testing::SamplingScene;
using testing::SamplingSceneOptions;

const SamplingSceneOptions kScenes[] = {
    // hair, micropolygons, motion and circle of confusion in pixels, samples an axis
    {false, 3e5, 0, 10, 8},      // 0
    {false, 1.5e6, 0, 20, 4},    // 1
    {false, 1.5e6, 0, 20, 8},    // 2
    {false, 1.5e6, 0, 20, 13},   // 3
    {false, 1.5e6, 0, 0, 8},     // 4
    {false, 1.5e6, 60, 0, 8},    // 5
    {false, 1.5e6, 60, 20, 4},   // 6
    {false, 1.5e6, 60, 20, 8},   // 7
    {false, 1.5e6, 60, 20, 13},  // 8
    {false, 5e6, 0, 20, 8},      // 9
    {false, 5e6, 100, 20, 8},    // 10
    {false, 5e6, 100, 20, 13},   // 11
    {true, 1.5e6, 0, 20, 8},     // 12
    {true, 1.5e6, 60, 20, 8},    // 13
    {false, 20e6, 60, 20, 8},    // 14
    {false, 1.5e6, 0, 0, 2},     // 15
    {false, 20e6, 0, 0, 4},      // 16
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct Arguments {
    std::vector<std::string> methods{"raytrace"};
    std::vector<size_t> scenes;
    std::vector<int> threads{2};
    int rounds = 5, areas = 0;
};

std::vector<std::string> words(const char* text) {
    std::istringstream in(text);
    std::vector<std::string> found;
    for (std::string word; in >> word;) found.push_back(word);
    return found;
}

struct Thread {
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
};

struct Competitor {
    std::string name;
    int thread_count;
    Sampler sampler;
    std::unique_ptr<SamplePattern> pattern;
    std::vector<SampleTile> tiles;
    std::vector<double> build, trace;
    SampleStats stats;
    BuildStats built;
    size_t hits = 0;
};

/// The samples of a method, in tiles of its size.
void make_tiles(const SamplingScene& scene, const std::vector<PixelRect>& areas, Competitor& c) {
    c.pattern = c.sampler.make_pattern(scene.frame.context);
    const int side = c.sampler.prepare(scene.frame.context, scene.maker.grids())->tile_side();
    for (const PixelRect& area : areas)
        for (int y = area.y0; y < area.y1; y += side)
            for (int x = area.x0; x < area.x1; x += side)
                c.pattern->make_tile({x, y, std::min(x + side, area.x1), std::min(y + side, area.y1)},
                                     c.tiles.emplace_back());
}

/// One turn of a method: prepare, resolve all tiles. With the threads of the calling arena.
void take_turn_here(const SamplingScene& scene, Competitor& c) {
    const double begin = now();
    const auto visibility = c.sampler.prepare(scene.frame.context, scene.maker.grids());
    const double built = now();
    tbb::enumerable_thread_specific<Thread> threads;
    std::atomic<size_t> hits{0};
    const auto resolve = [&](size_t i) {
        Thread& thread = threads.local();
        visibility->resolve(c.tiles[i], thread.hits, thread.scratch, thread.stats);
        hits += thread.hits.hits.size();
    };
    // Tiles differ in cost by ten and more: one at a time.
    tbb::parallel_for(size_t{0}, c.tiles.size(), resolve, tbb::simple_partitioner());
    c.trace.push_back(now() - built);
    c.build.push_back(built - begin);
    c.built = visibility->build_stats();
    c.stats = {};
    for (const Thread& thread : threads) c.stats += thread.stats;
    c.hits = hits;
}

void take_turn(const SamplingScene& scene, Competitor& c) {
    tbb::task_arena(c.thread_count).execute([&] { take_turn_here(scene, c); });
}

void run_scene(const SamplingSceneOptions& options, const Arguments& arguments) {
    const SamplingScene scene(options);
    constexpr int kArea = 64;
    std::vector<PixelRect> all, areas;
    for (int y = 0; y < scene.frame.options.height; y += kArea)
        for (int x = 0; x < scene.frame.options.width; x += kArea)
            all.push_back({x, y, std::min(x + kArea, scene.frame.options.width),
                           std::min(y + kArea, scene.frame.options.height)});
    const size_t skip = arguments.areas
                            ? static_cast<size_t>(arguments.areas)
                            : std::max<size_t>(1, all.size() * options.samples * options.samples / 3000);
    size_t pixels = 0;
    for (size_t i = skip / 2; i < all.size(); i += skip) {
        areas.push_back(all[i]);
        pixels += static_cast<size_t>(all[i].width()) * all[i].height();
    }
    std::string error;
    std::vector<Competitor> competitors;
    for (const std::string& name : arguments.methods)
        if (const auto sampler = choose_sampler(name, "", &error))
            for (const int threads : arguments.threads)
                competitors.push_back(
                    {arguments.threads.size() == 1 ? name : name + ", threads: " + std::to_string(threads),
                     threads,
                     *sampler,
                     {},
                     {},
                     {},
                     {},
                     {},
                     {},
                     0});
        else
            std::printf("%s\n", error.c_str());
    for (Competitor& c : competitors) make_tiles(scene, areas, c);
    for (int round = 0; round < arguments.rounds; ++round)
        for (Competitor& c : competitors) take_turn(scene, c);

    const auto micropolygons = static_cast<double>(scene.maker.grids().micropolygon_count());
    std::printf("%s %.2fM, motion %.0f, coc %.0f, %dx%d\n", options.hair ? "hair" : "balls",
                micropolygons / 1e6, options.motion_pixels, options.blur_pixels, options.samples,
                options.samples);
    const double scale = static_cast<double>(scene.frame.options.width) * scene.frame.options.height /
                         static_cast<double>(pixels);
    double first_trace = 0, first_total = 0;
    for (const Competitor& c : competitors) {
        const double trace = median(c.trace), build = median(c.build), total = build + trace * scale;
        if (&c == competitors.data()) first_trace = trace, first_total = total;
        const auto rays = static_cast<double>(c.stats.rays);
        std::printf(
            "  %-34s build %7.2f ms  trace %7.2f Mray/s  total %7.3f s  ratio trace %5.2f total %5.2f  "
            "%5.1f nodes %5.1f tests/ray  %5.2f B/mpoly  %zu hits\n",
            c.name.c_str(), build * 1e3, rays / trace / 1e6, total, trace / first_trace, total / first_total,
            static_cast<double>(c.stats.nodes_visited) / rays,
            static_cast<double>(c.stats.predicate_tests) / rays,
            static_cast<double>(c.built.tree_bytes) / micropolygons, c.hits);
    }
    std::fflush(stdout);
}

/// False, with the reason or the usage on stderr, when they are not as the head of this file has them.
bool read_arguments(const std::vector<std::string>& given, Arguments& arguments) {
    for (size_t i = 0; i < given.size(); i += 2) {
        const std::string& key = given[i];
        if (i + 1 == given.size() ||
            !std::set<std::string>{"--methods", "--scenes", "--rounds", "--threads", "--areas", "--simd"}
                 .contains(key)) {
            std::fputs(
                "usage: sampling_bench [--methods \"raytrace embree ...\"] [--scenes \"0 3 5\"] [--rounds "
                "N]\n"
                "                      [--threads \"1 2\"] [--areas N] [--simd best|avx512|avx2|sse4]\n",
                stderr);
            return false;
        }
        const std::string& value = given[i + 1];
        std::string error;
        if (key == "--simd" && !limit_simd(value.c_str(), &error)) {
            std::fprintf(stderr, "%s\n", error.c_str());
            return false;
        }
        if (key == "--methods") arguments.methods = words(value.c_str());
        if (key == "--scenes")
            for (const std::string& word : words(value.c_str()))
                arguments.scenes.push_back(std::strtoul(word.c_str(), nullptr, 10));
        if (key == "--rounds") arguments.rounds = std::atoi(value.c_str());
        if (key == "--threads") {
            arguments.threads.clear();
            for (const std::string& word : words(value.c_str()))
                arguments.threads.push_back(std::max(1, std::atoi(word.c_str())));
            if (arguments.threads.empty()) arguments.threads.push_back(1);
        }
        if (key == "--areas") arguments.areas = std::atoi(value.c_str());
    }
    return true;
}

}  // namespace
}  // namespace trapeze

int main(int argc, char** argv) {
    using namespace trapeze;
    Arguments arguments;
    if (!read_arguments({argv + 1, argv + argc}, arguments)) return 2;
    const int most = *std::max_element(arguments.threads.begin(), arguments.threads.end());
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<size_t>(most));
    tbb::task_arena arena(most);
    std::printf("%d threads, %s\n", most, std::string(simd_target_name()).c_str());
    arena.execute([&] {
        for (size_t i = 0; i < std::size(kScenes); ++i)
            if (arguments.scenes.empty() || std::count(arguments.scenes.begin(), arguments.scenes.end(), i))
                run_scene(kScenes[i], arguments);
    });
}
