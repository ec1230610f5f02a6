/// Blocks, options, attributes, lights, objects.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ReadState, AttributesAreRestoredWithTheirBlocks) {
    const ReadOutcome r = read_world(
        "Color 1 0 0 AttributeBegin Color [0 1 0] Opacity .5 .5 .5 Sides 1 Matte 1 ShadingRate 4 "
        "ShadingInterpolation \"smooth\" Translate 1 2 3 Surface \"matte\" " +
        kSphere + "AttributeEnd " + kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 2u);
    EXPECT_EQ(r.attributes(0).color, V3f(0, 1, 0));
    EXPECT_EQ(r.attributes(0).opacity, V3f(0.5f));
    EXPECT_EQ(r.attributes(0).sides, 1);
    EXPECT_EQ(r.attributes(0).matte, 1);
    EXPECT_EQ(r.attributes(0).shading_rate, 4);
    EXPECT_TRUE(r.attributes(0).smooth_shading);
    EXPECT_EQ(r.attributes(0).surface->name, "matte");
    EXPECT_EQ(r.primitive(0).camera_from_object[0].translation(), V3f(1, 2, 3));
    EXPECT_EQ(r.attributes(1).color, V3f(1, 0, 0));
    EXPECT_EQ(r.attributes(1).sides, 2);
    EXPECT_EQ(r.attributes(1).surface, nullptr);
    EXPECT_EQ(r.primitive(1).camera_from_object[0], M44f());
}

TEST(ReadState, TransformBlocksRestoreTheTransformationAlone) {
    const ReadOutcome r = read_world("TransformBegin Translate 1 0 0 Color 1 0 0 TransformEnd " + kSphere);
    EXPECT_EQ(r.primitive().camera_from_object[0], M44f());
    EXPECT_EQ(r.attributes().color, V3f(1, 0, 0));
}

TEST(ReadState, PrimitivesThatLookAlikeShareTheirAttributes) {
    const ReadOutcome r =
        read_world(kSphere + kSphere + "Color 1 0 0 " + kSphere + "Scale -1 1 1 " + kSphere);
    ASSERT_EQ(r.count(), 4u);
    EXPECT_EQ(r.primitive(0).attributes, r.primitive(1).attributes);
    EXPECT_NE(r.primitive(1).attributes, r.primitive(2).attributes);
    EXPECT_NE(r.attributes(2).reverse_orientation, r.attributes(3).reverse_orientation);
}

TEST(ReadState, OptionsInAWorldAreTakenForIt) {
    const ReadOutcome r = read_text(
        "WorldBegin Translate 1 0 0\nFormat 10 20 1\nProjection \"perspective\" \"fov\" 30\n"
        "Imager \"background\" \"color\" [1 0 0]\n" +
        kSphere + "WorldEnd WorldBegin WorldEnd");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:1: warning: Format: an option, which belongs before"));
    ASSERT_EQ(r.worlds.size(), 2u);
    const Options& o = r.worlds[0].options;
    EXPECT_EQ(o.width, 10);
    EXPECT_EQ(o.fov, 30);
    ASSERT_TRUE(o.imager);
    EXPECT_EQ(o.imager->parameters.values.at(0).name, "bgcolor");
    EXPECT_EQ(r.worlds[0].primitives.at(0).camera_from_object[0][3][0], 1);  // Projection moves nothing
    EXPECT_EQ(r.worlds[1].options.width, 640);
    EXPECT_FALSE(r.worlds[1].options.imager);
}

TEST(ReadState, OptionsOfArchivesAndTheShutterAreFrozenInWorlds) {
    const ReadOutcome r = read_text(
        "ArchiveBegin \"other\" Format 10 20 1 Display \"b.exr\" \"exr\" \"rgb\" ArchiveEnd\n"
        "WorldBegin ReadArchive \"other\" Shutter 0 1 WorldEnd");
    ASSERT_EQ(r.messages.size(), 3u);
    for (const std::string& message : r.messages)
        EXPECT_THAT(message, HasSubstr("options cannot change inside a world; request skipped"));
    EXPECT_EQ(r.scene().options.width, 640);
    EXPECT_TRUE(r.scene().options.displays.empty());
}

TEST(ReadState, AFrameAspectRatioBelowZeroIsThePictures) {
    const ReadOutcome r = read_text(
        "FrameAspectRatio 2 Option \"Ri\" \"float FrameAspectRatio\" [-1] \"int[2] FormatResolution\" [30 "
        "20] "
        "WorldBegin WorldEnd");
    EXPECT_TRUE(r.messages.empty());
    EXPECT_FALSE(r.scene().options.frame_aspect);
    EXPECT_EQ(r.scene().options.width, 30);
}

TEST(ReadState, CameraOptions) {
    const ReadOutcome r = read_text(
        "Format 320 200 1.5 FrameAspectRatio 2 ScreenWindow -1 1 -.5 .5 CropWindow .25 .75 0 1\n"
        "Clipping 1 100 DepthOfField 2.8 .1 5 Shutter 0 .5 PixelSamples 3 2 PixelFilter \"sinc\" 4 5\n"
        "Exposure 2 2.2 Quantize \"rgba\" 255 0 255 .5 Display \"a.exr\" \"openexr\" \"rgba\"\n"
        "Display \"+z.exr\" \"openexr\" \"z\" Hider \"raytrace\" \"jitter\" [0] Projection \"perspective\" "
        "\"fov\" [40]\n"
        "Translate 0 0 5 WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    const Options& o = r.scene().options;
    EXPECT_EQ(o.width, 320);
    EXPECT_EQ(o.height, 200);
    EXPECT_EQ(o.pixel_aspect, 1.5f);
    EXPECT_EQ(o.frame_aspect, 2.0f);
    EXPECT_EQ(o.screen_window, (std::array<float, 4>{-1, 1, -0.5f, 0.5f}));
    EXPECT_EQ(o.crop_window, (std::array<float, 4>{0.25f, 0.75f, 0, 1}));
    EXPECT_EQ(o.near_clip, 1);
    EXPECT_EQ(o.far_clip, 100);
    EXPECT_EQ(o.f_stop, 2.8f);
    EXPECT_EQ(o.focal_distance, 5);
    EXPECT_EQ(o.shutter_close, 0.5f);
    EXPECT_EQ(o.samples_x, 3);
    EXPECT_EQ(o.samples_y, 2);
    EXPECT_EQ(o.filter.name, "sinc");
    EXPECT_EQ(o.filter.width_y, 5);
    EXPECT_EQ(o.exposure_gamma, 2.2f);
    EXPECT_EQ(o.projection, "perspective");
    EXPECT_EQ(o.fov, 40);
    ASSERT_EQ(o.displays.size(), 2u);
    EXPECT_EQ(o.displays[1].name, "z.exr");
    EXPECT_EQ(o.hider, "raytrace");
    EXPECT_EQ(r.scene().camera_from_world.translation(), V3f(0, 0, 5));
}

/// Parameters of shaders cannot be called so.
TEST(ReadState, CameraOptionsOfOthers) {
    const auto options = [](const std::string& text) {
        return read_text(text + " WorldBegin WorldEnd\n").scene().options;
    };
    EXPECT_EQ(options("DepthOfField 2 1 5").f_stop, 2);
    for (const char* none : {"DepthOfField 2 1 5 DepthOfField -", "DepthOfField 2 1 5 DepthOfField \"-\"",
                             "DepthOfField 2 1 5 DepthOfField -\n"})
        EXPECT_EQ(options(none).f_stop, kInfinity) << none;
    // What sees all around is seen straight ahead.
    const ReadOutcome wide = read_text("Projection \"fisheye\" \"fov\" 180 WorldBegin WorldEnd\n");
    EXPECT_THAT(wide.messages, ElementsAre(HasSubstr("\"fisheye\" is not supported; perspective is used")));
    EXPECT_EQ(wide.scene().options.projection, "perspective");
    EXPECT_EQ(wide.scene().options.fov, 120);
    EXPECT_EQ(options("Projection \"cylindrical\" \"fov\" 60").fov, 60);
    EXPECT_EQ(options("Projection \"\"").projection, "orthographic");
    EXPECT_TRUE(read_text("Quantize \"Cs\" 100 0 255 0 WorldBegin WorldEnd\n").messages.empty());
    EXPECT_EQ(
        read_world("Attribute \"dice\" \"float micropolygonlength\" .5 " + kSphere).attributes().shading_rate,
        .25f);
}

TEST(ReadState, TheBackgroundsColorAndAlphaHaveOtherNamesInItsShader) {
    const ReadOutcome r = read_text(
        "Imager \"background\" \"color color\" [.1 .2 .3] \"float alpha\" [0] WorldBegin WorldEnd\n"
        "Imager \"background\" \"color\" [.5 .5 .6] WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.worlds.size(), 2u);
    const ParameterList& first = r.worlds[0].options.imager->parameters;
    ASSERT_TRUE(first.find("bgcolor") && first.find("bgalpha"));
    EXPECT_EQ(first.find("bgcolor")->floats, (std::vector<float>{.1f, .2f, .3f}));
    EXPECT_EQ(first.find("bgalpha")->floats, (std::vector<float>{0}));
    const ParameterList& second = r.worlds[1].options.imager->parameters;
    ASSERT_TRUE(second.find("bgcolor"));
    EXPECT_EQ(second.find("bgcolor")->floats, (std::vector<float>{.5f, .5f, .6f}));
}

TEST(ReadState, OptionsAreRestoredWithTheirFrames) {
    const ReadOutcome r = read_text(
        "FrameBegin 3 Format 8 8 1 Translate 0 0 1 WorldBegin WorldEnd FrameEnd\n"
        "FrameBegin 4 WorldBegin WorldEnd FrameEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.worlds.size(), 2u);
    EXPECT_EQ(r.worlds[0].options.frame, 3);
    EXPECT_EQ(r.worlds[0].options.width, 8);
    EXPECT_EQ(r.worlds[1].options.frame, 4);
    EXPECT_EQ(r.worlds[1].options.width, 640);
    EXPECT_EQ(r.worlds[1].camera_from_world, M44f());
    EXPECT_EQ(r.summary.frames, 2);
}

TEST(ReadState, OnlyWantedFramesAreDelivered) {
    ReadOptions options;
    options.wants_frame = [](int frame) { return frame == 2; };
    const ReadOutcome r =
        read_text("FrameBegin 1 WorldBegin " + kSphere + "WorldEnd FrameEnd FrameBegin 2 WorldBegin " +
                      kSphere + "WorldEnd FrameEnd",
                  options);
    ASSERT_EQ(r.worlds.size(), 1u);
    EXPECT_EQ(r.worlds[0].options.frame, 2);
    EXPECT_EQ(r.summary.worlds, 2);
    EXPECT_EQ(r.summary.primitives.at("Sphere"), 2u);
}

TEST(ReadState, WorldsAreApart) {
    const ReadOutcome r = read_text("Translate 0 0 1 WorldBegin Color 1 0 0 Translate 1 0 0 " + kSphere +
                                    "WorldEnd WorldBegin " + kSphere + kSphere + "WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.worlds.size(), 2u);
    EXPECT_EQ(r.worlds[0].primitives.size(), 1u);
    EXPECT_EQ(r.worlds[1].primitives.size(), 2u);
    EXPECT_EQ(r.worlds[1].primitives[0].attributes->color, V3f(1, 1, 1));
    EXPECT_EQ(r.worlds[1].primitives[0].camera_from_object[0].translation(), V3f(0, 0, 1));
}

TEST(ReadState, SeveralFilesAreOneStream) {
    const Folder folder;
    const ReadOutcome r = read_files(folder, {folder.write("a.rib", "WorldBegin Color 1 0 0"),
                                              folder.write("b.rib", kSphere + "Sphere 1\nWorldEnd")});
    EXPECT_THAT(r.messages,
                ElementsAre("b.rib:1:19: error: Sphere: has 1 numbers, needs 4; primitive skipped"));
    EXPECT_EQ(r.attributes().color, V3f(1, 0, 0));
}

/// RISpec 4.1.1: of a mirror or a shift the picture is another; of what turns it, it is said that it is
/// ignored.
TEST(ReadState, TransformationsBeforeProjectionAreTheScreens) {
    const ReadOutcome r =
        read_text("Translate .5 -2 7 Scale -1 3 2 Projection \"orthographic\" Translate 0 0 9 WorldBegin " +
                  kSphere + "WorldEnd Translate 3 3 3 Projection \"orthographic\" WorldBegin WorldEnd");
    EXPECT_EQ(r.scene().options.screen_scale, (std::array<float, 2>{-1, 3}));
    EXPECT_EQ(r.scene().options.screen_offset, (std::array<float, 2>{.5f, -2}));
    EXPECT_EQ(r.primitive().camera_from_object[0].translation(), V3f(0, 0, 9));
    EXPECT_THAT(r.messages, ::testing::IsEmpty());
    // What is left of a world before is none of the screen's.
    EXPECT_EQ(r.worlds[1].options.screen_scale, r.scene().options.screen_scale);
    EXPECT_EQ(r.worlds[1].options.screen_offset, r.scene().options.screen_offset);
    const ReadOutcome turned =
        read_text("Rotate 30 0 0 1 Projection \"orthographic\" WorldBegin " + kSphere + "WorldEnd");
    EXPECT_EQ(turned.scene().options.screen_scale, (std::array<float, 2>{1, 1}));
    EXPECT_EQ(turned.primitive().camera_from_object[0], M44f());
    EXPECT_THAT(turned.messages, ElementsAre(::testing::HasSubstr("Scale and Translate change the screen")));
}

TEST(ReadState, TransformAndIdentityAreRelativeToTheWorld) {
    const ReadOutcome r = read_text("Translate 0 0 9 WorldBegin Translate 1 0 0 Identity " + kSphere +
                                    "Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1] " + kSphere +
                                    "CoordinateSystem \"here\" Identity CoordSysTransform \"here\" " +
                                    kSphere + "CoordSysTransform \"nowhere\" " + kSphere + "WorldEnd");
    EXPECT_EQ(r.primitive(0).camera_from_object[0].translation(), V3f(0, 0, 9));
    EXPECT_EQ(r.primitive(1).camera_from_object[0].translation(), V3f(5, 0, 9));
    EXPECT_EQ(r.primitive(2).camera_from_object[0].translation(), V3f(5, 0, 9));
    EXPECT_EQ(r.count(), 4u);
    EXPECT_EQ(r.messages.size(), 1u);
    EXPECT_EQ(r.scene().camera_from_named.at("here").translation(), V3f(5, 0, 9));
    EXPECT_EQ(r.scene().camera_from_named.at("world").translation(), V3f(0, 0, 9));
}

/// Where the camera sees in parallel: 200 by 100 pixels of a window of 4 by 2.
TEST(ReadState, SpacesOfThePictureAreTransformations) {
    const auto read = [](const std::string& projection) {
        return read_text("Format 200 100 1 ScreenWindow -1 3 -1 1 Clipping 1 5 Projection " + projection +
                         " Translate 0 0 9 WorldBegin CoordSysTransform \"raster\" " + kSphere +
                         "CoordSysTransform \"NDC\" " + kSphere + "CoordSysTransform \"screen\" " + kSphere +
                         "WorldEnd");
    };
    const ReadOutcome r = read("\"orthographic\"");
    EXPECT_THAT(r.messages, ::testing::IsEmpty());
    const auto in_camera = [&](size_t i, const V3f& p) { return p * r.primitive(i).camera_from_object[0]; };
    const auto expect_near = [](const V3f& a, const V3f& b) {
        EXPECT_NEAR((a - b).length(), 0, 1e-5f) << a << b;
    };
    expect_near(in_camera(0, V3f(50, 25, 0)), V3f(0, 0.5f, 1));
    expect_near(in_camera(1, V3f(0.25f, 0.25f, 0.5f)), V3f(0, 0.5f, 3));
    expect_near(in_camera(2, V3f(2, -0.5f, 1)), V3f(2, -0.5f, 5));
    EXPECT_THAT(
        read("\"perspective\"").messages,
        ElementsAre(HasSubstr("\"raster\" of a perspective camera"), HasSubstr("\"NDC\" of a perspective"),
                    HasSubstr("\"screen\" of a perspective camera")));
}

TEST(ReadState, LightsAreSwitchedWithinBlocks) {
    const ReadOutcome r = read_world(
        "LightSource \"pointlight\" 1 \"intensity\" [2] AttributeBegin LightSource \"ambientlight\" "
        "\"fill\" " +
        kSphere + "Illuminate 1 0 " + kSphere + "AttributeEnd " + kSphere + "Illuminate \"fill\" 1 " +
        kSphere + "Illuminate 7 1 " + kSphere);
    const auto handles = [&](size_t i) {
        std::vector<std::string> names;
        for (const auto& light : r.attributes(i).lights) names.push_back(light->handle);
        return names;
    };
    EXPECT_THAT(handles(0), ElementsAre("1", "fill"));
    EXPECT_THAT(handles(1), ElementsAre("fill"));
    EXPECT_THAT(handles(2), ElementsAre("1"));
    EXPECT_THAT(handles(3), ElementsAre("1", "fill"));
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("Illuminate: no light \"7\"; request skipped")));
    EXPECT_EQ(r.summary.lights, 2u);
}

TEST(ReadState, LightsEndWithTheirWorldAndNotBefore) {
    const ReadOutcome r = read_text(
        "LightSource \"ambientlight\" 1 WorldBegin LightSource \"ambientlight\" 2 WorldEnd "
        "WorldBegin Illuminate 1 0 Illuminate 2 0 " +
        kSphere + "WorldEnd");
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("no light \"2\"")));
    EXPECT_THAT(r.worlds.at(1).primitives.at(0).attributes->lights, IsEmpty());
}

TEST(ReadState, DisplacementBoundsAreCameraSpaceLengths) {
    const std::string bound = "Attribute \"displacementbound\" \"sphere\" [.5] \"coordinatesystem\" ";
    const ReadOutcome r =
        read_text("Scale 3 3 3 WorldBegin Scale 2 2 2 CoordinateSystem \"two\" Scale 2 2 2 " + bound +
                  "[\"object\"] " + kSphere + bound + "[\"world\"] " + kSphere + bound + "[\"camera\"] " +
                  kSphere + bound + "[\"two\"] " + kSphere + bound + "[\"what\"] " + kSphere + "WorldEnd");
    const float wanted[] = {6, 1.5f, 0.5f, 3, 6};
    for (size_t i = 0; i < 5; ++i) EXPECT_FLOAT_EQ(r.attributes(i).displacement_bound, wanted[i]) << i;
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("\"what\" is not known")));
}

TEST(ReadState, OtherAttributesAreKeptAsTheyLook) {
    const ReadOutcome r = read_world(
        "Attribute \"identifier\" \"name\" [\"ball\"] Attribute \"visibility\" \"camera\" [0] "
        "Attribute \"dice\" \"rasterorient\" 0 Attribute \"user\" \"string who\" \"me\" "
        "\"unheard\" [1 2] " +
        kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(r.attributes().name, "ball");
    EXPECT_FALSE(r.attributes().visible_to_camera);
    EXPECT_EQ(r.attributes().user.float_or("dice", "rasterorient", 1), 0);
    EXPECT_EQ(r.attributes().user.string_or("user", "who", ""), "me");
    EXPECT_EQ(r.attributes().user.find("user", "unheard")->floats.size(), 2u);
}

TEST(ReadState, ShaderParameters) {
    const ReadOutcome r = read_world(
        "Declare \"tint\" \"uniform color\" Translate 1 0 0 Surface \"plastic\" \"Kd\" .5 "
        "\"tint\" 1 0 0 \"uniform float[2] pair\" [3 4] \"unknown\" [1] \"tint\" \"text\" "
        "\"tint\" [1 2] \"opacity\" [0.25] " +
        kSphere + "Surface \"x\" \"unknown\" [1]");
    const ShaderInstance& shader = *r.attributes().surface;
    EXPECT_EQ(shader.parameters.float_or("Kd", 0), 0.5f);
    EXPECT_EQ(shader.parameters.find("tint")->floats, (std::vector<float>{1, 0, 0}));
    EXPECT_EQ(shader.parameters.find("pair")->declaration.array_length, 2);
    // Of another type than the standard shaders' parameter of that name: the shader's own.
    EXPECT_EQ(shader.parameters.find("opacity")->declaration.type, ValueType::Float);
    EXPECT_EQ(shader.camera_from_shader.translation(), V3f(1, 0, 0));
    EXPECT_EQ(r.messages.size(), 2u);  // what "unknown" is, the shader says
}

TEST(ReadState, ObjectsMayHoldInstancesOfOthers) {
    const ReadOutcome r =
        read_world("ObjectBegin 1 Translate 1 0 0 Color 0 0 1 " + kSphere + "ObjectEnd " +
                   "ObjectBegin 2 ObjectInstance 1 Surface \"metal\" Translate 0 2 0 "
                   "ObjectInstance 1 ObjectInstance 2 ObjectEnd Surface \"matte\" Color 1 0 0 "
                   "Translate 0 0 5 ObjectInstance 2 ObjectInstance 1");
    EXPECT_THAT(r.messages,
                ElementsAre(::testing::HasSubstr("ObjectInstance: an object in its own definition")));
    ASSERT_EQ(r.count(), 3u);
    EXPECT_EQ(r.primitive(0).camera_from_object[0].translation(), V3f(1, 0, 5));
    EXPECT_EQ(r.primitive(1).camera_from_object[0].translation(), V3f(1, 2, 5));
    EXPECT_EQ(r.primitive(2).camera_from_object[0].translation(), V3f(1, 0, 5));
    EXPECT_EQ(r.attributes(0).surface->name, "matte");
    EXPECT_EQ(r.attributes(1).surface->name, "metal");
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(r.attributes(i).color, V3f(0, 0, 1));
}

TEST(ReadState, InstancesTakeTheirOwnAttributes) {
    const ReadOutcome r =
        read_text("WorldBegin ObjectBegin 1 Translate 1 0 0 " + kSphere + "Color 0 1 0 Surface \"metal\" " +
                  kSphere + "ObjectEnd ObjectBegin \"two\" " + kSphere +
                  "ObjectEnd Color 1 0 0 Opacity .5 .5 .5 Surface \"matte\" "
                  "Translate 0 0 5 ObjectInstance 1 ObjectInstance \"two\" ObjectInstance 3 WorldEnd");
    ASSERT_EQ(r.count(), 3u);
    EXPECT_EQ(r.primitive(0).camera_from_object[0].translation(), V3f(1, 0, 5));
    EXPECT_EQ(r.attributes(0).color, V3f(1, 0, 0));
    EXPECT_EQ(r.attributes(1).color, V3f(0, 1, 0));
    EXPECT_EQ(r.attributes(1).opacity, V3f(0.5f));
    EXPECT_EQ(r.attributes(1).surface->name, "metal");
    EXPECT_EQ(r.attributes(1).surface->camera_from_shader.translation(), V3f(1, 0, 5));
    EXPECT_EQ(r.attributes(2).surface->name, "matte");
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("no object \"3\"")));
}

TEST(ReadState, InstancesShareTheirShapes) {
    const ReadOutcome r =
        read_world("ObjectBegin 1 " + kSphere + "ObjectEnd ObjectInstance 1 ObjectInstance 1");
    EXPECT_EQ(r.primitive(0).shape_keys[0], r.primitive(1).shape_keys[0]);
}

TEST(ReadState, InstancesBeyondTheLimitAreLeftOut) {
    ReadOptions options;
    options.most_instanced_primitives = 3;
    const ReadOutcome r = read_world("ObjectBegin 1 " + kSphere + kSphere +
                                         "ObjectEnd ObjectInstance 1 ObjectInstance 1 "
                                         "ObjectInstance 1 " +
                                         kSphere,
                                     options);
    EXPECT_EQ(r.count(), 3u);
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("instances make more than 3 primitives")));
}

TEST(ReadState, InstancesMayHaveParameters) {
    const ReadOutcome r = read_world("ObjectBegin \"a\" " + kSphere +
                                     "ObjectEnd ObjectInstance \"a\" \"float x\" 1 ObjectInstance \"a\" "
                                     "\"float x\" [2]");
    EXPECT_EQ(r.count(), 2u);
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("ObjectInstance: parameters are not used")));
}

TEST(ReadState, MisplacedRequestsAreSkipped) {
    for (const char* text : {"WorldBegin",
                             "FrameBegin 1",
                             "ObjectInstance 5",
                             "ArchiveEnd",
                             "AttributeEnd",
                             "MotionEnd",
                             "ObjectEnd",
                             "FrameEnd",
                             "TransformEnd",
                             "ObjectBegin 1 ObjectBegin 2 ObjectEnd",
                             "ObjectBegin 1 LightSource \"ambientlight\" 1 ObjectEnd",
                             "ObjectBegin 1 ObjectInstance 1 ObjectEnd",
                             "Sphere 1 -1 1 360 7",
                             "1 2 3",
                             "] ",
                             "Sphere [[1] -1 1 360]",
                             "\"text\"",
                             "Rotate 10 0 0 0",
                             "Skew 90 1 0 0 1 1 0",
                             "Scale 1 \"x\" 1",
                             "Orientation 5",
                             "Sides 3",
                             "Basis \"foo\" 3 \"bezier\" 3",
                             "Basis \"bezier\" 9 \"bezier\" 3",
                             "ShadingRate -1",
                             "Declare \"x\" \"uniform colour\""}) {
        const ReadOutcome r = read_world(std::string(text) + "\n" + kSphere);
        EXPECT_EQ(r.messages.size(), 1u) << text << ::testing::PrintToString(r.messages);
        EXPECT_EQ(r.count(), 1u) << text;
    }
}

TEST(ReadState, HidersThatSeeOtherThingsAreSaid) {
    for (const std::string name : {"hidden", "raytrace", "stochastic", "zbuffer"})
        EXPECT_THAT(read_text("Hider \"" + name + "\" WorldBegin WorldEnd").messages, ::testing::IsEmpty());
    for (const std::string name : {"paint", "foo"})
        EXPECT_THAT(read_text("Hider \"" + name + "\" WorldBegin WorldEnd").messages,
                    ElementsAre(::testing::HasSubstr("there is no hider \"" + name + "\"")));
}

TEST(ReadState, ExposureSaysWhichNumberIsWrong) {
    EXPECT_THAT(read_text("Exposure -1 1 WorldBegin WorldEnd").messages,
                ElementsAre(::testing::HasSubstr("needs a gain that is not negative")));
    EXPECT_THAT(read_text("Exposure 1 0 WorldBegin WorldEnd").messages,
                ElementsAre(::testing::HasSubstr("needs a positive gamma")));
}

}  // namespace
}  // namespace trapeze::testing
