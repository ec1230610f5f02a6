/// What is wrong with strangers' files.
#include "pipeline/study/aff/aff_parser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/study/aff/aff_harness.h"

namespace trapeze {
namespace {

using testing::AffFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kStillTriangle = "p 3  0 0 0  1 0 0  0 1 0\n";

TEST(AffParser, SaysWhatIsWrongInWhichLine) {
    const AffFolder folder;
    const std::pair<const char*, const char*> cases[] = {
        {"b 0 0 0\nq 7\n", "scene.aff:2: error: no statement of AFF \"q\""},
        {"\n\np 3 0 0 0\n1 0 zero\n", "scene.aff:4: error: a corner expected, a number, and not \"zero\""},
        {"p 3 0 0 0\n1 0", "scene.aff:2: error: a corner expected, but the file ends"},
        {"p 3 0 0 nan 1 1 1 1 1 1", "scene.aff:1: error: a corner expected, a number, and not \"nan\""},
        {"p 3 0 0 1e19 1 1 1 1 1 1", "scene.aff:1: error: a corner expected, a number, and not \"1e19\""},
        {"p 3 0 0 1e999 1 1 1 1 1 1", "scene.aff:1: error: a corner expected, a number, and not \"1e999\""},
        {"p 3 0 0 0,5 1 1 1 1 1 1", "scene.aff:1: error: a corner expected, a number, and not \"0,5\""},
        {"p 2 0 0 0 1 1 1",
         "scene.aff:1: error: a count of corners expected, an integer from 3 to 2147483647, and not \"2\""},
        {"p 99999999999",
         "scene.aff:1: error: a count of corners expected, an integer from 3 to 2147483647, and "
         "not \"99999999999\""},
        {"p 2000000000 1 1 1", "scene.aff:1: error: a corner expected, but the file ends"},
        {"m vertices 1 0 0 0\ntriangles 1\n0 1 0",
         "scene.aff:3: error: a vertex expected, an integer from 0 to 0, and not \"1\""},
        {"m vertices 1 0 0 0\ntriangles 1\n0 -1 0",
         "scene.aff:3: error: a vertex expected, an integer from 0 to 0, and not \"-1\""},
        {"m vertices 0 triangles 1 0 0 0", "scene.aff:1: error: triangles of a mesh without vertices"},
        {"m\nnormals 1", "scene.aff:2: error: vertices expected, and not \"normals\""},
        {"c 1 1 1 1  1 1 1 2", "scene.aff:1: error: both ends of a cone are at the same place"},
        {"xs 1 1 1 0 0 0 0 0 0 0\np 3", "scene.aff:2: error: { expected, and not \"p\""},
        {"x box {\nb 0 0 0\n", "scene.aff:2: error: the transform of line 1 has no }"},
        {"b 0 0 0 }", "scene.aff:1: error: } without a transform of this file that is open"},
        {"k box {\ntransl 3",
         "scene.aff:2: error: a count of keys expected, an integer from 4 to 2147483647, "
         "and not \"3\""},
        {"k box {\nturn 4",
         "scene.aff:2: error: transl, rot, scale, visibility or } expected, and not \"turn\""},
        {"k box {\n", "scene.aff:1: error: transl, rot, scale, visibility or } expected, but the file ends"},
        {"k box { visibility 2 1 0\n0 1 }",
         "scene.aff:2: error: the time of a key is before that of the key before"},
        {"tpa 2  1  0 0 0 0 0 0  0 0 0 0 0 0  0 0 0 0 0 0\n0 ",
         "scene.aff:2: error: the time of a key is before that of the key before"},
        {"tpa 0",
         "scene.aff:1: error: a count of times expected, an integer from 1 to 2147483647, and not \"0\""},
        {"a 1 0 5", "scene.aff:1: error: the last frame is before the first one"},
        {"a 0 1 0",
         "scene.aff:1: error: a count of frames expected, an integer from 1 to 2147483647, and not \"0\""},
        {"v from 0 0 0\nto 1 1 1", "scene.aff:2: error: at expected, and not \"to\""},
        {"b 0 0 0\ni 0 missing.aff", "scene.aff:2: error: no such file: \"missing.aff\""},
        {"i 0 .", "scene.aff:1: error: no such file: \".\""},
    };
    for (const auto& [text, problem] : cases) EXPECT_EQ(folder.problem(text), problem) << text;
}

TEST(AffParser, ShowsNoControlCharactersAndNoLongWords) {
    const AffFolder folder;
    EXPECT_EQ(folder.problem("\x1b[31m\x07"), "scene.aff:1: error: no statement of AFF \"?[31m?\"");
    EXPECT_LT(folder.problem(std::string(1 << 20, 'z')).size(), 200);
    EXPECT_THAT(folder.problem(std::string("p\0 3", 4)), HasSubstr("\"p?\""));
}

TEST(AffParser, AMissingFileIsAProblemOfItsFirstLine) {
    const AffFolder folder;
    std::string problem;
    EXPECT_FALSE(AffScene::read(folder.file("none.aff"), &problem));
    EXPECT_THAT(problem, StartsWith(folder.file("none.aff") + ":1: error: no such file: "));
}

TEST(AffParser, AProblemOfAnIncludedFileIsOfItsLine) {
    const AffFolder folder;
    folder.write("part.aff", "b 0 0 0\n\nwrong\n");
    EXPECT_EQ(folder.problem("i 0 part.aff\nwrong_too\n"),
              "part.aff:3: error: no statement of AFF \"wrong\"");
    // It can close no transform of the file that includes it, and leave none open.
    folder.write("part.aff", "}");
    EXPECT_EQ(folder.problem("x box { i 0 part.aff"),
              "part.aff:1: error: } without a transform of this file that is open");
    folder.write("part.aff", "x box {");
    EXPECT_EQ(folder.problem("i 0 part.aff }"), "part.aff:1: error: the transform of line 1 has no }");
}

TEST(AffParser, IncludesEndThoughFilesIncludeThemselves) {
    const AffFolder folder;
    EXPECT_EQ(folder.problem("i 0 scene.aff"), "scene.aff:1: error: files include each other 16 deep");
    // Each file includes the next one ten times, and the last one is empty: a ten billionth.
    for (int i = 0; i < 10; ++i) {
        std::string text;
        for (int j = 0; j < 10; ++j) text += "i 0 " + std::to_string(i + 1) + ".aff\n";
        folder.write(std::to_string(i) + ".aff", text);
    }
    folder.write("10.aff", "");
    EXPECT_THAT(folder.problem("i 0 0.aff"), HasSubstr("more than 20000 files"));
}

TEST(AffParser, TrianglesAndTransformsAreLimited) {
    const AffFolder folder;
    std::string text;
    for (int i = 0; i < 84'000; ++i) text += "s 0 0 0 1\n";  // of 48 triangles
    EXPECT_THAT(folder.problem(text), HasSubstr("scene.aff:83334: error: more than 4000000 triangles"));
    text.clear();
    for (int i = 0; i < 65; ++i) text += "x box {\n";
    EXPECT_THAT(folder.problem(text), HasSubstr("scene.aff:65: error: more than"));
    text.clear();
    for (int i = 0; i < 200'001; ++i) text += "x box { }\n";
    EXPECT_THAT(folder.problem(text), HasSubstr("error: more than 200000 transforms"));
}

TEST(AffParser, VisibilityKeysInEachOtherAreLimited) {
    const AffFolder folder;
    std::string text = "k box { visibility 1000\n";
    for (int i = 0; i < 1000; ++i) text += std::to_string(i) + (i % 2 ? " 0\n" : " 1\n");
    text += "}\n";
    for (int i = 0; i < 5000; ++i) text += "x box { }\n";
    EXPECT_THAT(folder.problem(text), HasSubstr("scene.aff:1: error: too many visibility keys"));
}

TEST(AffParser, NumbersAreReadAsCReadsThem) {
    const AffFolder folder;
    const std::vector<V3f> corners = folder.scene("p 3  +1 -2. .5e1  1E0 00 -0  1 1 1").triangles_at(0);
    EXPECT_EQ(corners[0], V3f(1, -2, 5));
    EXPECT_EQ(corners[1], V3f(1, 0, 0));
    EXPECT_THAT(folder.problem("p 3 +-1 0 0"), HasSubstr("\"+-1\""));
    EXPECT_THAT(folder.problem("p 3 0x1 0 0"), HasSubstr("\"0x1\""));
    EXPECT_EQ(folder.scene(kStillTriangle).frame_count(), 1);
}

}  // namespace
}  // namespace trapeze
