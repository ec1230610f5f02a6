/// For tests: AFF files of a few lines.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <string>

#include "core/files/temporary_folder_harness.h"
#include "pipeline/study/aff/aff_scene.h"

namespace trapeze::testing {

class AffFolder {
  public:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_.file(name), std::ios::binary) << text;
    }
    std::string file(const std::string& name) const { return folder_.file(name); }

    /// The scene of a text that is to be right.
    AffScene scene(const std::string& text) const {
        std::string problem;
        write("scene.aff", text);
        std::optional<AffScene> scene = AffScene::read(file("scene.aff"), &problem);
        EXPECT_TRUE(scene) << problem;
        return scene ? *scene : AffScene();
    }
    /// What is wrong with a text, the folder's name before it left out.
    std::string problem(const std::string& text) const {
        std::string problem;
        write("scene.aff", text);
        EXPECT_FALSE(AffScene::read(file("scene.aff"), &problem));
        const std::string before = folder_.path() + "/";
        EXPECT_TRUE(problem.starts_with(before)) << problem;
        return problem.starts_with(before) ? problem.substr(before.size()) : problem;
    }

  private:
    TemporaryFolder folder_;
};

inline void expect_near(const V3d& found, const V3d& wanted, double tolerance = 1e-6) {
    EXPECT_LT((found - wanted).length(), tolerance) << found << " and not " << wanted;
}

}  // namespace trapeze::testing
