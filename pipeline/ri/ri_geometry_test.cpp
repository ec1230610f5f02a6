/// Geometry: what is written, and how long the arrays are (RISpec 5.1, table 5.2).
#include <numeric>

#include "pipeline/ri/ri_harness.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::ri {
namespace {

using ::testing::ElementsAre;

/// 0, 1, 2, ... for every variable.
RtFloat* ramp() {
    static std::vector<RtFloat> numbers = [] {
        std::vector<RtFloat> all(4096);
        std::iota(all.begin(), all.end(), 0.0f);
        return all;
    }();
    return numbers.data();
}

/// How many numbers the constant, uniform, varying, vertex and facevarying variables of a request have.
std::vector<size_t> lengths_in(const std::string& rib) {
    Diagnostics diagnostics;
    rib::Lexer lexer(rib, {0, 1, 1});
    rib::RequestText request;
    std::vector<size_t> lengths;
    while (rib::read_request(
        lexer, request, [](std::string_view) { return true; }, diagnostics)) {
        EXPECT_EQ(request.problem, "");
        for (size_t i = 0; i + 1 < request.arguments.size(); ++i) {
            const rib::Argument& token = request.arguments[i];
            if (token.kind == rib::Argument::Kind::String && token.strings[0].ends_with(" x"))
                lengths.push_back(request.arguments[i + 1].floats.size());
        }
    }
    return lengths;
}

RtToken kTokens[] = {"constant float x", "uniform float x", "varying float x", "vertex float x",
                     "facevarying float x"};
RtPointer kValues[] = {ramp(), ramp(), ramp(), ramp(), ramp()};

struct Counted {
    const char* name;
    void (*calls)(RtInt n, RtToken* tokens, RtPointer* values);
    std::vector<size_t> lengths;
};

class RiLengths : public Ri, public ::testing::WithParamInterface<Counted> {};

TEST_P(RiLengths, FollowFromThePrimitive) {
    const std::string rib = rib_of([] { GetParam().calls(5, kTokens, kValues); });
    EXPECT_EQ(lengths_in(rib), GetParam().lengths);
    EXPECT_TRUE(reported().empty()) << reported().front().text;
}

RtInt kTwoFaces[] = {4, 3}, kSevenCorners[] = {0, 1, 4, 3, 1, 2, 4};
RtFloat kKnots[] = {0, 0, 0, 1, 2, 3, 3, 3};

// Constant, uniform, varying, vertex, facevarying.
const Counted kCounted[] = {
    {"Polygon", [](RtInt n, RtToken* t, RtPointer* v) { RiPolygonV(5, n, t, v); }, {1, 1, 5, 5, 5}},
    {"GeneralPolygon",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RtInt loops[] = {4, 3};
         RiGeneralPolygonV(2, loops, n, t, v);
     },
     {1, 1, 7, 7, 7}},
    {"PointsPolygons",
     [](RtInt n, RtToken* t, RtPointer* v) { RiPointsPolygonsV(2, kTwoFaces, kSevenCorners, n, t, v); },
     {1, 2, 5, 5, 7}},
    {"PointsGeneralPolygons",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RtInt loops[] = {2};
         RiPointsGeneralPolygonsV(1, loops, kTwoFaces, kSevenCorners, n, t, v);
     },
     {1, 1, 5, 5, 7}},
    {"SubdivisionMesh",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RiSubdivisionMeshV("catmull-clark", 2, kTwoFaces, kSevenCorners, 0, nullptr, nullptr, nullptr,
                            nullptr, n, t, v);
     },
     {1, 2, 5, 5, 7}},
    {"BilinearPatch",
     [](RtInt n, RtToken* t, RtPointer* v) { RiPatchV(RI_BILINEAR, n, t, v); },
     {1, 1, 4, 4, 4}},
    {"BicubicPatch",
     [](RtInt n, RtToken* t, RtPointer* v) { RiPatchV(RI_BICUBIC, n, t, v); },
     {1, 1, 4, 16, 4}},
    // Bezier steps of 3: 2 x 1 patches; B-splines' of 1: 4 x 4 wrapped along u.
    {"BezierMesh",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RiPatchMeshV(RI_BICUBIC, 7, "nonperiodic", 4, "nonperiodic", n, t, v);
     },
     {1, 2, 6, 28, 8}},
    {"BSplineMesh",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RiBasis(RiBSplineBasis, RI_BSPLINESTEP, RiBSplineBasis, RI_BSPLINESTEP);
         RiPatchMeshV(RI_BICUBIC, 4, "periodic", 7, "nonperiodic", n, t, v);
     },
     {1, 16, 20, 28, 64}},
    {"BilinearMesh",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RiPatchMeshV(RI_BILINEAR, 3, "periodic", 2, "nonperiodic", n, t, v);
     },
     {1, 3, 6, 6, 12}},
    // 5 points of order 3 have 3 segments, 4 of order 4 have 1.
    {"NuPatch",
     [](RtInt n, RtToken* t, RtPointer* v) { RiNuPatchV(5, 3, kKnots, 0, 3, 4, 4, kKnots, 0, 3, n, t, v); },
     {1, 3, 8, 20, 12}},
    {"Sphere", [](RtInt n, RtToken* t, RtPointer* v) { RiSphereV(1, -1, 1, 360, n, t, v); }, {1, 1, 4, 4, 4}},
    {"Torus",
     [](RtInt n, RtToken* t, RtPointer* v) { RiTorusV(2, 1, 0, 360, 360, n, t, v); },
     {1, 1, 4, 4, 4}},
    {"Points", [](RtInt n, RtToken* t, RtPointer* v) { RiPointsV(6, n, t, v); }, {1, 1, 6, 6, 6}},
    {"LinearCurves",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RtInt counts[] = {2, 5};
         RiCurvesV(RI_LINEAR, 2, counts, RI_NONPERIODIC, n, t, v);
     },
     {1, 2, 7, 7, 7}},
    {"BezierCurves",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RtInt counts[] = {4, 7};
         RiCurvesV(RI_CUBIC, 2, counts, RI_NONPERIODIC, n, t, v);
     },
     {1, 2, 5, 11, 5}},
    {"PeriodicCurves",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RtInt counts[] = {6};
         RiCurvesV(RI_CUBIC, 1, counts, RI_PERIODIC, n, t, v);
     },
     {1, 1, 2, 6, 2}},
    {"Blobby",
     [](RtInt n, RtToken* t, RtPointer* v) {
         RtInt code[] = {1001, 0, 1001, 16, 0, 2, 0, 1};
         RiBlobbyV(2, 8, code, 32, ramp(), 0, nullptr, n, t, v);
     },
     {1, 1, 2, 2, 2}},
};

std::string name_of(const ::testing::TestParamInfo<Counted>& counted) {
    return counted.param.name;
}

INSTANTIATE_TEST_SUITE_P(Classes, RiLengths, ::testing::ValuesIn(kCounted), name_of);

TEST_F(Ri, LengthsCountTheTypeAndTheArray) {
    const std::string rib = rib_of([] {
        RiPoints(2, RI_P, ramp(), "varying float[3] a", ramp(), RI_CS, ramp(), "constant matrix m", ramp(),
                 RI_ST, ramp(), RI_WIDTH, ramp(), RI_NULL);
    });
    EXPECT_EQ(rib,
              "Points \"P\" [0 1 2 3 4 5] \"varying float[3] a\" [0 1 2 3 4 5] \"Cs\" [0 1 2 3 4 5] "
              "\"constant matrix "
              "m\" [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15] \"st\" [0 1 2 3] \"width\" [0 1]\n");
}

TEST_F(Ri, WritesMeshesAsRISpecDoes) {
    const std::string rib = rib_of([] {
        RtInt counts[] = {3}, corners[] = {0, 1, 2}, nargs[] = {0, 0, 2, 1}, ints[] = {0, 1};
        RtFloat sharpness[] = {2.5f};
        RtToken tags[] = {RI_INTERPOLATEBOUNDARY, RI_CREASE};
        RiSubdivisionMesh("loop", 1, counts, corners, 2, tags, nargs, ints, sharpness, RI_P, ramp(), RI_NULL);
        RiPointsPolygons(1, counts, corners, RI_P, ramp(), RI_NULL);
    });
    EXPECT_EQ(rib,
              "SubdivisionMesh \"loop\" [3] [0 1 2] [\"interpolateboundary\" \"crease\"] [0 0 2 1] [0 1] "
              "[2.5] \"P\" [0 "
              "1 2 3 4 5 6 7 8]\n"
              "PointsPolygons [3] [0 1 2] \"P\" [0 1 2 3 4 5 6 7 8]\n");
}

TEST_F(Ri, WritesQuadrics) {
    const std::string rib = rib_of([] {
        RtPoint p = {0, 1, 2}, q = {3, 4, 5};
        RiCone(0.5f, 1, 270, RI_NULL);
        RiCylinder(1, 0, 2, 360, RI_NULL);
        RiHyperboloid(p, q, 360, RI_NULL);
        RiParaboloid(1, 2, 3, 120, RI_NULL);
        RiDisk(1, 0.5f, 270, RI_NULL);
        RiTorus(1, 0.25f, 60, 90, 360, RI_NULL);
    });
    EXPECT_EQ(rib,
              "Cone 0.5 1 270\nCylinder 1 0 2 360\nHyperboloid 0 1 2 3 4 5 360\nParaboloid 1 2 3 120\nDisk 1 "
              "0.5 270\n"
              "Torus 1 0.25 60 90 360\n");
}

TEST_F(Ri, WritesPatchesAndTheirBases) {
    const std::string rib = rib_of([] {
        RtBasis own = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16}};
        RtFloat knots[] = {0, 0, 1, 1};
        RiBasis(RiBezierBasis, RI_BEZIERSTEP, RiCatmullRomBasis, RI_CATMULLROMSTEP);
        RiBasis(RiHermiteBasis, RI_HERMITESTEP, own, 2);
        RiPatch(RI_BILINEAR, RI_P, ramp(), RI_NULL);
        RiPatchMesh(RI_BILINEAR, 2, RI_NONPERIODIC, 2, RI_NONPERIODIC, RI_PZ, ramp(), RI_NULL);
        RiNuPatch(2, 2, knots, 0, 1, 2, 2, knots, 0, 1, RI_PW, ramp(), RI_NULL);
    });
    EXPECT_EQ(rib,
              "Basis \"bezier\" 3 \"catmull-rom\" 1\n"
              "Basis \"hermite\" 2 [1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16] 2\n"
              "Patch \"bilinear\" \"P\" [0 1 2 3 4 5 6 7 8 9 10 11]\n"
              "PatchMesh \"bilinear\" 2 \"nonperiodic\" 2 \"nonperiodic\" \"Pz\" [0 1 2 3]\n"
              "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"Pw\" [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15]\n");
}

TEST_F(Ri, WritesTrimCurves) {
    const std::string rib = rib_of([] {
        RtInt loops[] = {2}, order[] = {2, 3}, n[] = {2, 3};
        RtFloat knots[] = {0, 0, 1, 1, 0, 0, 0, 1, 1, 1}, min[] = {0, 0}, max[] = {1, 1};
        RtFloat u[] = {0, 1, 1, 2, 0}, v[] = {0, 0, 0, 1, 0}, w[] = {1, 1, 1, 1, 1};
        RiTrimCurve(1, loops, order, knots, min, max, n, u, v, w);
    });
    EXPECT_EQ(
        rib,
        "TrimCurve [2] [2 3] [0 0 1 1 0 0 0 1 1 1] [0 0] [1 1] [2 3] [0 1 1 2 0] [0 0 0 1 0] [1 1 1 1 1]\n");
}

TEST_F(Ri, WritesCurvesBlobbiesAndGeometry) {
    const std::string rib = rib_of([] {
        RtInt counts[] = {2}, code[] = {1003, 0, 0};
        RtFloat constant = 0.5f;
        RtString file = "plane.z";
        RiCurves(RI_LINEAR, 1, counts, RI_NONPERIODIC, RI_P, ramp(), RI_CONSTANTWIDTH, &constant, RI_NULL);
        RiBlobby(1, 3, code, 4, ramp(), 1, &file, RI_NULL);
        RiGeometry("teapot", RI_NULL);
    });
    EXPECT_EQ(rib,
              "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 1 2 3 4 5] \"constantwidth\" [0.5]\n"
              "Blobby 1 [1003 0 0] [0 1 2 3] [\"plane.z\"]\n"
              "Geometry \"teapot\"\n");
}

int freed = 0;
RtFloat asked = 0;

void free_it(RtPointer) {
    ++freed;
}

void make_disk(RtPointer data, RtFloat detail) {
    asked = detail;
    RtColor green = {0, 1, 0};
    RiColor(green);
    RiDisk(*static_cast<RtFloat*>(data), 1, 360, RI_NULL);
}

TEST_F(Ri, ProceduralsOfTheProgramRunAtOnceAndTheOthersLater) {
    freed = 0;
    const std::string rib = rib_of([] {
        RtFloat height = 3;
        RtString archive[] = {"tree.rib"}, program[] = {"grow", "-n 5"};
        RtBound bound = {0, 1, 0, 1, 0, 1};
        RiProcedural(&height, bound, make_disk, free_it);
        RiProcedural(archive, bound, RiProcDelayedReadArchive, free_it);
        RiProcedural(program, bound, RiProcRunProgram, nullptr);
        RiProcedural(program, bound, RiProcDynamicLoad, nullptr);
    });
    EXPECT_EQ(rib,
              "AttributeBegin\n  Color [0 1 0]\n  Disk 3 1 360\nAttributeEnd\n"
              "Procedural \"DelayedReadArchive\" [\"tree.rib\"] [0 1 0 1 0 1]\n"
              "Procedural \"RunProgram\" [\"grow\" \"-n 5\"] [0 1 0 1 0 1]\n"
              "Procedural \"DynamicLoad\" [\"grow\" \"-n 5\"] [0 1 0 1 0 1]\n");
    EXPECT_EQ(asked, RI_INFINITY);
    EXPECT_EQ(freed, 2);
}

}  // namespace
}  // namespace trapeze::ri
