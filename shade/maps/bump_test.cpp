/// bump(): normals of a surface that a height map displaces.
#include "shade/maps/map_files_harness.h"
#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::expect_near_triple;
using testing::ShaderFolder;
using testing::ShadingScene;

class BumpTest : public MapFilesTest {
  protected:
    /// Ci is what the call gives on the test grid: P = (s, 1 - t, 4), dPds = x, dPdt = -y, N = -z.
    ShadingGrid bump(const std::string& call) {
        shaders_.write("bumped", "surface bumped() { Ci = color(" + call + "); Oi = 1; }");
        scene_.scene.options.search_paths["shader"] = {shaders_.path()};
        scene_.surface("bumped");
        return scene_.shaded(scene_.grid(8, 8));
    }
    /// Rises by 0.5 over s and by 0.25 over t.
    std::string slope() {
        return write("slope.exr", OIIO::ImageSpec(64, 64, 1, OIIO::TypeDesc::FLOAT), [](int x, int y, int) {
            return (static_cast<float>(x) + 0.5f) / 128 + (static_cast<float>(y) + 0.5f) / 256;
        });
    }

    ShaderFolder shaders_;
    ShadingScene scene_;
};

TEST_F(BumpTest, TiltsNormalsAgainstTheSlope) {
    const std::string file = slope();
    const std::string name = "\"" + file + "\"";
    // Displaced: (s, 1 - t, 4 - F), so that N' = dP'ds x dP'dt = (1, 0, -.5) x (0, -1, -.25).
    const V3f expected = V3f(1, 0, -0.5f).cross(V3f(0, -1, -0.25f)) - V3f(0, 0, -1);
    const std::vector<std::string> calls = {
        "bump(" + name + ", N, dPdu, dPdv)", "bump(" + name + ", N * 3, dPdu, dPdv, s, t)",
        "bump(" + name + ", N, dPdu, dPdv, s, t, s, t, s, t, s, t, \"width\", 0)"};
    for (const std::string& call : calls) {
        const ShadingGrid grid = bump(call);
        for (int j = 2; j <= 6; ++j)
            for (int i = 2; i <= 6; ++i)  // away from the picture's border
                expect_near_triple(grid.Ci.at(grid.shape.row_index(i, j)), expected, 0.02f, call.c_str());
    }
    EXPECT_TRUE(scene_.reported.empty());
}

TEST_F(BumpTest, FlatMapsAndMissingOnesChangeNothing) {
    OIIO::ImageSpec spec(16, 16, 1, OIIO::TypeDesc::FLOAT);
    spec.attribute("wrapmodes", "clamp,clamp");
    const std::string flat = write("flat.exr", spec, [](int, int, int) { return 0.7f; });
    for (const std::string& file : {flat, std::string("nowhere.exr")}) {
        const ShadingGrid grid = bump("bump(\"" + file + "\", N, dPdu, dPdv, s, t)");
        for (size_t i = 0; i < grid.vertex_count(); ++i) expect_near_triple(grid.Ci.at(i), V3f(0), 1e-4f);
    }
    EXPECT_EQ(scene_.reported.size(), 1u);
}

}  // namespace
}  // namespace trapeze
