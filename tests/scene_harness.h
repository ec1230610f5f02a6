/// Renders RIB scenes in the test's own process, so that images can be compared bit for bit.
#pragma once

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/frame/make_context.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/rib/read_rib.h"
#include "sample/visibility.h"

namespace trapeze::testing {

inline std::string tiny_scene_path(const std::string& file) {
    return TRAPEZE_SOURCE_DIR "/scenes/tiny/" + file;
}

/// Of the methods beside ray tracing, one of each kind; Embree where it is.
inline std::vector<std::string> methods_beside_ray_tracing() {
    std::vector<std::string> methods{"interval", "interleaveuvt"};
    if (std::string reason; choose_sampler("embree", "", &reason)) methods.emplace_back("embree");
    return methods;
}

/// Every scene of scenes/tiny, by file name, sorted.
inline std::vector<std::string> tiny_scenes() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(tiny_scene_path(""))) {
        const std::string file = entry.path().filename().string();
        if (file.ends_with(".rib") || file.ends_with(".rib.gz")) names.push_back(file);
    }
    std::sort(names.begin(), names.end());
    return names;
}
/// Those that make maps need the program, which makes them between worlds.
inline std::vector<std::string> tiny_scenes_without_maps() {
    std::vector<std::string> names = tiny_scenes();
    std::erase_if(names, [](const std::string& file) { return file.starts_with("make_"); });
    return names;
}

/// Whether a tiny scene is there to show how an error in it is met.
inline bool is_wrong_on_purpose(const std::string& file) {
    return file == "texture_missing.rib" || file == "surface_unknown.rib";
}

/// A test's name for a scene.
inline std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    return info.param.substr(0, info.param.find('.'));
}

/// All worlds of a file, rendered with so many threads.
inline std::vector<FrameResult> render_worlds(const std::string& path, const RenderSettings& settings,
                                              int threads, Diagnostics& diagnostics) {
    std::vector<FrameResult> results;
    const std::vector<std::string> files{path};
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute([&] {
        read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& scene) {
            auto result = render_frame(make_context(scene, settings, diagnostics), settings);
            if (result) results.push_back(std::move(*result));
        });
    });
    return results;
}

/// The same, of a scene that is known to be right. There are errors in it when it is `wrong`, or shows
/// how they are met, else none.
inline std::vector<FrameResult> render_scene(const std::string& path, const RenderSettings& settings,
                                             int threads = 2, bool wrong = false) {
    Diagnostics diagnostics;
    std::vector<FrameResult> results = render_worlds(path, settings, threads, diagnostics);
    wrong = wrong || is_wrong_on_purpose(std::filesystem::path(path).filename().string());
    EXPECT_EQ(diagnostics.count(Severity::Error) > 0, wrong) << path;
    return results;
}

inline bool same_bits(const Image& a, const Image& b) {
    const auto same = [](const std::vector<float>& x, const std::vector<float>& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0);
    };
    return a.window == b.window && same(a.rgba, b.rgba) && same(a.z, b.z) && same(a.aovs, b.aovs) &&
           a.id == b.id && same(a.mattes, b.mattes) && a.deep == b.deep;
}

}  // namespace trapeze::testing
