/// Derivatives as shaders see them: Du(P) and Dv(P) over a grid are dPdu and dPdv, for every kind of surface.
#include "shade/materials/shader_folder_harness.h"
#include "shade/shading.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

/// Vertices whose differences go to both sides alone: those on borders may have gone to their edges', whose
/// parameters are others.
bool is_inside(const GridShape& shape, size_t vertex) {
    const int column = static_cast<int>(vertex) % shape.vertices_u(),
              row = static_cast<int>(vertex) / shape.vertices_u();
    return column >= 2 && row >= 2 && column <= shape.nu - 2 && row <= shape.nv - 2;
}

/// Visits the vertices of a scene's shaded grids; Ci is what the shader found.
void shade_primitives(const std::string& text, const std::string& found,
                      const std::function<void(const ShadingGrid&, size_t)>& visit) {
    ReadOutcome read = read_text(
        "Format 100 100 1 ScreenWindow -3 3 -3 3 Projection \"orthographic\" Clipping 0.01 1000\nWorldBegin "
        "Translate 0 0 10 ShadingRate 0.25 Surface \"errors\" " +
        text + " WorldEnd");
    EXPECT_THAT(read.messages, ::testing::IsEmpty());
    ShaderFolder folder;
    folder.write("errors", "surface errors() { Ci = " + found + "; }");
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
    for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
        tessellation.dice(i, grid, dice_scratch);
        shading.shade(grid, shade_scratch, stats);
        for (size_t n = 0; n < grid.vertex_count(); ++n) visit(grid, n);
    }
}

/// What a shader finds of Du(P) against dPdu, and Dv(P) against dPdv, as shares of them.
struct Found {
    double worst = 0, mean = 0;
};

Found derivative_errors(const std::string& text) {
    Found found;
    double sum = 0, count = 0;
    shade_primitives(text,
                     "color(length(Du(P) - dPdu) / length(dPdu), length(Dv(P) - dPdv) / length(dPdv), 0)",
                     [&](const ShadingGrid& grid, size_t n) {
                         if (!is_inside(grid.shape, n)) return;
                         for (int k = 0; k < 2; ++k) {
                             const double error = grid.Ci.c[k][n];
                             found.worst = std::max(found.worst, error);
                             sum += error, count += 1;
                         }
                     });
    EXPECT_GT(count, 100);
    found.mean = sum / count;
    return found;
}

/// Heights over a square of 4 by 4 points.
const std::string kSheet =
    "\"P\" [-2 -2 0 -0.5 -2 1 0.5 -2 0 2 -2 1 -2 -0.5 0 -0.5 -0.5 0 0.5 -0.5 1 2 -0.5 0 "
    "-2 0.5 1 -0.5 0.5 0 0.5 0.5 0 2 0.5 1 -2 2 0 -0.5 2 1 0.5 2 1 2 2 0] ";
const std::string kFacesOfSheet =
    "[0 1 5 4 1 2 6 5 2 3 7 6 4 5 9 8 5 6 10 9 6 7 11 10 8 9 13 12 9 10 14 13 10 11 15 14] ";

std::string subdivision_mesh(const std::string& variables) {
    return "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4 4 4 4] " + kFacesOfSheet +
           "[\"interpolateboundary\"] [1 0] [1] [] " + kSheet + variables;
}
std::string polygons(const std::string& variables) {
    return "PointsPolygons [4 4 4 4 4 4 4 4 4] " + kFacesOfSheet + kSheet + variables;
}
/// Flat, and so whole faces.
std::string square(const std::string& variables) {
    return "PointsPolygons [4] [0 1 3 2] \"P\" [-2 -2 0 2 -2 1 -2 2 0 2 2 1] " + variables;
}

/// Surfaces whose s and t are those of TextureCoordinates.
std::vector<std::string> parametric_surfaces() {
    return {"Sphere 2 -1.5 1.5 -200",
            "Cone 2 2 360",
            "Cylinder 2 -1 1 100",
            "Hyperboloid 2 0 -1 0.5 2 2 720",
            "Paraboloid 2 0.5 2 360",
            "Disk 0 2 270",
            "Torus 1.5 0.5 30 300 -360",
            "Patch \"bicubic\" " + kSheet,
            "PatchMesh \"bilinear\" 4 \"nonperiodic\" 4 \"nonperiodic\" " + kSheet,
            "NuPatch 4 4 [0 0 0 0 2 2 2 2] 0.5 2 4 3 [0 0 0 1 3 3 3] 0 3 " + kSheet};
}

TEST(Derivatives, DifferencesAlongTheGridAreThoseOfTheSurface) {
    std::vector<std::string> all = parametric_surfaces();
    all.insert(all.end(), {subdivision_mesh(""), polygons("")});
    for (const std::string& text : all) {
        SCOPED_TRACE(text);
        // Many micropolygons, also where a side is seen end on.
        const Found found = derivative_errors("Attribute \"dice\" \"rasterorient\" [0] " + text);
        // Differences over two micropolygons of half a pixel, on curves of radius 8 and more.
        EXPECT_LE(found.mean, 0.004);
        EXPECT_LE(found.worst, 0.05);
    }
}

TEST(Derivatives, ByTextureCoordinatesOfAFlatPatchAreTheSameEverywhere) {
    for (const char* const coordinates :
         {"0 0 1 0 0 1 1 1", "0.1 0.3 1.1 0.3 0.1 1.3 1.1 1.3", "0 0 0 1 1 0 1 1",
          "7.7 1.3 7.7 0.3 6.7 1.3 6.7 0.3", "50 99 51 99 50 100 51 100"})
        shade_primitives(std::string("TextureCoordinates ") + coordinates +
                             " Patch \"bilinear\" \"P\" [-2 -2 0 2 -2 0 -2 2 0 2 2 0]",
                         "color(length(Deriv(P, s)), length(Deriv(P, t)), 0)",
                         [&](const ShadingGrid& grid, size_t n) {
                             for (int k = 0; k < 2; ++k)
                                 ASSERT_NEAR(grid.Ci.c[k][n], 4, 0.01) << coordinates << ' ' << n;
                         });
}

/// Where s goes along u alone and t along v alone, or the other way round, each has one term, everywhere.
TEST(Derivatives, ByWhatGoesAlongOneParameterHaveOneTerm) {
    const std::string s = "[.1 .5 .7 1.3 .1 .5 .7 1.3 .1 .5 .7 1.3 .1 .5 .7 1.3]",
                      t = "[.3 .3 .3 .3 .6 .6 .6 .6 1.1 1.1 1.1 1.1 1.7 1.7 1.7 1.7]", four = "[.1 .7 .1 .7]",
                      across = "[.3 .3 1.1 1.1]";
    const auto both = [](const std::string& storage, const std::string& along_u, const std::string& along_v) {
        return "\"" + storage + " float s\" " + along_u + " \"" + storage + " float t\" " + along_v;
    };
    std::vector<std::string> all = {"Sphere 2 -1.5 1.5 -200 " + both("varying", four, across),
                                    "Patch \"bicubic\" " + kSheet + both("varying", four, across),
                                    "Patch \"bicubic\" " + kSheet + both("vertex", s, t),
                                    square(both("varying", four, across)),
                                    subdivision_mesh(both("varying", s, t)),
                                    subdivision_mesh(both("vertex", s, t))};
    std::vector<std::string> parametric = parametric_surfaces();
    const std::string line = "\"P\" [-2 -2 0 -1 2 1 1 -2 -1 2 2 0] \"constantwidth\" [0.3]";
    parametric.insert(parametric.end(), {"Curves \"cubic\" [4] \"nonperiodic\" " + line,
                                         "Curves \"linear\" [4] \"nonperiodic\" " + line,
                                         "Points \"P\" [0 0 0 1 1 0] \"constantwidth\" [1.5]"});
    for (const std::string& text : parametric)
        all.push_back("TextureCoordinates 0.1 0.3 0.7 0.3 0.1 1.1 0.7 1.1 " + text);
    for (const std::string& text : all) {
        SCOPED_TRACE(text);
        double worst = 0;
        shade_primitives(text,
                         "color(length(Deriv(P, s) * Du(s) - Du(P)) / length(dPdu), "
                         "length(Deriv(P, t) * Dv(t) - Dv(P)) / length(dPdv), 0)",
                         [&](const ShadingGrid& grid, size_t n) {
                             for (int k = 0; k < 2; ++k)
                                 worst = std::max(worst, static_cast<double>(grid.Ci.c[k][n]));
                         });
        EXPECT_LE(worst, 1e-3);
    }
}

/// Polygons in planes of every lean, turned so that x and y run along none of the grid's axes; the last two
/// are parallel to the z axis.
const char* const kPolygons[] = {
    "Polygon \"P\" [-2 -2 0 2 -1 0 1 2 0 -2 1 0]",
    "Polygon \"P\" [0 -2 1 2 0 0 0 2 1 -2 0 2]",
    "PointsPolygons [3] [0 1 2] \"P\" [-2 -1 0 0 2 4 2 -1 0]",
    "GeneralPolygon [4] \"P\" [2 -2 1 -2 -2 -1 -2 2 1 2 2 3]",
    "Rotate 60 1 2 0 PointsGeneralPolygons [1] [4] [0 1 2 3] \"P\" [-2 0 0 2 0 0 2 0 3 -2 0 3]",
    "Rotate 60 1 2 0 Polygon \"P\" [-1 -1 0 1 1 0 1 1 3 -1 -1 3]"};

/// The least and the largest of a shader's red and green within grids.
std::array<double, 2> range_of(const std::string& text, const std::string& found) {
    std::array<double, 2> range = {1e9, -1e9};
    shade_primitives(text, found, [&](const ShadingGrid& grid, size_t n) {
        if (!is_inside(grid.shape, n)) return;
        for (int k = 0; k < 2; ++k) {
            const double value = grid.Ci.c[k][n];
            range = {std::min(range[0], value), std::max(range[1], value)};
        }
    });
    return range;
}

TEST(Derivatives, OfPolygonsAreByPlaceAndStayDefined) {
    for (const char* text : kPolygons) {
        SCOPED_TRACE(text);
        const Found found = derivative_errors(text);
        EXPECT_LE(found.mean, 0.001);
        EXPECT_LE(found.worst, 0.01);
        // dPdu and dPdv span the polygon's plane.
        EXPECT_GE(range_of(text, "color(abs(normalize(dPdu ^ dPdv) . normalize(Ng)), 1, 0)")[0], 0.999);
    }
}

TEST(Derivatives, ParametersOfPolygonsAreObjectXAndY) {
    const std::string x = "xcomp(transform(\"object\", P))", y = "ycomp(transform(\"object\", P))";
    for (const std::string text : kPolygons) {
        SCOPED_TRACE(text);
        EXPECT_LE(range_of("TextureCoordinates 1 1 2 2 3 3 4 4 " + text,
                           "color(abs(u - " + x + ") + abs(s - u), abs(v - " + y + ") + abs(t - v), 0)")[1],
                  1e-4);
    }
    const std::string du = "vtransform(\"object\", dPdu)", dv = "vtransform(\"object\", dPdv)";
    for (const char* text : {kPolygons[0], kPolygons[1], kPolygons[2], kPolygons[3]}) {
        SCOPED_TRACE(text);
        EXPECT_LE(range_of(text, "color(abs(xcomp(" + du + ") - 1) + abs(ycomp(" + du +
                                     ")) + abs(Du(u) - 1), abs(ycomp(" + dv + ") - 1) + abs(xcomp(" + dv +
                                     ")) + abs(Dv(u)), 0)")[1],
                  0.002);
    }
}

/// What filters of shaders do: abs(Du(f) * du) + abs(Dv(f) * dv) is how far f changes to the neighbours.
TEST(Derivatives, StepsOfPolygonsReachTheNextVertex) {
    const std::string f = "((P - point(0, 0, 0)) . normalize(dPdv))",
                      wide = "(abs(Du(" + f + ") * du) + abs(Dv(" + f + ") * dv)) / sqrt(area(P))";
    for (const char* text : kPolygons) {
        SCOPED_TRACE(text);
        const std::array<double, 2> range = range_of(text, "color(" + wide + ", 1, 0)");
        EXPECT_GT(range[0], 0.3);
        EXPECT_LT(range[1], 8);
    }
}

}  // namespace
}  // namespace trapeze::testing
