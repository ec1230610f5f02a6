/// Streams: archives, search paths, gzip, limits, and text that is hardly RIB.
#include "pipeline/rib/reading_harness.h"

#include <zlib.h>

namespace trapeze::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

std::string zipped(const std::string& text) {
    const Folder folder;
    const std::string path = folder.path() + "/z.gz";
    gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Which a reader of streams takes for its input.
TEST(ReadArchives, MayHaveAnyName) {
    const Folder folder;
    folder.write("-", "Sphere 1 -1 1 360");
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const std::string file = "a.rib";
    folder.write(file, "WorldBegin ReadArchive \"-\" WorldEnd");
    const ReadOutcome outcome = read_files(folder, {file});
    std::filesystem::current_path(before);
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ReadArchives, RelativeToTheFileThatNamesThem) {
    const Folder folder;
    folder.write("sub/b.rib", "ReadArchive \"deep/c.rib\"");
    folder.write("sub/deep/c.rib", "\n " + kSphere + "\n Sphere 1");
    const ReadOutcome r = read_files(
        folder, {folder.write("a.rib", "WorldBegin\nReadArchive \"sub/b.rib\"\n" + kSphere + "WorldEnd")});
    EXPECT_EQ(r.count(), 2u);
    EXPECT_THAT(r.messages,
                ElementsAre("sub/deep/c.rib:3:2: error: Sphere: has 1 numbers, needs 4; primitive skipped"
                            "\n    included from sub/b.rib:1:1\n    included from a.rib:2:1"));
    EXPECT_EQ(r.summary.files, 3);
}

TEST(ReadArchives, AlongTheSearchPath) {
    const Folder folder;
    folder.write("one/x.rib", kSphere);
    folder.write("two/y.rib", kSphere);
    ASSERT_EQ(setenv("TRAPEZE_TEST_TWO", "two", 1), 0);
    const ReadOutcome r = read_files(
        folder,
        {folder.write("a.rib",
                      "Option \"searchpath\" \"archive\" [\"one\"] Option \"searchpath\" \"string archive\" "
                      "[\"@:&:$TRAPEZE_TEST_TWO\"] WorldBegin ReadArchive \"x.rib\" "
                      "ReadArchive \"y.rib\" ReadArchive \"z.rib\" WorldEnd")});
    EXPECT_EQ(r.count(), 2u);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("ReadArchive: \"z.rib\" is not found; nothing read")));
}

TEST(ReadArchives, OfOtherMachinesAreFoundWithoutTheirLeadingFolders) {
    const Folder folder;
    folder.write("sub/x.rib", kSphere);
    const ReadOutcome r = read_files(folder, {folder.write("a.rib",
                                                           "WorldBegin ReadArchive \"//D/show/sub/x.rib\" "
                                                           "ReadArchive \"Z:\\\\show\\\\sub\\\\x.rib\" "
                                                           "ReadArchive \"//D/show/sub/x.rib\" WorldEnd")});
    EXPECT_EQ(r.count(), 3u);
    ASSERT_EQ(r.messages.size(), 2u);
    for (const std::string& message : r.messages) {
        EXPECT_THAT(message, HasSubstr("warning: ReadArchive"));
        EXPECT_THAT(message, HasSubstr("sub/x.rib\" is read"));
    }
}

TEST(ReadArchives, InlineOnesHaveTheirPlacesInTheFile) {
    const ReadOutcome r = read_text("ArchiveBegin \"ball\"\n" + kSphere +
                                    "\nSphere 1\nArchiveEnd\nWorldBegin\n"
                                    "Color 1 0 0 ReadArchive \"ball\"\nReadArchive \"ball\"\nWorldEnd");
    EXPECT_EQ(r.count(), 2u);
    EXPECT_EQ(r.attributes().color, V3f(1, 0, 0));
    EXPECT_THAT(r.messages, ElementsAre("a.rib:3:1: error: Sphere: has 1 numbers, needs 4; primitive skipped"
                                        "\n    included from a.rib:6:13"));
}

TEST(ReadArchives, FilesBelowAProjectNameOthersFromItsFolder) {
    const Folder folder;
    folder.write("film/rib/job/ball.rib", kSphere);
    folder.write("ball.rib", kSphere);
    const std::string main = folder.write(
        "film/rib/0001/0001.rib",
        "WorldBegin\nReadArchive \"rib/job/ball.rib\"\nReadArchive \"/home/artist/film/rib/job/ball.rib\"\n"
        "ReadArchive \"ball.rib\"\nWorldEnd\n");
    const ReadOutcome r = read_files(folder, {main});
    EXPECT_EQ(r.count(), 2u);
    EXPECT_THAT(
        r.messages,
        ElementsAre(HasSubstr("\"rib/job/ball.rib\" is not found; \""), HasSubstr("ball.rib\" is read"),
                    HasSubstr("error: ReadArchive: \"ball.rib\" is not found; nothing read")));
}

TEST(ReadArchives, ProjectsHaveFoldersForEachKindOfFile) {
    const Folder folder;
    folder.write("film/archives/ball.rib", kSphere);
    folder.write("film/scenes/rib/ball2.rib", kSphere);
    folder.write("film/shaders/glow.sl", "");
    folder.write("film/textures/sky.tx", "");
    const ReadOutcome r = read_files(
        folder, {folder.write("film/scenes/a.rib",
                              "WorldBegin ReadArchive \"ball.rib\" ReadArchive \"ball2.rib\" WorldEnd")});
    EXPECT_EQ(r.count(), 2u);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("warning: ReadArchive: \"ball.rib\" is not found; \""),
                                        HasSubstr("film/scenes/rib/ball2.rib\" is read")));
    auto paths = r.scene().options.search_paths;
    EXPECT_THAT(paths["shader"], Contains(HasSubstr("film/scenes/../shaders")));
    EXPECT_THAT(paths["shader"], Not(Contains(HasSubstr("textures"))));
    EXPECT_THAT(paths["texture"], Contains(HasSubstr("film/scenes/../textures")));
}

TEST(ReadArchives, ArchivesAreReadWithoutAWorld) {
    const ReadOutcome r = read_text(
        "# a part\nAttributeBegin\nSphere 1 -1 1 360\nSphere 1\nSolidBegin \"primitive\"\n"
        "MotionBegin [0 1]\nSphere 1 -1 1 360\nSphere 2 -1 1 360\nMotionEnd\nSolidEnd\n"
        "ObjectInstance 7\nProcedural \"DelayedReadArchive\" [\"b.rib\"] [-1 1 -1 1 -1 1]\nAttributeEnd\n");
    EXPECT_THAT(r.messages,
                ElementsAre(StartsWith("a.rib:4:1: error: Sphere: has 1 numbers"),
                            StartsWith("a.rib:3:1: note: 5 primitives outside of a world, in an input")));
    EXPECT_TRUE(r.worlds.empty());
}

TEST(ReadArchives, GeometryBeforeAWorldIsAnError) {
    const ReadOutcome r = read_text("Sphere 1 -1 1 360\nSphere 1 -1 1 360\nWorldBegin\n" + kSphere +
                                    "WorldEnd\nSphere 1 -1 1 360");
    EXPECT_THAT(r.messages,
                ElementsAre("a.rib:1:1: error: Sphere: geometry outside of a world; 2 primitives skipped",
                            "a.rib:5:1: error: Sphere: geometry outside of a world; primitive skipped"));
    EXPECT_EQ(r.count(), 1u);
}

TEST(ReadArchives, InlineOnesNestAndMayBeRedefinedWhileRead) {
    const ReadOutcome r = read_world("ArchiveBegin \"a\" ArchiveBegin \"b\" " + kSphere +
                                     "ArchiveEnd ReadArchive \"b\" "
                                     "ArchiveBegin \"a\" ArchiveEnd " +
                                     kSphere + "ArchiveEnd ReadArchive \"a\" ReadArchive \"a\"");
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(r.count(), 2u);
}

TEST(ReadArchives, RecursionEnds) {
    const Folder folder;
    folder.write("b.rib", "ReadArchive \"./a.rib\" " + kSphere);
    const ReadOutcome r = read_files(
        folder, {folder.write("a.rib", "WorldBegin ReadArchive \"b.rib\" ReadArchive \"../" +
                                           std::filesystem::path(folder.path()).filename().string() +
                                           "/a.rib\" WorldEnd")});
    EXPECT_EQ(r.count(), 1u);
    ASSERT_EQ(r.messages.size(), 2u);
    for (const std::string& message : r.messages)
        EXPECT_THAT(message, HasSubstr("reads itself; not read again"));
}

TEST(ReadArchives, BombsEndAtTheLimit) {
    std::string text;
    for (int i = 0; i < 40; ++i) {
        const std::string next = "ReadArchive \"a" + std::to_string(i + 1) + "\" ";
        text += "ArchiveBegin \"a" + std::to_string(i) + "\" " + next + next + "ArchiveEnd\n";
    }
    ReadOptions options;
    options.most_archives_read = 1000;
    const ReadOutcome r = read_text(
        text + "ArchiveBegin \"a40\" ArchiveEnd ReadArchive \"a0\" WorldBegin " + kSphere + "WorldEnd",
        options);
    EXPECT_EQ(r.count(), 1u);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("which is the limit")));
}

TEST(ReadArchives, GzipIsUndone) {
    const std::string text = "WorldBegin " + kSphere + "WorldEnd";
    EXPECT_EQ(read_text(zipped(text)).count(), 1u);
    EXPECT_EQ(read_text(zipped("WorldBegin " + kSphere) + zipped(kSphere + "WorldEnd")).count(), 2u);
    const ReadOutcome cut = read_text(zipped(text + std::string(1000, ' ')).substr(0, 30));
    EXPECT_THAT(cut.messages[0], HasSubstr("gzip data is cut off"));
}

TEST(ReadArchives, FilesBeyondTheLimitAreCut) {
    ReadOptions options;
    options.max_source_bytes = 1000;
    const ReadOutcome r =
        read_text(zipped("WorldBegin " + kSphere + std::string(5000000, ' ') + kSphere), options);
    EXPECT_THAT(r.messages[0], HasSubstr("inflates to more than"));
    EXPECT_EQ(r.count(), 1u);
    EXPECT_EQ(read_text("WorldBegin " + kSphere + std::string(5000, ' ') + kSphere, options).count(), 1u);
}

TEST(ReadArchives, MissingFilesAreReported) {
    const Folder folder;
    const ReadOutcome r =
        read_files(folder, {folder.path() + "/no.rib", folder.write("a.rib", "WorldBegin WorldEnd")});
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("cannot read \"no.rib\": No such file")));
    EXPECT_EQ(r.worlds.size(), 1u);
}

TEST(ReadText, ArraysEndBeforeTheNextRequest) {
    const ReadOutcome r =
        read_world("Polygon \"P\" [0 0 0 1 0 0\n" + kSphere + "Polygon \"P\" [0 0 zero 1]\n" + kSphere);
    EXPECT_THAT(
        r.messages,
        ElementsAre("a.rib:2:13: error: Polygon: the array that begins here is never closed; request skipped",
                    "a.rib:3:36: error: Polygon: \"zero\" stands within an array; request skipped"));
    EXPECT_EQ(r.count(), 2u);
}

TEST(ReadText, Utf16WithAByteOrderMarkIsRead) {
    // As editors and shells of Windows write; "\u00fc" and a pair of surrogates stand in a name.
    const std::u16string text =
        u"\ufeffWorldBegin\r\nAttribute \"identifier\" \"string name\" "
        u"\"\u00fc\u4e16\U0001F600\"\r\nSphere 1 -1 1 360\r\nWorldEnd\r\n";
    for (const bool big : {false, true}) {
        std::string bytes;
        for (const char16_t unit : text)
            for (const int shift : {big ? 8 : 0, big ? 0 : 8})
                bytes += static_cast<char>(unit >> shift & 255);
        const Folder folder;
        const ReadOutcome r = read_files(folder, {folder.write("a.rib", bytes)});
        EXPECT_THAT(r.messages, IsEmpty()) << big;
        ASSERT_EQ(r.count(), 1u) << big;
        EXPECT_EQ(r.attributes().name, "\xc3\xbc\xe4\xb8\x96\xf0\x9f\x98\x80") << big;

        bytes.pop_back();  // cut in the middle of a character
        EXPECT_EQ(read_files(folder, {folder.write("a.rib", bytes)}).count(), 1u) << big;
    }
}

TEST(ReadText, UnknownRequestsAreSkippedWithAnIdeaOfWhatWasMeant) {
    const ReadOutcome r = read_world("Spere 1 -1 1 360 " + kSphere + "sphere 1 Xyzzy [1 2] \"a\" " + kSphere);
    EXPECT_THAT(
        r.messages,
        ElementsAre(
            "a.rib:2:1: error: Spere: no such request (did you mean Sphere?); skipped to the next one",
            HasSubstr("sphere: no such request (did you mean Sphere?)"),
            HasSubstr("Xyzzy: no such request; skipped")));
    EXPECT_EQ(r.count(), 2u);
}

TEST(ReadText, WhatIsNoRibAtAllIsNoFloodOfMessages) {
    std::string prose, undeclared;
    const auto letters = [](int n) {
        return std::string{char('a' + n / 676), char('a' + n / 26 % 26), char('a' + n % 26)};
    };
    for (int i = 0; i < 3000; ++i) {
        prose += letters(i) + "x [1 2] ~~\n";
        undeclared +=
            "Attribute \"" + letters(i) + "\" \"x\" [1] " + "Sphere 1 -1 1 360 \"" + letters(i) + "\" [1]\n";
    }
    const ReadOutcome words = read_world(prose + kSphere);
    EXPECT_LT(words.messages.size(), 30u);
    EXPECT_THAT(words.messages, Contains(HasSubstr("further unknown names are only counted")));
    EXPECT_EQ(words.count(), 1u);

    const ReadOutcome names = read_world(undeclared + kSphere);
    EXPECT_LT(names.messages.size(), 250u);
    EXPECT_THAT(names.messages, Contains(HasSubstr("further messages of other kinds are only counted")));
    EXPECT_EQ(names.count(), 3001u);
}

TEST(ReadText, UnsupportedRequestsWarnOncePerKind) {
    const ReadOutcome r = read_world(
        "Volume \"box\" [0 1 0 1 0 1] [0 0 0] Volume \"box\" [0 1 0 1 0 1] [0 0 0] VPInterior \"a\" "
        "MakeBrickMap \"a\" \"b\" " +
        kSphere);
    EXPECT_EQ(r.messages.size(), 3u);
    EXPECT_EQ(r.summary.unsupported.at("Volume"), 2u);
    EXPECT_EQ(r.count(), 1u);
}

TEST(ReadText, MessagesAreOneShortLine) {
    const ReadOutcome r = read_world("Sphere 1 -1 1 360 \"new\nline" + std::string(1000, 'x') + "\" [1]");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_EQ(r.messages[0].find('\n'), std::string::npos);
    EXPECT_LT(r.messages[0].size(), 250u);
}

TEST(ReadText, BlocksThatStayOpenAreClosed) {
    const ReadOutcome r =
        read_text("FrameBegin 1\nWorldBegin\nAttributeBegin\nObjectBegin 1\nMotionBegin [0 1]\n" + kSphere);
    EXPECT_EQ(r.worlds.size(), 1u);
    EXPECT_THAT(
        r.messages,
        ElementsAre("a.rib:5:1: error: MotionBegin: never closed; closed at the end of the input",
                    HasSubstr("Sphere occurs 1 times"), HasSubstr("a.rib:4:1: error: ObjectBegin: never"),
                    HasSubstr("AttributeBegin: never"), HasSubstr("WorldBegin: never"),
                    HasSubstr("FrameBegin: never")));
}

}  // namespace
}  // namespace trapeze::testing
