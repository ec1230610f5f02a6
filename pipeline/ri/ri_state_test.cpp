/// Options, attributes, transformations, blocks: what is written.
#include "pipeline/ri/ri_harness.h"

namespace trapeze::ri {
namespace {

using ::testing::ElementsAre;

TEST_F(Ri, WritesAWholeFrame) {
    const std::string rib = rib_of([] {
        RtFloat fov = 30;
        RtColor red = {1, 0.25f, 0};
        RiFrameBegin(7);
        RiFormat(320, 200, 1);
        RiProjection(RI_PERSPECTIVE, RI_FOV, &fov, RI_NULL);
        RiTranslate(0, 0, 5);
        RiWorldBegin();
        RiAttributeBegin();
        RiColor(red);
        RiSphere(1, -1, 1, 360, RI_NULL);
        RiAttributeEnd();
        RiWorldEnd();
        RiFrameEnd();
    });
    EXPECT_EQ(rib,
              "FrameBegin 7\n"
              "  Format 320 200 1\n"
              "  Projection \"perspective\" \"fov\" [30]\n"
              "  Translate 0 0 5\n"
              "  WorldBegin\n"
              "    AttributeBegin\n"
              "      Color [1 0.25 0]\n"
              "      Sphere 1 -1 1 360\n"
              "    AttributeEnd\n"
              "  WorldEnd\n"
              "FrameEnd\n");
    EXPECT_TRUE(reported().empty());
}

struct Example {
    const char* name;
    void (*calls)();
    const char* rib;
};

RtMatrix kMatrix = {{2, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 4, 0}, {5, 6, 7, 1}};
RtBound kBound = {-1, 1, -2, 2, -3, 3};
RtString kWord = "word";
RtFloat kHalf = 0.5f;

class RiExamples : public Ri, public ::testing::WithParamInterface<Example> {};

TEST_P(RiExamples, IsWrittenAsRISpecDoes) {
    EXPECT_EQ(rib_of(GetParam().calls), std::string(GetParam().rib) + "\n");
    EXPECT_TRUE(reported().empty()) << reported().front().text;
}

const Example kOptions[] = {
    {"FrameAspectRatio", [] { RiFrameAspectRatio(1.5f); }, "FrameAspectRatio 1.5"},
    {"ScreenWindow", [] { RiScreenWindow(-1, 1, -2, 2); }, "ScreenWindow -1 1 -2 2"},
    {"CropWindow", [] { RiCropWindow(0, 0.5f, 0.25f, 1); }, "CropWindow 0 0.5 0.25 1"},
    {"Clipping", [] { RiClipping(0.1f, 1000); }, "Clipping 0.1 1000"},
    {"ClippingPlane", [] { RiClippingPlane(1, 2, 3, 0, 0, -1); }, "ClippingPlane 1 2 3 0 0 -1"},
    {"DepthOfField", [] { RiDepthOfField(22, 45, 1200); }, "DepthOfField 22 45 1200"},
    {"Shutter", [] { RiShutter(0.1f, 0.9f); }, "Shutter 0.1 0.9"},
    {"PixelVariance", [] { RiPixelVariance(0.01f); }, "PixelVariance 0.01"},
    {"PixelSamples", [] { RiPixelSamples(2, 3); }, "PixelSamples 2 3"},
    {"PixelFilter", [] { RiPixelFilter(RiGaussianFilter, 2, 1); }, "PixelFilter \"gaussian\" 2 1"},
    {"CatmullRom", [] { RiPixelFilter(RiCatmullRomFilter, 4, 4); }, "PixelFilter \"catmull-rom\" 4 4"},
    {"Exposure", [] { RiExposure(1.5f, 2.3f); }, "Exposure 1.5 2.3"},
    {"Quantize", [] { RiQuantize(RI_RGBA, 255, 0, 255, 0.5f); }, "Quantize \"rgba\" 255 0 255 0.5"},
    {"RelativeDetail", [] { RiRelativeDetail(0.6f); }, "RelativeDetail 0.6"},
    {"Imager", [] { RiImager("cmyk", RI_NULL); }, "Imager \"cmyk\""},
    {"Display", [] { RiDisplay("a.exr", RI_FILE, RI_RGBA, RI_NULL); }, "Display \"a.exr\" \"file\" \"rgba\""},
    {"DisplayQuantize",
     [] {
         RtFloat quantize[4] = {0, 255, 0, 255};
         RiDisplay("a", "b", "rgb", "quantize", quantize, RI_NULL);
     },
     "Display \"a\" \"b\" \"rgb\" \"quantize\" [0 255 0 255]"},
    {"DisplayChannel", [] { RiDisplayChannel("color foo", RI_NULL); }, "DisplayChannel \"color foo\""},
    {"Hider", [] { RiHider(RI_HIDDEN, RI_NULL); }, "Hider \"hidden\""},
    {"Option",
     [] {
         RtInt sizes[2] = {12, 8};
         RiOption("limits", "bucketsize", sizes, RI_NULL);
     },
     "Option \"limits\" \"bucketsize\" [12 8]"},
    {"Transfer",
     [] {
         RtString transfer = "srgb";
         RiOption("color", "transfer", &transfer, RI_NULL);
     },
     "Option \"color\" \"transfer\" [\"srgb\"]"},
    {"DisplayColorspace",
     [] {
         RtString linear = "linear";
         RiDisplay("a", "b", "rgb", "colorspace", &linear, RI_NULL);
     },
     "Display \"a\" \"b\" \"rgb\" \"colorspace\" [\"linear\"]"},
    {"NoProjection", [] { RiProjection(RI_NULL, RI_NULL); }, "Projection \"null\""},
};

const Example kAttributes[] = {
    {"Opacity",
     [] {
         RtColor o = {0.5f, 1, 1};
         RiOpacity(o);
     },
     "Opacity [0.5 1 1]"},
    {"TextureCoordinates", [] { RiTextureCoordinates(0, 0, 2, -0.5f, -0.5f, 1.75f, 3, 3); },
     "TextureCoordinates 0 0 2 -0.5 -0.5 1.75 3 3"},
    {"LightSource",
     [] {
         RtFloat angle = 5;
         RiIlluminate(RiLightSource("spotlight", RI_CONEANGLE, &angle, RI_NULL), RI_FALSE);
     },
     "LightSource \"spotlight\" 1 \"coneangle\" [5]\nIlluminate 1 0"},
    {"AreaLightSource", [] { RiAreaLightSource("finite", RI_NULL); }, "AreaLightSource \"finite\" 1"},
    {"Surface", [] { RiSurface("wood", RI_ROUGHNESS, &kHalf, "string grain", &kWord, RI_NULL); },
     "Surface \"wood\" \"roughness\" [0.5] \"string grain\" [\"word\"]"},
    {"Displacement", [] { RiDisplacement("displaceit", RI_NULL); }, "Displacement \"displaceit\""},
    {"Atmosphere", [] { RiAtmosphere("fog", RI_NULL); }, "Atmosphere \"fog\""},
    {"Interior", [] { RiInterior("water", RI_NULL); }, "Interior \"water\""},
    {"Exterior", [] { RiExterior("fog", RI_NULL); }, "Exterior \"fog\""},
    {"Deformation", [] { RiDeformation("stretch", RI_NULL); }, "Deformation \"stretch\""},
    {"ShadingRate", [] { RiShadingRate(0.25f); }, "ShadingRate 0.25"},
    {"ShadingInterpolation", [] { RiShadingInterpolation(RI_SMOOTH); }, "ShadingInterpolation \"smooth\""},
    {"Matte", [] { RiMatte(RI_TRUE); }, "Matte 1"},
    {"Bound", [] { RiBound(kBound); }, "Bound [-1 1 -2 2 -3 3]"},
    {"Detail", [] { RiDetail(kBound); }, "Detail [-1 1 -2 2 -3 3]"},
    {"DetailRange", [] { RiDetailRange(0, 0, 10, RI_INFINITY); }, "DetailRange 0 0 10 1e+38"},
    {"Approximation", [] { RiGeometricApproximation(RI_FLATNESS, 2.5f); },
     "GeometricApproximation \"flatness\" 2.5"},
    {"Representation", [] { RiGeometricRepresentation("smooth"); }, "GeometricRepresentation \"smooth\""},
    {"Orientation", [] { RiOrientation(RI_LH); }, "Orientation \"lh\""},
    {"ReverseOrientation", [] { RiReverseOrientation(); }, "ReverseOrientation"},
    {"Sides", [] { RiSides(1); }, "Sides 1"},
    {"Attribute", [] { RiAttribute(RI_IDENTIFIER, RI_NAME, &kWord, RI_NULL); },
     "Attribute \"identifier\" \"name\" [\"word\"]"},
    {"Declare", [] { RiDeclare("Np", "uniform point"); }, "Declare \"Np\" \"uniform point\""},
};

const Example kTransforms[] = {
    {"Identity", [] { RiIdentity(); }, "Identity"},
    {"Transform", [] { RiTransform(kMatrix); }, "Transform [2 0 0 0 0 3 0 0 0 0 4 0 5 6 7 1]"},
    {"ConcatTransform", [] { RiConcatTransform(kMatrix); },
     "ConcatTransform [2 0 0 0 0 3 0 0 0 0 4 0 5 6 7 1]"},
    {"Perspective", [] { RiPerspective(90); }, "Perspective 90"},
    {"Rotate", [] { RiRotate(90, 0, 1, 0); }, "Rotate 90 0 1 0"},
    {"Scale", [] { RiScale(0.5f, 1, 2); }, "Scale 0.5 1 2"},
    {"Skew", [] { RiSkew(45, 0, 1, 0, 1, 0, 0); }, "Skew 45 0 1 0 1 0 0"},
    {"CoordinateSystem", [] { RiCoordinateSystem("lamptop"); }, "CoordinateSystem \"lamptop\""},
    {"ScopedCoordinateSystem", [] { RiScopedCoordinateSystem("hand"); }, "ScopedCoordinateSystem \"hand\""},
    {"CoordSysTransform",
     [] {
         RiCoordinateSystem("lamptop");
         RiCoordSysTransform("lamptop");
     },
     "CoordinateSystem \"lamptop\"\nCoordSysTransform \"lamptop\""},
    {"TransformBlock",
     [] {
         RiTransformBegin();
         RiTransformEnd();
     },
     "TransformBegin\nTransformEnd"},
};

const Example kStructure[] = {
    {"Motion",
     [] {
         RiMotionBegin(2, 0.0, 1.0);
         RiRotate(45, 0, 0, 1);
         RiRotate(90, 0, 0, 1);
         RiMotionEnd();
     },
     "MotionBegin [0 1]\n  Rotate 45 0 0 1\n  Rotate 90 0 0 1\nMotionEnd"},
    {"Solid",
     [] {
         RiSolidBegin(RI_DIFFERENCE);
         RiSolidEnd();
     },
     "SolidBegin \"difference\"\nSolidEnd"},
    {"Object",
     [] {
         const RtObjectHandle first = RiObjectBegin();
         RiObjectEnd();
         const RtObjectHandle second = RiObjectBegin();
         RiObjectEnd();
         RiObjectInstance(second);
         RiObjectInstance(first);
     },
     "ObjectBegin 1\nObjectEnd\nObjectBegin 2\nObjectEnd\nObjectInstance 2\nObjectInstance 1"},
    {"ReadArchive", [] { RiReadArchive("sphere.rib", nullptr, RI_NULL); }, "ReadArchive \"sphere.rib\""},
    {"Comment", [] { RiArchiveRecord(RI_COMMENT, "made by %s %d\nand more", "hand", 2); },
     "#made by hand 2\n#and more"},
    {"Structure", [] { RiArchiveRecord(RI_STRUCTURE, "Frames %d", 5); }, "##Frames 5"},
    {"Verbatim", [] { RiArchiveRecord(RI_VERBATIM, "Sphere 1 -1 1 %g", 180.0); }, "Sphere 1 -1 1 180"},
    {"ErrorHandler", [] { RiErrorHandler(RiErrorIgnore); }, "ErrorHandler \"ignore\""},
    {"MakeTexture",
     [] { RiMakeTexture("globe.pic", "globe.tx", RI_PERIODIC, RI_CLAMP, RiBoxFilter, 2, 3, RI_NULL); },
     "MakeTexture \"globe.pic\" \"globe.tx\" \"periodic\" \"clamp\" \"box\" 2 3"},
    {"MakeTextureColorspace",
     [] {
         RtString srgb = "srgb";
         RiMakeTexture("globe.pic", "globe.tx", RI_CLAMP, RI_CLAMP, RiBoxFilter, 1, 1, "colorspace", &srgb,
                       RI_NULL);
     },
     "MakeTexture \"globe.pic\" \"globe.tx\" \"clamp\" \"clamp\" \"box\" 1 1 \"colorspace\" [\"srgb\"]"},
    {"MakeBump", [] { RiMakeBump("a", "b", RI_BLACK, RI_BLACK, RiSincFilter, 2, 2, RI_NULL); },
     "MakeBump \"a\" \"b\" \"black\" \"black\" \"sinc\" 2 2"},
    {"MakeLatLongEnvironment", [] { RiMakeLatLongEnvironment("a", "b", RiTriangleFilter, 1, 1, RI_NULL); },
     "MakeLatLongEnvironment \"a\" \"b\" \"triangle\" 1 1"},
    {"MakeCubeFaceEnvironment",
     [] { RiMakeCubeFaceEnvironment("a", "b", "c", "d", "e", "f", "g", 95, RiBoxFilter, 1, 1, RI_NULL); },
     "MakeCubeFaceEnvironment \"a\" \"b\" \"c\" \"d\" \"e\" \"f\" \"g\" 95 \"box\" 1 1"},
    {"MakeShadow", [] { RiMakeShadow("a.z", "a.sm", RI_NULL); }, "MakeShadow \"a.z\" \"a.sm\""},
};

std::string example_name(const ::testing::TestParamInfo<Example>& info) {
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Options, RiExamples, ::testing::ValuesIn(kOptions), example_name);
INSTANTIATE_TEST_SUITE_P(Attributes, RiExamples, ::testing::ValuesIn(kAttributes), example_name);
INSTANTIATE_TEST_SUITE_P(Transforms, RiExamples, ::testing::ValuesIn(kTransforms), example_name);
INSTANTIATE_TEST_SUITE_P(Structure, RiExamples, ::testing::ValuesIn(kStructure), example_name);

TEST_F(Ri, ColorSamplesSayHowLongColoursAre) {
    const std::string rib = rib_of([] {
        RtFloat to_rgb[6] = {1, 0, 0, 0, 1, 1}, from_rgb[6] = {1, 0, 0, 0.5f, 0, 0.5f};
        RtFloat cyan[3] = {0, 1, 9};
        RiFrameBegin(1);
        RiColorSamples(2, to_rgb, from_rgb);
        RiColor(cyan);
        RiSurface("plastic", RI_SPECULARCOLOR, cyan, RI_NULL);
        RiFrameEnd();
        RiColor(cyan);
    });
    EXPECT_EQ(rib,
              "FrameBegin 1\n"
              "  ColorSamples [1 0 0 0 1 1] [1 0 0 0.5 0 0.5]\n"
              "  Color [0 1]\n"
              "  Surface \"plastic\" \"specularcolor\" [0 1]\n"
              "FrameEnd\n"
              "Color [0 1 9]\n");
}

TEST_F(Ri, ShadersTakeOneItemOfEveryType) {
    const std::string rib = rib_of([] {
        RtFloat numbers[32];
        for (int i = 0; i < 32; ++i) numbers[i] = static_cast<RtFloat>(i);
        RtInt ints[2] = {5, 6};
        RtString words[2] = {"a", "b"};
        RiDeclare("pair", "uniform float[2]");
        RiSurface("s", "pair", numbers, "varying point p", numbers, "hpoint h", numbers, "matrix m", numbers,
                  "vertex normal[2] n", numbers, "int[2] i", ints, "string[2] w", words, RI_NULL);
    });
    EXPECT_EQ(rib,
              "Declare \"pair\" \"uniform float[2]\"\n"
              "Surface \"s\" \"pair\" [0 1] \"varying point p\" [0 1 2] \"hpoint h\" [0 1 2 3] \"matrix m\" "
              "[0 1 2 3 4 "
              "5 6 7 8 9 10 11 12 13 14 15] \"vertex normal[2] n\" [0 1 2 3 4 5] \"int[2] i\" [5 6] "
              "\"string[2] "
              "w\" [\"a\" \"b\"]\n");
}

}  // namespace
}  // namespace trapeze::ri
