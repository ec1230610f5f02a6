/// Nothing that a camera sees is culled, and a subpatch's pixels hold all of it, for every kind of surface,
/// near the camera and across the picture's border, and in motion.
#include <algorithm>

#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

const std::vector<std::string> kSurfaces = {
    "Sphere 1 -1 1 360",
    "Sphere 1 0.7 -0.3 -250",
    "Sphere -1 -1 1 720",
    "Cone -1.5 1 270",
    "Cylinder 1 1 -1 -100",
    "Hyperboloid 1 0 -1 -0.5 1 1 500",
    "Paraboloid 1 0 1.5 -360",
    "Paraboloid 1 -0.2 -1.5 200",
    "Disk 0.5 1 -300",
    "Torus 1 0.4 300 -30 -270",
    "Torus 0.4 1 0 360 360",
    "Patch \"bilinear\" \"P\" [-1 -1 0.5 1 -1 -0.5 -1 1 -0.5 1 1 0.5]",
    "Basis \"catmull-rom\" \"catmull-rom\" Patch \"bicubic\" \"Pz\" [0 1 0 1 1 0 1 0 0 2 0 1 1 0 1 0]",
    "Basis \"power\" \"hermite\" Patch \"bicubic\" \"Pz\" [0 1 0 1 1 0 1 0 0 2 0 1 1 0 1 0]",
    "Patch \"bilinear\" \"Pw\" [-1 -1 0 1 2 -2 0 2 -0.5 0.5 0 0.5 1 1 1 1]",
    "NuPatch 4 3 [0 0 0 1 2 2 2] 0.25 2 3 2 [0 0 1 2 2] 0 2 \"P\" [-1 -1 0 0 -1 1 0.5 -1 0 1 -1 0 "
    "-1 0 1 0 0 0 0.5 0 1 1 0 0 -1 1 0 0 1 1 0.5 1 0 1 1 1]",
    "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4] [0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5] \"P\" "
    "[-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]",
    "SubdivisionMesh \"loop\" [3 3 3 3] [0 1 2 0 3 1 1 3 2 0 2 3] [\"crease\"] [2 1] [0 1] [3] \"P\" "
    "[-1 -1 -1 1 -1 -1 0 1 0 0 0 1]",
    "PointsGeneralPolygons [2] [4 3] [0 1 2 3 4 5 6] \"P\" [-1 -1 0 1 -1 0.2 1 1 0 -1 1 -0.2 -0.5 -0.5 0 0.5 "
    "-0.5 0.1 0 0.5 0]",
    "Basis \"bezier\" \"b-spline\" Curves \"cubic\" [6] \"periodic\" \"P\" [-1 -1 0 1 -1 1 1.5 0 0 1 1 0 -1 "
    "1 1 "
    "-1.5 0 0] \"varying float width\" [0.1 0.5 0.1 0.3 0 0.2]",
    "Curves \"linear\" [4] \"nonperiodic\" \"P\" [-1 -1 0 1 -1 1 1.5 0 0 -1 -0.9 0] \"constantwidth\" [0.4]",
    "Points \"P\" [0 0 0 1 1 0 -1 0.5 1] \"varying float width\" [1 0.5 0.01]",
    "ShadingRate 100 Blobby 1 [1001 0] [2 0 0 0 0 3 0 0 0 0 2 0 0.2 0 0 1] [\"\"]"};

struct Seen {
    size_t vertices = 0;  ///< within the picture
    double farthest_out = 0;
};

/// Of the vertices of all keys, in the picture: how far outside of their subpatches' pixels.
Seen look(const std::string& before, const std::string& surface, bool keep_all) {
    ReadOutcome read = read_text(before + " WorldBegin ShadingRate 4 Translate 0.4 -0.3 0 " +
                                 (keep_all ? "Attribute \"displacementbound\" \"sphere\" 1e4 " : "") +
                                 "MotionBegin [0 1] Translate -0.3 0.2 0 Translate 0.2 -0.1 -0.4 MotionEnd "
                                 "Rotate 25 1 0.5 0 " +
                                 surface + " WorldEnd");
    EXPECT_THAT(read.messages, ::testing::IsEmpty());
    TestScene scene;
    scene.scene = std::move(read.worlds.at(0));
    const RenderContext context = scene.context();
    const Tessellation tessellation(context);
    DiceScratch scratch;
    ShadingGrid grid;
    Seen seen;
    for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
        tessellation.dice(i, grid, scratch);
        const PixelRect bound = tessellation.subpatches()[i].bound;
        for (const Triples& P : grid.P)
            for (size_t n = 0; n < grid.vertex_count(); ++n) {
                if (P.at(n).z <= scene.scene.options.near_clip) continue;
                const V2f p = context.camera.raster_from_camera(P.at(n));
                if (!(p.x >= 0 && p.y >= 0 && p.x < 96 && p.y < 72)) continue;
                ++seen.vertices;
                const double out =
                    std::max({static_cast<float>(bound.x0) - p.x, p.x - static_cast<float>(bound.x1),
                              static_cast<float>(bound.y0) - p.y, p.y - static_cast<float>(bound.y1)});
                seen.farthest_out = std::max(seen.farthest_out, out);
            }
    }
    return seen;
}

TEST(Bounds, HoldWhatIsSeen) {
    const std::string size = "Format 96 72 1 Shutter 0 1 ";
    size_t most = 0;
    for (const std::string& surface : kSurfaces)
        for (const std::string& camera :
             {size +
                  "Projection \"orthographic\" ScreenWindow -2 2 -1.5 1.5 Clipping 0.1 100 Translate 0 0 5",
              size + "Projection \"orthographic\" ScreenWindow -0.4 0.4 -0.3 0.3 Clipping 0.1 100 Translate "
                     "0 0 5",
              size + "Projection \"perspective\" \"fov\" [40] Clipping 0.1 100 Translate 0 0 3.5",
              size + "Projection \"perspective\" \"fov\" [90] Clipping 0.1 100 Translate 0.3 0.2 0.5"}) {
            SCOPED_TRACE(surface + " before " + camera);
            const Seen seen = look(camera, surface, false);
            EXPECT_LE(seen.farthest_out, 1e-3);
            // Subpatches may be cut otherwise; what is in the picture is there in the same density.
            const Seen all = look(camera, surface, true);
            EXPECT_GE(seen.vertices, all.vertices * 0.999);
            most += seen.vertices > 100;
        }
    EXPECT_GT(most, 3 * kSurfaces.size());  // pictures that see enough
}

}  // namespace
}  // namespace trapeze::testing
