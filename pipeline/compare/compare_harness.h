/// Scenes shared by methods, for tests.
#pragma once

#include <gtest/gtest.h>

#include "pipeline/compare/shared_frame.h"
#include "pipeline/rib/read_rib.h"
#include "sample/visibility.h"

namespace trapeze::testing {

/// The first world of a tiny scene, tessellated and shaded.
struct SharedScene {
    std::string messages;
    Diagnostics diagnostics{[this](const Diagnostic& d) { messages += to_string(d) + "\n"; }};
    std::optional<SharedFrame> frame;

    explicit SharedScene(const std::string& file, const RenderSettings& settings = {}) {
        const std::vector<std::string> files{TRAPEZE_SOURCE_DIR "/scenes/tiny/" + file};
        bool read = false;
        read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& scene) {
            if (!read) frame = share_frame(std::move(scene), settings, diagnostics);
            read = true;
        });
        EXPECT_TRUE(read) << file;
    }
    SharedScene(const SharedScene&) = delete;
    SharedScene& operator=(const SharedScene&) = delete;
};

inline std::vector<Sampler> samplers_of(const std::vector<std::string>& names) {
    std::vector<Sampler> samplers;
    for (const std::string& name : names) {
        std::string error;
        const auto sampler = choose_sampler(name, "", &error);
        EXPECT_TRUE(sampler) << error;
        if (sampler) samplers.push_back(*sampler);
    }
    return samplers;
}

}  // namespace trapeze::testing
