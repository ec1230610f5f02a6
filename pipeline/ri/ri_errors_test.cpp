/// What is wrong is reported, left out, and harms nothing.
#include <csetjmp>

#include "pipeline/ri/ri_harness.h"

namespace trapeze::ri {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(Ri, CallsOutsideOfBeginAndEndAreErrors) {
    RiSphere(1, -1, 1, 360, RI_NULL);
    EXPECT_EQ(RiDeclare("a", "float"), nullptr);
    EXPECT_EQ(RiLightSource("pointlight", RI_NULL), nullptr);
    RiEnd();
    EXPECT_THAT(reported_codes(),
                ElementsAre(RIE_NOTSTARTED, RIE_NOTSTARTED, RIE_NOTSTARTED, RIE_NOTSTARTED));
    EXPECT_THAT(reported()[0].text, HasSubstr("RiSphere"));
    EXPECT_EQ(RiLastError, RIE_NOTSTARTED);
}

TEST_F(Ri, UnknownTokensAreLeftOut) {
    const std::string rib = rib_of([] {
        RtFloat one = 1;
        RiSurface("plastic", "Kx", &one, "Kd", &one, "uniform florat y", &one, RI_NULL);
    });
    EXPECT_EQ(rib, "Surface \"plastic\" \"Kd\" [1]\n");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_BADTOKEN, RIE_BADTOKEN));
    EXPECT_EQ(reported()[0].severity, RIE_ERROR);
    EXPECT_THAT(reported()[0].text, HasSubstr("\"Kx\""));
}

TEST_F(Ri, DeclaredTokensAreKnownAndNotBefore) {
    const std::string rib = rib_of([] {
        RtFloat numbers[2] = {1, 2};
        RiSurface("s", "mine", numbers, RI_NULL);
        EXPECT_STREQ(RiDeclare("mine", "float[2]"), "mine");
        RiSurface("s", "mine", numbers, RI_NULL);
        EXPECT_EQ(RiDeclare("other", "no such type"), nullptr);
    });
    EXPECT_EQ(rib, "Surface \"s\"\nDeclare \"mine\" \"float[2]\"\nSurface \"s\" \"mine\" [1 2]\n");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_BADTOKEN, RIE_SYNTAX));
}

TEST_F(Ri, NestingIsChecked) {
    const std::string rib = rib_of([] {
        RiAttributeEnd();
        RiWorldBegin();
        RiFrameBegin(1);
        RiAttributeBegin();
        RiTransformEnd();
        RiFormat(1, 1, 1);
        RiAttributeEnd();
        RiMotionBegin(2, 0.0, 1.0);
        RiAttributeBegin();
        RiMotionEnd();
        RiWorldEnd();
    });
    EXPECT_EQ(rib,
              "WorldBegin\n  AttributeBegin\n  AttributeEnd\n  MotionBegin [0 1]\n  MotionEnd\nWorldEnd\n");
    EXPECT_THAT(reported_codes(),
                ElementsAre(RIE_NESTING, RIE_NESTING, RIE_NESTING, RIE_NOTOPTIONS, RIE_NESTING));
}

TEST_F(Ri, OpenBlocksAreReportedAtTheEnd) {
    rib_of([] { RiWorldBegin(); });
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_NESTING));
}

TEST_F(Ri, MotionTimesRise) {
    const std::string rib = rib_of([] {
        RiMotionBegin(2, 1.0, 0.0);
        RiMotionBegin(0);
        RiMotionBegin(-3);
    });
    EXPECT_EQ(rib, "");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_BADMOTION, RIE_BADMOTION, RIE_BADMOTION));
}

TEST_F(Ri, HandlesAreChecked) {
    const std::string rib = rib_of([] {
        int stranger = 0;
        RiIlluminate(nullptr, RI_TRUE);
        RiIlluminate(&stranger, RI_TRUE);
        RiObjectInstance(&stranger);
    });
    EXPECT_EQ(rib, "");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_BADHANDLE, RIE_BADHANDLE, RIE_BADHANDLE));
}

TEST_F(Ri, NumbersOutOfRangeAreErrors) {
    const std::string rib = rib_of([] {
        RtFloat numbers[64] = {};
        RtInt two[] = {2}, minus[] = {-4}, three[] = {3}, corners[] = {0, -1, 2};
        RiPolygon(2, RI_P, numbers, RI_NULL);
        RiGeneralPolygon(-1, minus, RI_P, numbers, RI_NULL);
        RiGeneralPolygon(1, minus, RI_P, numbers, RI_NULL);
        RiPointsPolygons(1, three, corners, RI_P, numbers, RI_NULL);
        RiPoints(0, RI_P, numbers, RI_NULL);
        RiPoints(-7, RI_P, numbers, RI_NULL);
        RiCurves(RI_CUBIC, 1, two, RI_NONPERIODIC, RI_P, numbers, RI_NULL);
        RiBasis(RiBezierBasis, 0, RiBezierBasis, 3);
        RiNuPatch(2, 3, numbers, 0, 1, 2, 2, numbers, 0, 1, RI_P, numbers, RI_NULL);
        RiColorSamples(0, numbers, numbers);
    });
    EXPECT_EQ(rib, "");
    EXPECT_THAT(reported_codes(), ::testing::Each(RIE_RANGE));
    EXPECT_EQ(reported().size(), 10u);
}

TEST_F(Ri, MeshesThatDoNotFitTheirBasisAreErrors) {
    const std::string rib = rib_of([] {
        RtFloat numbers[64] = {};
        RtInt five[] = {5};
        RiPatchMesh(RI_BICUBIC, 5, RI_NONPERIODIC, 4, RI_NONPERIODIC, RI_P, numbers, RI_NULL);
        RiCurves(RI_CUBIC, 1, five, RI_NONPERIODIC, RI_P, numbers, RI_NULL);
    });
    EXPECT_EQ(rib, "");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_CONSISTENCY, RIE_CONSISTENCY));
}

TEST_F(Ri, SizesBeyondAllReasonAreErrors) {
    const std::string rib = rib_of([] {
        RtFloat numbers[4] = {};
        RtInt three[] = {3}, corners[] = {0, 1, 2147483647}, huge[] = {2147483647, 2147483647};
        RiPointsPolygons(1, three, corners, RI_P, numbers, RI_NULL);
        RiGeneralPolygon(2, huge, RI_P, numbers, RI_NULL);
        RiPatchMesh(RI_BILINEAR, 2147483647, RI_NONPERIODIC, 2147483647, RI_NONPERIODIC, RI_P, numbers,
                    RI_NULL);
        RiNuPatch(2147483647, 4, numbers, 0, 1, 4, 4, numbers, 0, 1, RI_P, numbers, RI_NULL);
    });
    EXPECT_EQ(rib, "");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_RANGE, RIE_LIMIT, RIE_LIMIT, RIE_LIMIT));
}

RtFloat own_filter(RtFloat, RtFloat, RtFloat, RtFloat) {
    return 1;
}

TEST_F(Ri, FiltersOfTheProgramCannotBeSaid) {
    EXPECT_EQ(rib_of([] { RiPixelFilter(own_filter, 2, 2); }), "");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_INCAPABLE));
}

TEST_F(Ri, NullArgumentsAreErrorsAndNothingWorse) {
    const std::string rib = rib_of([] {
        RtInt one[] = {1}, three[] = {3};
        RiPixelFilter(nullptr, 2, 2), RiQuantize(nullptr, 1, 2, 3, 4), RiColorSamples(3, nullptr, nullptr);
        RiImager(nullptr, RI_NULL), RiDisplay(nullptr, nullptr, nullptr, RI_NULL),
            RiDisplayChannel(nullptr, RI_NULL);
        RiHider(nullptr, RI_NULL), RiOption(nullptr, RI_NULL), RiColor(nullptr), RiOpacity(nullptr);
        RiLightSource(nullptr, RI_NULL), RiAreaLightSource(nullptr, RI_NULL), RiSurface(nullptr, RI_NULL);
        RiDisplacement(nullptr, RI_NULL), RiAtmosphere(nullptr, RI_NULL), RiInterior(nullptr, RI_NULL);
        RiExterior(nullptr, RI_NULL), RiDeformation(nullptr, RI_NULL), RiShadingInterpolation(nullptr);
        RiBound(nullptr), RiDetail(nullptr), RiGeometricApproximation(nullptr, 1),
            RiGeometricRepresentation(nullptr);
        RiOrientation(nullptr), RiAttribute(nullptr, RI_NULL), RiTransform(nullptr),
            RiConcatTransform(nullptr);
        RiCoordinateSystem(nullptr), RiScopedCoordinateSystem(nullptr), RiCoordSysTransform(nullptr);
        RiTransformPoints(nullptr, nullptr, 1, nullptr), RiTransformPoints("world", "camera", 1, nullptr);
        RiBasis(nullptr, 1, nullptr, 1), RiGeneralPolygon(1, nullptr, RI_NULL);
        RiPointsPolygons(1, nullptr, nullptr, RI_NULL), RiPointsPolygons(1, three, nullptr, RI_NULL);
        RiPointsGeneralPolygons(1, nullptr, nullptr, nullptr, RI_NULL);
        RiPointsGeneralPolygons(1, one, nullptr, nullptr, RI_NULL);
        RiSubdivisionMesh(nullptr, 1, nullptr, nullptr, 0, nullptr, nullptr, nullptr, nullptr, RI_NULL);
        RiSubdivisionMesh("loop", 0, nullptr, nullptr, 1, nullptr, nullptr, nullptr, nullptr, RI_NULL);
        RiPatch(nullptr, RI_NULL), RiPatchMesh(RI_BILINEAR, 2, nullptr, 2, nullptr, RI_NULL);
        RiNuPatch(2, 2, nullptr, 0, 1, 2, 2, nullptr, 0, 1, RI_NULL),
            RiHyperboloid(nullptr, nullptr, 1, RI_NULL);
        RiTrimCurve(1, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr);
        RiTrimCurve(1, one, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr);
        RiCurves(nullptr, 1, nullptr, nullptr, RI_NULL),
            RiCurves(RI_LINEAR, 1, nullptr, RI_PERIODIC, RI_NULL);
        RiBlobby(1, 1, nullptr, 1, nullptr, 1, nullptr, RI_NULL), RiGeometry(nullptr, RI_NULL);
        RiProcedural(nullptr, nullptr, nullptr, nullptr);
        RiProcedural(nullptr, nullptr, RiProcRunProgram, RiProcFree);
        RiSolidBegin(nullptr), RiMotionBeginV(2, nullptr), RiArchiveRecord(nullptr, "x"),
            RiReadArchive(nullptr, nullptr, RI_NULL);
        RiMakeTexture(nullptr, nullptr, nullptr, nullptr, nullptr, 1, 1, RI_NULL);
        RiMakeShadow(nullptr, nullptr, RI_NULL);
        RiDeclare(nullptr, nullptr);
        RtToken tokens[] = {nullptr, "Kd", "string w"};
        RtString nothing = nullptr;
        RtPointer values[] = {&nothing, nullptr, &nothing};
        RiSurfaceV("matte", 3, tokens, values);
        RiSurfaceV("matte", 1, nullptr, nullptr);
    });
    // An imager may be null, and a call whose parameters are wrong goes without them.
    EXPECT_EQ(rib, "Imager \"null\"\nSurface \"matte\"\n");
    EXPECT_THAT(reported_codes(),
                ::testing::Each(::testing::AnyOf(RIE_MISSINGDATA, RIE_BADTOKEN, RIE_RANGE)));
    EXPECT_GT(reported().size(), 60u);
}

void endless(RtPointer, RtFloat) {
    RtBound bound = {};
    RiProcedural(nullptr, bound, endless, nullptr);
}

TEST_F(Ri, ProceduralsWithoutEndAreCutOff) {
    rib_of([] { endless(nullptr, 1); });
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_LIMIT));
}

TEST_F(Ri, HandlersAreTheProgramsChoice) {
    RiErrorHandler(RiErrorIgnore);
    RiEnd();
    EXPECT_TRUE(reported().empty());
    EXPECT_EQ(RiLastError, RIE_NOTSTARTED);

    RiErrorHandler(RiErrorPrint);
    ::testing::internal::CaptureStderr();
    RiEnd();
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("RiEnd: RiBegin has not been called"));
}

TEST_F(Ri, AbortEndsTheProgramAtErrorsOnly) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // a render before it may have left threads
    RiErrorHandler(RiErrorAbort);
    EXPECT_EXIT(RiEnd(), ::testing::ExitedWithCode(1), "RiBegin has not been called");
    RiErrorAbort(RIE_NOERROR, RIE_WARNING, nullptr);
}

std::jmp_buf out;

void jump(RtInt, RtInt, char*) {
    std::longjmp(out, 1);
}

TEST_F(Ri, HandlersMayJumpAway) {
    RiErrorHandler(jump);
    if (setjmp(out) == 0) {
        RiSides(2);
        FAIL() << "the handler was not called";
    }
    RiErrorHandler(take_report);
    EXPECT_EQ(rib_of([] { RiSides(2); }), "Sides 2\n");
}

}  // namespace
}  // namespace trapeze::ri
