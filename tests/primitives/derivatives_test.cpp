/// Derivatives as shaders see them: Du(P) and Dv(P) over a grid are dPdu and dPdv, for every kind of surface.
#include "shade/shader_folder_harness.h"
#include "shade/shading.h"
#include "tests/primitives/dice_rib.h"

namespace trapeze::test {
namespace {

/// What a shader finds of Du(P) against dPdu, and Dv(P) against dPdv, as shares of them.
struct Found {
    double worst = 0, mean = 0;
};

Found derivative_errors(const std::string& text) {
    rib::test::Outcome read = rib::test::read_text(
        "Format 100 100 1 ScreenWindow -3 3 -3 3 Projection \"orthographic\" Clipping 0.01 1000\nWorldBegin "
        "Translate 0 0 10 ShadingRate 0.25 Surface \"errors\" " +
        text + " WorldEnd");
    EXPECT_THAT(read.messages, ::testing::IsEmpty());
    ShaderFolder folder;
    folder.write("errors",
                 "surface errors() { Ci = color(length(Du(P) - dPdu) / length(dPdu), "
                 "length(Dv(P) - dPdv) / length(dPdv), 0); }");
    TestScene scene;
    scene.scene = std::move(read.worlds.at(0));
    scene.scene.options.search_paths["shader"] = {folder.path()};
    const RenderContext context = scene.context();
    const Shading shading(context);
    const Tessellation tessellation(context);
    DiceScratch dice_scratch;
    ShadeScratch shade_scratch;
    ShadeStats stats;
    ShadingGrid grid;
    Found found;
    double sum = 0, count = 0;
    for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
        tessellation.dice(i, grid, dice_scratch);
        shading.shade(grid, shade_scratch, stats);
        for (size_t n = 0; n < grid.vertex_count(); ++n)
            for (int k = 0; k < 2; ++k) {
                const int column = static_cast<int>(n) % grid.shape.vertices_u(),
                          row = static_cast<int>(n) / grid.shape.vertices_u();
                // Border vertices may have gone to their edges', whose parameters are others.
                if (column < 2 || row < 2 || column > grid.shape.nu - 2 || row > grid.shape.nv - 2) continue;
                const double error = grid.Ci.c[k][n];
                found.worst = std::max(found.worst, error);
                sum += error, count += 1;
            }
    }
    EXPECT_GT(count, 100);
    found.mean = sum / count;
    return found;
}

TEST(Derivatives, DifferencesAlongTheGridAreThoseOfTheSurface) {
    const std::string sheet =
        "\"P\" [-2 -2 0 -0.5 -2 1 0.5 -2 0 2 -2 1 -2 -0.5 0 -0.5 -0.5 0 0.5 -0.5 1 2 -0.5 0 "
        "-2 0.5 1 -0.5 0.5 0 0.5 0.5 0 2 0.5 1 -2 2 0 -0.5 2 1 0.5 2 1 2 2 0] ";
    for (const std::string& text :
         {std::string("Sphere 2 -1.5 1.5 -200"), std::string("Cone 2 2 360"),
          std::string("Cylinder 2 -1 1 100"), std::string("Hyperboloid 2 0 -1 0.5 2 2 720"),
          std::string("Paraboloid 2 0.5 2 360"), std::string("Disk 0 2 270"),
          std::string("Torus 1.5 0.5 30 300 -360"), "Patch \"bicubic\" " + sheet,
          "PatchMesh \"bilinear\" 4 \"nonperiodic\" 4 \"nonperiodic\" " + sheet,
          "NuPatch 4 4 [0 0 0 0 2 2 2 2] 0.5 2 4 3 [0 0 0 1 3 3 3] 0 3 " + sheet,
          "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4 4 4 4] [0 1 5 4 1 2 6 5 2 3 7 6 4 5 9 8 5 6 10 9 6 "
          "7 "
          "11 10 8 9 13 12 9 10 14 13 10 11 15 14] [\"interpolateboundary\"] [1 0] [1] [] " +
              sheet,
          "PointsPolygons [4 4 4 4 4 4 4 4 4] [0 1 5 4 1 2 6 5 2 3 7 6 4 5 9 8 5 6 10 9 6 7 "
          "11 10 8 9 13 12 9 10 14 13 10 11 15 14] " +
              sheet}) {
        SCOPED_TRACE(text);
        const Found found = derivative_errors(text);
        // Differences over two micropolygons of half a pixel, on curves of radius 8 and more.
        EXPECT_LE(found.mean, 0.004);
        EXPECT_LE(found.worst, 0.05);
    }
}

}  // namespace
}  // namespace trapeze::test
