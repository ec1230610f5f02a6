/// Files, formats, contexts; what is written reads back the same.
#include "core/scene/scene.h"
#include "pipeline/ri/ri_harness.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze::ri {
namespace {

using ::testing::ElementsAre;

void set_format(RtString format, RtString compression) {
    RiOption("rib", "format", &format, "string compression", &compression, RI_NULL);
}

class RiOutput : public Ri {
  protected:
    ~RiOutput() override { set_format("ascii", "none"); }
};

void describe_scene() {
    RtFloat fov = 40.123f, third = 1.0f / 3;
    RtPoint points[4] = {{0.1f, 0.2f, 0.3f}, {1e-20f, 16777217.0f, -0.7f}, {third, -third, 1}, {2, 2, 2}};
    RtColor colors[4] = {{0.1f, 0, 0}, {0, 0.7f, 0}, {0, 0, third}, {1, 1, 1}};
    RtInt counts[] = {3, 3}, corners[] = {0, 1, 2, 1, 2, 3};
    RtString name = "a \"quoted\" \\ name\nof two lines, longer than sixteen";
    RiProjection(RI_PERSPECTIVE, RI_FOV, &fov, RI_NULL);
    RiWorldBegin();
    RiAttribute(RI_IDENTIFIER, RI_NAME, &name, RI_NULL);
    RiRotate(12.345f, 0.1f, 0.2f, 0.3f);
    RiPointsPolygons(2, counts, corners, RI_P, points, RI_CS, colors, RI_NULL);
    RiWorldEnd();
}

struct ReadBack {
    float fov = 0;
    std::string name;
    std::vector<float> points, colors;
    M44f matrix;
    bool operator==(const ReadBack&) const = default;
};

ReadBack read_back(const std::string& path) {
    ReadBack back;
    Diagnostics diagnostics;
    const std::string files[] = {path};
    read_rib(files, {}, diagnostics, [&](Scene&& scene) {
        back.fov = scene.options.fov;
        ASSERT_EQ(scene.primitives.size(), 1u);
        const Primitive& primitive = scene.primitives[0];
        back.name = primitive.attributes->name;
        back.points = primitive.shape().variables.find("P")->floats;
        back.colors = primitive.shape().variables.find("Cs")->floats;
        back.matrix = primitive.camera_from_object[0];
    });
    EXPECT_EQ(diagnostics.count(Severity::Error), 0u);
    return back;
}

TEST_F(RiOutput, EveryFormatReadsBackTheSameBits) {
    const auto written = [&](const std::string& name) {
        RiBegin(path(name).c_str());
        describe_scene();
        RiEnd();
        return read_back(path(name));
    };
    const ReadBack ascii = written("a.rib");
    const float third = 1.0f / 3;
    EXPECT_EQ(ascii.fov, 40.123f);
    EXPECT_EQ(ascii.name, "a \"quoted\" \\ name\nof two lines, longer than sixteen");
    EXPECT_EQ(ascii.points,
              (std::vector<float>{0.1f, 0.2f, 0.3f, 1e-20f, 16777217.0f, -0.7f, third, -third, 1, 2, 2, 2}));
    EXPECT_EQ(ascii.colors, (std::vector<float>{0.1f, 0, 0, 0, 0.7f, 0, 0, 0, third, 1, 1, 1}));
    EXPECT_EQ(written("b.rib.gz"), ascii);
    set_format("binary", "none");
    EXPECT_EQ(written("c.rib"), ascii);
    set_format("binary", "gzip");
    EXPECT_EQ(written("d.rib"), ascii);

    const std::string gzip_magic = "\x1f\x8b";
    EXPECT_TRUE(trapeze::testing::file_text(path("b.rib.gz")).starts_with(gzip_magic));
    EXPECT_TRUE(trapeze::testing::file_text(path("d.rib")).starts_with(gzip_magic));
    EXPECT_NE(trapeze::testing::file_text(path("c.rib")).find('\246'),
              std::string::npos);  // an encoded request
    EXPECT_TRUE(reported().empty());
}

TEST_F(RiOutput, FormatsThatAreNoneAreErrors) {
    set_format("xml", "none");
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_BADTOKEN));
}

TEST_F(RiOutput, FilesAppearWholeOrNotAtAll) {
    const std::string file = path("a.rib");
    RiBegin(file.c_str());
    RiSides(2);
    EXPECT_THAT(files(), ::testing::Not(::testing::Contains("a.rib")));
    RiEnd();
    EXPECT_THAT(files(), ElementsAre("a.rib"));
}

TEST_F(RiOutput, WhatCannotBeWrittenIsReported) {
    RiBegin(path("no/such/folder.rib").c_str());
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_NOFILE));
    RiSides(2);
    RiEnd();
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_NOFILE, RIE_SYSTEM));
    EXPECT_TRUE(files().empty());
}

TEST_F(RiOutput, ContextsAreApart) {
    const std::string one = path("one.rib"), two = path("two.rib");
    RiBegin(one.c_str());
    const RtContextHandle first = RiGetContext();
    RiDeclare("mine", "float");
    RiBegin(two.c_str());
    RtFloat value = 1;
    RiSurface("matte", "mine", &value, RI_NULL);  // not declared here
    const RtContextHandle second = RiGetContext();
    EXPECT_NE(first, second);
    RiContext(first);
    RiSurface("matte", "mine", &value, RI_NULL);
    RiEnd();
    EXPECT_EQ(RiGetContext(), nullptr);
    RiContext(first);  // is no more
    RiContext(second);
    RiEnd();
    EXPECT_THAT(trapeze::testing::file_text(one),
                ::testing::EndsWith("Declare \"mine\" \"float\"\nSurface \"matte\" \"mine\" [1]\n"));
    EXPECT_THAT(trapeze::testing::file_text(two), ::testing::EndsWith("Surface \"matte\"\n"));
    EXPECT_THAT(reported_codes(), ElementsAre(RIE_BADTOKEN, RIE_BADHANDLE));
}

TEST_F(RiOutput, RendersAndReportsWhatTheRenderSays) {
    const std::string picture = path("a.exr");
    RiBegin(RI_NULL);
    RiDisplay(picture.c_str(), RI_FILE, RI_RGBA, RI_NULL);
    RiFormat(8, 8, 1);
    RiWorldBegin();
    RiSurface("no_such_shader", RI_NULL);
    RiSphere(0.5f, -0.5f, 0.5f, 360, RI_NULL);
    RiWorldEnd();
    EXPECT_TRUE(reported().empty());
    RiEnd();
    ASSERT_EQ(reported().size(), 2u);  // the other says that the picture's folder is not the working one
    EXPECT_EQ(reported()[0].code, RIE_NOSHADER);
    EXPECT_THAT(reported()[0].text, ::testing::HasSubstr("no_such_shader"));
    EXPECT_THAT(files(), ElementsAre("a.exr"));
}

}  // namespace
}  // namespace trapeze::ri
