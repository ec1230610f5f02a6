/// Requests that RISpec 3.2 does not have, and its rarer ones.
#include "core/scene/camera.h"
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Resources, SaveAndRestoreAttributes) {
    const ReadOutcome outcome = read_world(
        "AttributeBegin Color 1 0 0 Translate 5 0 0 "
        "Resource \"red\" \"attributes\" \"string operation\" \"save\" AttributeEnd "
        "Resource \"red\" \"attributes\" \"string operation\" \"restore\" \"string subset\" \"shading\" " +
        kSphere +
        "Color 0 1 0 "
        "Resource \"red\" \"attributes\" \"string operation\" [\"restore\"] \"string subset\" "
        "\"transform\" " +
        kSphere + "Identity Resource \"red\" \"attributes\" \"operation\" \"restore\" " + kSphere);
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 3u);
    EXPECT_EQ(outcome.attributes(0).color, V3f(1, 0, 0));
    EXPECT_EQ(outcome.primitive(0).camera_from_object[0][3][0], 0);
    EXPECT_EQ(outcome.attributes(1).color, V3f(0, 1, 0));
    EXPECT_EQ(outcome.primitive(1).camera_from_object[0][3][0], 5);
    EXPECT_EQ(outcome.attributes(2).color, V3f(1, 0, 0));
    EXPECT_EQ(outcome.primitive(2).camera_from_object[0][3][0], 5);
}

TEST(Resources, EndWithTheirBlocks) {
    const std::string save = "Resource \"a\" \"attributes\" \"string operation\" \"save\" ";
    const std::string restore = "Resource \"a\" \"attributes\" \"string operation\" \"restore\" ";
    const ReadOutcome outcome =
        read_world("ResourceBegin Color 1 0 0 " + save + "ResourceEnd\n" + restore +
                   "\nResourceEnd\nResource \"b\" \"surface\" Resource \"a\" \"attributes\"\n" + kSphere);
    EXPECT_THAT(outcome.messages,
                ElementsAre("a.rib:3:1: error: Resource: no resource \"a\"; request skipped",
                            HasSubstr("ResourceEnd: no ResourceBegin is open"),
                            HasSubstr("Resource: \"surface\" is not supported; skipped"),
                            HasSubstr("\"operation\" is neither save nor restore")));
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ScopedSpaces, EndWithTheBlock) {
    const ReadOutcome outcome = read_world(
        "AttributeBegin Translate 1 0 0 ScopedCoordinateSystem \"here\" "
        "AttributeBegin Translate 1 0 0 ScopedCoordinateSystem \"here\" "
        "Identity CoordSysTransform \"here\" " +
        kSphere + "AttributeEnd Identity CoordSysTransform \"here\" " + kSphere + "AttributeEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.primitive(0).camera_from_object[0][3][0], 2);
    EXPECT_EQ(outcome.primitive(1).camera_from_object[0][3][0], 1);
}

TEST(Cameras, AreNamedSpaces) {
    const ReadOutcome outcome = read_text(
        "TransformBegin Translate 7 0 0 Camera \"side\" \"float shutteropening\" [0] TransformEnd "
        "WorldBegin CoordSysTransform \"side\" " +
        kSphere + "WorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.primitive().camera_from_object[0][3][0], 7);
}

TEST(LaterRequests, AreTakenQuietlyWhereTheyChangeNothing) {
    EXPECT_THAT(
        read_text("VolumePixelSamples 2 2 ArchiveRecord \"comment\" \"x\" WorldBegin WorldEnd").messages,
        IsEmpty());
}

TEST(LaterRequests, CommandsAreNotRun) {
    const Folder folder;
    const std::string made = folder.path() + "/made";
    const ReadOutcome outcome =
        read_files(folder, {folder.write("a.rib", "System \"touch " + made + "\" System \"touch " + made +
                                                      "\" WorldBegin WorldEnd")});
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("System: commands in files are never run")));
    EXPECT_FALSE(std::filesystem::exists(made));
    EXPECT_EQ(outcome.summary.unsupported.at("System"), 2u);
}

TEST(HierarchicalMeshes, AreMeshesWithoutTheirEdits) {
    const ReadOutcome outcome = read_world(
        "HierarchicalSubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] [\"crease\" \"vertexedit\"] "
        "[2 1 0 2 1 2] [0 1 0 0] [3.5 1] [\"add\" \"P\"] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("edits of finer levels are not supported")));
    const auto& tags = std::get<SubdivisionMesh>(outcome.primitive().shape().topology).tags;
    ASSERT_EQ(tags.size(), 1u);
    EXPECT_THAT(tags[0].floats, ElementsAre(3.5f));
    EXPECT_EQ(outcome.summary.primitives.at("HierarchicalSubdivisionMesh"), 1u);
}

TEST(ClippingPlanes, AreKeptInCameraSpace) {
    // The plane x = 3 of a space moved by (1, 2, 3) and turned so that its x is the camera's y.
    const ReadOutcome outcome = read_text(
        "Translate 1 2 3 Rotate 90 0 0 1 ClippingPlane 3 0 0 2 0 0 Identity "
        "ClippingPlane [0 0 5 0 0 -1] WorldBegin WorldEnd WorldBegin WorldEnd");
    ASSERT_EQ(outcome.worlds.size(), 2u);
    for (const Scene& scene : outcome.worlds) {
        ASSERT_EQ(scene.clipping_planes.size(), 2u);
        // What has y > 5 goes: -y < -5.
        EXPECT_NEAR(scene.clipping_planes[0].normal.y, -1, 1e-6);
        EXPECT_NEAR(scene.clipping_planes[0].normal.x, 0, 1e-6);
        EXPECT_NEAR(scene.clipping_planes[0].distance, -5, 1e-5);
        // What has z < 5 goes.
        EXPECT_EQ(scene.clipping_planes[1].normal, V3f(0, 0, 1));
        EXPECT_EQ(scene.clipping_planes[1].distance, 5);
    }
    EXPECT_TRUE(outcome.scene().clipping_planes[0].keys.empty());
    EXPECT_THAT(
        read_text("ClippingPlane 0 0 0 0 0 0 WorldBegin ClippingPlane 0 0 0 0 0 1 WorldEnd").messages,
        ElementsAre(HasSubstr("the normal is 0"), HasSubstr("an option, which belongs before WorldBegin")));
}

/// The world's plane x = 0 before a camera that goes 1 to the left, also where the shutter is said later.
TEST(ClippingPlanes, MoveAsTheirSpaceDoes) {
    const ReadOutcome outcome = read_text(
        "MotionBegin [0 1] Translate 0 0 0 Translate 1 0 0 MotionEnd ClippingPlane 0 0 0 1 0 0 "
        "Shutter 0 .5 WorldBegin WorldEnd");
    const ClippingPlane& plane = outcome.scene().clipping_planes.at(0);
    EXPECT_EQ(plane.distance, 0);
    ASSERT_EQ(plane.keys.size(), 65u);
    EXPECT_EQ(plane.keys.front().distance, 0);
    EXPECT_EQ(plane.keys[32].distance, -0.25f);
    EXPECT_EQ(plane.keys.back().distance, -0.5f);
    EXPECT_EQ(plane.keys.back().normal, V3f(-1, 0, 0));
}

TEST(ColorSamples, ColoursHaveSoManyValuesEach) {
    const ReadOutcome outcome = read_text(
        "ColorSamples [1 0 0  0.5 0.5 0  0 1 0  0 0 1] [1 0 0 0 0 0 0 0 0 0 0 0] WorldBegin "
        "Color 1 1 0.25 0.5 Opacity [0 0 0 1] Surface \"plastic\" \"specularcolor\" [0 0 1 0] "
        "Polygon \"P\" [0 0 1 1 0 1 0 1 1] \"Cs\" [1 0 0 0  0 1 0 0  0 0 0 2] WorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.attributes().color, V3f(1.5f, 0.75f, 0.5f));
    EXPECT_EQ(outcome.attributes().opacity, V3f(0, 0, 1));
    EXPECT_THAT(outcome.attributes().surface->parameters.find("specularcolor")->floats, ElementsAre(0, 1, 0));
    EXPECT_THAT(outcome.primitive().shape().variables.find("Cs")->floats,
                ElementsAre(1, 0, 0, 0.5f, 0.5f, 0, 0, 0, 2));
}

TEST(ColorSamples, OneIsEnoughAndWrongOnesAreSaid) {
    EXPECT_EQ(read_text("ColorSamples [0.5 1 2] [1 1 1] WorldBegin Color 0.5 " + kSphere + "WorldEnd")
                  .attributes()
                  .color,
              V3f(0.25f, 0.5f, 1));
    for (const char* text :
         {"ColorSamples [] []", "ColorSamples [1 1 1 1] [1 1 1 1]", "ColorSamples [1 1 1] [1]"})
        EXPECT_THAT(read_text(text).messages, ElementsAre(HasSubstr("needs two matrices"))) << text;
}

TEST(Colors, OneNumberIsGreyAndAFourthIsLeftOut) {
    const ReadOutcome outcome =
        read_world("Color .5 Opacity [0.25] " + kSphere + "\nColor [1 0 0 1] Opacity 1 1 1 " + kSphere);
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("2:1: warning: Color: one number for the colour"),
                                              HasSubstr("3:1: warning: Color: a number too many")));
    EXPECT_EQ(outcome.attributes(0).color, V3f(0.5f));
    EXPECT_EQ(outcome.attributes(0).opacity, V3f(0.25f));
    EXPECT_EQ(outcome.attributes(1).color, V3f(1, 0, 0));
    EXPECT_EQ(outcome.attributes(1).opacity, V3f(1));
}

TEST(ErrorMessages, ThoseThatDifferInNumbersAreShownOnce) {
    const ReadOutcome outcome = read_world("Sphere 1\nSphere 1 2\nDisk 1\nColor [1 2]");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("2:1: error: Sphere: has 1 numbers, needs 4"),
                                              HasSubstr("error: Disk: has 1 numbers, needs 3"),
                                              HasSubstr("error: Color: the colour has 2")));
}

TEST(ErrorHandlers, DecideWhatErrorsAre) {
    const std::string wrong = "Sphere 1\n";
    const ReadOutcome ignored =
        read_world("ErrorHandler \"ignore\" " + wrong + kSphere + "ErrorHandler \"print\"\n" + wrong);
    EXPECT_THAT(ignored.messages, ElementsAre(HasSubstr("a.rib:2:23: warning: Sphere: has 1"),
                                              HasSubstr("a.rib:4:1: error: Sphere: has 1")));
    EXPECT_EQ(ignored.count(), 1u);

    const ReadOutcome aborted =
        read_text(wrong + "ErrorHandler \"abort\" WorldBegin " + kSphere + "WorldEnd " + wrong +
                  "WorldBegin " + kSphere + "WorldEnd IfBegin \"1\"");
    EXPECT_EQ(aborted.worlds.size(), 1u);
    ASSERT_EQ(aborted.messages.size(), 2u);
    EXPECT_THAT(aborted.messages[1], HasSubstr("reading ends at the first error"));
    EXPECT_THAT(read_text("ErrorHandler \"shout\" WorldBegin WorldEnd").messages,
                ElementsAre(HasSubstr("\"shout\" is not known")));
}

TEST(Ris, OptionsAndAttributesMayBeValues) {
    const ReadOutcome outcome = read_text(
        "Option \"Ri\" \"int[2] FormatResolution\" [320 200] \"float FormatPixelAspectRatio\" [1.5] "
        "\"int Frame\" [7] \"string PixelFilterName\" [\"box\"] \"float[2] PixelFilterWidth\" [3 4] "
        "\"float[2] Clipping\" [0.5 50] \"float[2] Shutter\" [0 0.5] \"float[4] ScreenWindow\" [-2 2 -1 1]\n"
        "Projection \"PxrCamera\" \"float fov\" [40] \"float fStop\" [3.5] \"float focalLength\" [0.8] "
        "\"float focalDistance\" [5] Display \"a.exr\" \"openexr\" \"Ci, a,z\"\n"
        "WorldBegin Attribute \"Ri\" \"int Sides\" [1] \"string Orientation\" [\"rh\"] \"int Matte\" [2] "
        "\"int Nonsense\" [3] " +
        kSphere + "WorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    const Options& o = outcome.scene().options;
    EXPECT_EQ(o.width, 320);
    EXPECT_EQ(o.height, 200);
    EXPECT_EQ(o.pixel_aspect, 1.5f);
    EXPECT_EQ(o.far_clip, 50);
    EXPECT_EQ(o.shutter_close, 0.5f);
    EXPECT_EQ((*o.screen_window)[0], -2);
    EXPECT_EQ(o.projection, "perspective");
    EXPECT_EQ(o.fov, 40);
    EXPECT_EQ(o.f_stop, 3.5f);
    EXPECT_EQ(o.focal_distance, 5);
    EXPECT_EQ(o.frame, 7);
    EXPECT_EQ(o.filter.name, "box");
    EXPECT_EQ(o.filter.width_y, 4);
    EXPECT_EQ(o.displays.at(0).mode, "rgbaz");
    EXPECT_EQ(outcome.attributes().sides, 1);
    EXPECT_EQ(outcome.attributes().matte, 2);
    EXPECT_EQ(outcome.summary.without_effect.size(), 1u);
}

TEST(Ris, HidersSayHowManySamplesWherePixelSamplesDoesNot) {
    const struct {
        const char* options;
        float side;
    } rows[] = {
        {"", 2},
        {"Hider \"hidden\"", 2},
        {"Hider \"raytrace\" \"int minsamples\" [4] \"int maxsamples\" [64]", 4},
        {"Hider \"raytrace\" \"int maxsamples\" [50] DepthOfField 2 .1 5", 8},
        {"Hider \"raytrace\" \"int minsamples\" [9]", 3},
        {"Hider \"raytrace\" \"int maxsamples\" [100000]", 4},
        {"Hider \"raytrace\" \"int maxsamples\" [100000] Shutter 0 1", 8},
        {"Hider \"raytrace\" \"int maxsamples\" [-1]", 2},
        {"PixelSamples 3 3 Hider \"raytrace\" \"int maxsamples\" [64]", 3},
        {"Hider \"raytrace\" \"int maxsamples\" [64] PixelSamples 3 3", 3},
        {"FrameBegin 1 PixelSamples 3 3 FrameEnd Hider \"raytrace\" \"int maxsamples\" [16]", 4},
    };
    for (const auto& row : rows) {
        const ReadOutcome outcome =
            read_text(std::string(row.options) + " WorldBegin " + kSphere + " WorldEnd");
        EXPECT_EQ(outcome.scene().options.samples_x, row.side) << row.options;
        EXPECT_EQ(outcome.scene().options.samples_y, row.side) << row.options;
        EXPECT_THAT(outcome.summary.without_effect, IsEmpty()) << row.options;
    }
}

TEST(Settings, AperturesHaveFourNumbers) {
    const auto aperture = [](const std::string& value) {
        return read_text("DepthOfField 2 1 5\nHider \"hidden\" " + value + "\nWorldBegin WorldEnd");
    };
    const std::string declared = "\"float[4] aperture\" ";
    for (const std::string& value :
         {declared + "[6 15 .5 -.25]", std::string("\"aperture\" [6 15 .5 -.25]")}) {
        const ReadOutcome right = aperture(value);
        EXPECT_THAT(right.messages, IsEmpty());
        EXPECT_THAT(right.summary.without_effect, IsEmpty());
        const Aperture lens = make_camera(right.scene().options).aperture;
        EXPECT_EQ(lens.blades, 6);
        EXPECT_EQ(lens.angle, 15);
        EXPECT_EQ(lens.roundness, .5f);
        EXPECT_EQ(lens.density, -.25f);
    }
    const ReadOutcome beyond = aperture(declared + "[5 0 -3 2]");
    EXPECT_THAT(beyond.messages, ElementsAre(HasSubstr("a.rib:2:1: warning: Hider: roundness and density")));
    EXPECT_EQ(make_camera(beyond.scene().options).aperture.roundness, -1);
    EXPECT_EQ(make_camera(beyond.scene().options).aperture.density, 1);
    for (const char* blades : {"[2 0 0 0]", "[6.5 0 0 0]", "[-3 0 0 0]"})
        EXPECT_THAT(aperture(declared + blades).messages, ElementsAre(HasSubstr("3 blades or more")))
            << blades;
    for (const char* blades : {"[0 0 0 0]", "[3 0 0 0]"})
        EXPECT_THAT(aperture(declared + blades).messages, IsEmpty()) << blades;
    for (const char* value : {"\"float[3] aperture\" [6 0 0]", "\"aperture\" [6 0 0 0 0]",
                              "\"float[4] aperture\" [6 1e39 0 0]", "\"string aperture\" [\"six\"]"}) {
        const ReadOutcome wrong = aperture(value);
        EXPECT_THAT(wrong.messages, ElementsAre(HasSubstr("a.rib:2:"))) << value;
        EXPECT_EQ(make_camera(wrong.scene().options).aperture.blades, 0) << value;
    }
    for (const char* blades : {"-3", "2", "2.9", "1e30"})
        EXPECT_TRUE(
            make_camera(aperture(declared + "[" + blades + " 0 0 0]").scene().options).aperture.is_disk())
            << blades;
}

TEST(Settings, SamplemotionStopsTheShutterOfItsWorldsAlone) {
    const std::string moving = "WorldBegin MotionBegin [0 1] Translate 0 0 5 Translate 1 0 5 MotionEnd " +
                               std::string(kSphere) + " WorldEnd ";
    const ReadOutcome outcome =
        read_text("Shutter 0 1 FrameBegin 1 Hider \"hidden\" \"samplemotion\" [0] " + moving +
                  "FrameEnd FrameBegin 2 Hider \"hidden\" \"samplemotion\" [1] " + moving + "FrameEnd");
    ASSERT_EQ(outcome.worlds.size(), 2u);
    EXPECT_EQ(outcome.worlds[0].primitives[0].key_count(), 1);
    EXPECT_EQ(outcome.worlds[1].primitives[0].key_count(), 2);
    EXPECT_EQ(outcome.worlds[1].options.shutter_close, 1);
    EXPECT_THAT(outcome.summary.without_effect, IsEmpty());
}

TEST(Settings, ThatAskForWhatIsSoInAnyCaseAreNotCalledIgnored) {
    const ReadOutcome outcome = read_world(
        "Attribute \"dice\" \"hair\" [1] Attribute \"cull\" \"backfacing\" [0] \"hidden\" [0] "
        "Attribute \"stitch\" \"enable\" [1] Attribute \"stitch\" \"enable\" [0] "
        "Attribute \"stitch\" \"other\" [1]");
    EXPECT_THAT(outcome.summary.without_effect,
                ElementsAre(::testing::Pair("Attribute \"stitch\" \"other\"", 1u)));
    const auto& not_needed = outcome.summary.not_needed;
    EXPECT_EQ(not_needed.size(), 3u);
    EXPECT_TRUE(read_world("Sphere 1 -1 1 360").attributes().cull_hidden);
    EXPECT_FALSE(read_world("Attribute \"cull\" \"hidden\" [0] Sphere 1 -1 1 360").attributes().cull_hidden);
    EXPECT_EQ(not_needed.at("Attribute \"stitch\" \"enable\": grids join without cracks in any case"), 2u);
    EXPECT_EQ(not_needed.count(
                  "Attribute \"dice\" \"hair\": curves thinner than a micropolygon are one wide in any case"),
              1u);
}

TEST(Ris, CamerasHaveTheirWindowAndPlanes) {
    const ReadOutcome r = read_text(
        "Camera \"main\" \"float[4] Ri:ScreenWindow\" [-1.5 1.5 -1 1] \"float nearClip\" [.5] "
        "\"float farClip\" [50] WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, ElementsAre());
    EXPECT_EQ(r.scene().options.screen_window, (std::array<float, 4>{-1.5f, 1.5f, -1, 1}));
    EXPECT_EQ(r.scene().options.near_clip, 0.5f);
    EXPECT_EQ(r.scene().options.far_clip, 50);
}

TEST(Ris, WrongValuesAreSaid) {
    EXPECT_THAT(read_text("Option \"Ri\" \"float[2] Clipping\" [5 1]\n"
                          "WorldBegin Attribute \"Ri\" \"string Orientation\" [\"up\"] WorldEnd")
                    .messages,
                ElementsAre(HasSubstr("a.rib:1:1: error: Option: needs 0 <= near < far"),
                            HasSubstr("Attribute: \"up\" is none of")));
}

TEST(Ris, SurfacesHaveTheirColourAndOneNoteSaysSo) {
    const ReadOutcome outcome = read_text(
        "Integrator \"PxrPathTracer\" \"pt\" Light \"PxrDomeLight\" \"l\" \"float intensity\" [1]\n"
        "WorldBegin Pattern \"PxrTexture\" \"tex\" \"string filename\" [\"a.tex\"]\n"
        "Bxdf \"PxrSurface\" \"s\" \"reference float diffuseGain\" [\"x:y\"] "
        "\"color diffuseColor\" [0.1 0.2 0.3] \"int diffuseDoubleSided\" [1] " +
        kSphere + "Bxdf \"PxrConstant\" \"c\" \"color emitColor\" 1 0.5 0 " + kSphere +
        "Bxdf \"PxrDisney\" \"d\" \"reference color baseColor\" [\"tex:resultRGB\"] " + kSphere +
        "Bxdf \"PxrBlack\" \"b\" " + kSphere + "WorldEnd");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("Integrator: RIS shading is not supported")));
    ASSERT_EQ(outcome.count(), 4u);
    EXPECT_EQ(outcome.attributes(0).color, V3f(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(outcome.attributes(0).surface->name, "rissurface");
    EXPECT_EQ(outcome.attributes(1).color, V3f(1, 0.5f, 0));
    EXPECT_EQ(outcome.attributes(1).surface->name, "constant");
    EXPECT_EQ(outcome.attributes(2).color, V3f(1, 1, 1));
    EXPECT_EQ(outcome.attributes(3).color, V3f(0, 0, 0));
    EXPECT_EQ(outcome.summary.unsupported.at("Bxdf"), 4u);
}

}  // namespace
}  // namespace trapeze::testing
