/// Worlds whose shaders bake point clouds, and read them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "shade/clouds/ptc_harness.h"
#include "tests/rays/rays_harness.h"

namespace trapeze::testing {

/// Worlds that are rendered one after the other in a folder of their own.
class Clouds {
  public:
    RenderSettings settings;
    int threads = 2;
    std::vector<Diagnostic> said;

    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    /// `text` stands in a surface shader of that name.
    void shader(const std::string& name, const std::string& text) const {
        folder_.write(name + ".sl", "surface " + name + "(string file = \"\";) { normal Nn = normalize(N); " +
                                        text + " Oi = 1; }");
    }
    /// Renders worlds of these contents, which cameras see as kPicture says.
    std::vector<Image> render(const std::vector<std::string>& worlds) {
        std::string rib =
            kPicture + "Option \"searchpath\" \"string shader\" [\"" + folder_.path().string() + "\"]\n";
        for (const std::string& world : worlds)
            rib += "FrameBegin 1 WorldBegin " + world + " WorldEnd FrameEnd\n";
        folder_.write("a.rib", rib);
        Diagnostics diagnostics([&](const Diagnostic& d) {
            if (d.kind != "written-elsewhere") said.push_back(d);
        });
        std::vector<Image> images;
        for (FrameResult& result :
             render_worlds((folder_ / "a.rib").string(), settings, threads, diagnostics))
            images.push_back(std::move(result.image));
        EXPECT_EQ(images.size(), worlds.size());
        return images;
    }
    void expect_nothing_said() const {
        for (const Diagnostic& d : said) ADD_FAILURE() << to_string(d);
    }
    /// A surface that is given a file.
    std::string surface(const std::string& name, const std::string& cloud = "a.ptc") const {
        return "Surface \"" + name + "\" \"string file\" [\"" + file(cloud) + "\"] ";
    }
    PartioFile baked(const std::string& name = "a.ptc") const {
        return read_as_partio(file_text(file(name)));
    }

    const WorkFolder& folder() const { return folder_; }

  private:
    WorkFolder folder_;
};

}  // namespace trapeze::testing
