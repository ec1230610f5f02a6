/// RIB that is made to break its reader: numbers that are none, counts beyond all bounds, blocks within
/// blocks. Everything is said, and what comes after is read.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/sanitizer_harness.h"
#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/syntax/arguments.h"
#include "pipeline/rib/write/rib_writer.h"
#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

namespace fs = std::filesystem;

const std::string kSphere = "Sphere 1 -1 1 360\n";
/// Of a slow processor, for any one input; the sanitizers take ten times as long.
constexpr double kMostSeconds = kSanitized ? 600 : 60;

struct Reading {
    std::string messages;
    uint64_t errors = 0;
    size_t primitives = 0;
    double seconds = 0;  ///< of the processor: other work of the machine does not count
};

Reading read(std::string_view text, const ReadOptions& options = {}) {
    Reading reading;
    Diagnostics diagnostics(
        [&](const Diagnostic& diagnostic) { reading.messages += to_string(diagnostic) + "\n"; });
    const std::clock_t begin = std::clock();
    read_rib_text(text, "made.rib", options, diagnostics,
                  [&](Scene&& scene) { reading.primitives += scene.primitives.size(); });
    reading.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    reading.errors = diagnostics.count(Severity::Error);
    return reading;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::vector<fs::path> tiny_scenes() {
    std::set<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(TRAPEZE_SOURCE_DIR "/scenes/tiny"))
        if (entry.path().extension() == ".rib") paths.insert(entry.path());
    return {paths.begin(), paths.end()};
}

/// A number as it stands in a text.
struct Place {
    size_t begin, length;
    std::string at;  ///< line:column
};

/// The numbers of ASCII RIB outside of strings and comments: of each array the first ones.
std::vector<Place> numbers_in(const std::string& text) {
    constexpr int kMostOfArray = 3;
    std::vector<Place> places;
    size_t line = 1, line_start = 0;
    int in_array = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\n') ++line, line_start = i + 1;
        if (text[i] == '#') i = text.find('\n', i) - 1;
        if (text[i] == '"') i = text.find('"', i + 1);
        if (text[i] == '[' || text[i] == ']') in_array = 0;
        const bool begins = i > 0 && (text[i - 1] == ' ' || text[i - 1] == '[');
        if (!begins || std::string_view("0123456789.+-").find(text[i]) == std::string_view::npos) continue;
        const size_t end = text.find_first_of(" ]\n", i);
        if (++in_array <= kMostOfArray)
            places.push_back({i, end - i, std::to_string(line) + ":" + std::to_string(i - line_start + 1)});
    }
    return places;
}

TEST(HostileRib, NumbersThatAreNoneAreSaidWhereverTheyStand) {
    // What stands in these blocks is not always read.
    const auto skips = [](const std::string& text) {
        return contains(text, "IfBegin") || contains(text, "ArchiveBegin") || contains(text, "EditBegin") ||
               contains(text, "\x80");
    };
    const char* const kNumbers[] = {"nan", "-inf", "1e39", "infinity"};
    size_t count = 0;
    for (const fs::path& path : tiny_scenes()) {
        const std::string text = file_text(path);
        if (skips(text)) continue;
        for (const Place& place : numbers_in(text)) {
            std::string changed = text;
            changed.replace(place.begin, place.length, kNumbers[count++ % 4]);
            const Reading reading = read(changed);
            ASSERT_TRUE(contains(reading.messages, "made.rib>:" + place.at + ": error: "))
                << path << " " << place.at << "\n"
                << reading.messages;
            ASSERT_TRUE(contains(reading.messages, "not a finite number")) << path << " " << place.at;
        }
    }
    EXPECT_GT(count, 1000u);
}

TEST(HostileRib, EncodedNumbersThatAreNoneAreSaid) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                    kInfinite = std::numeric_limits<float>::infinity();
    size_t count = 0;
    const auto expect_said = [&](const rib::RequestText& request) {
        std::string bytes;
        {
            rib::RibWriter writer(rib::RibEncoding::Binary, [&](std::string_view part) { bytes += part; });
            writer.write(request);
        }
        const Reading reading = read(bytes);
        ASSERT_TRUE(contains(reading.messages, "not a finite number")) << request.name << reading.messages;
    };
    for (const fs::path& path : tiny_scenes()) {
        Diagnostics diagnostics([](const Diagnostic&) {});
        ReadOptions options;
        options.on_request = [&](const rib::RequestText& request) {
            for (size_t a = 0; a < request.arguments.size(); ++a) {
                rib::RequestText changed = request;
                rib::Argument& argument = changed.arguments[a];
                const float wrong = ++count % 2 ? kNan : -kInfinite;
                if (argument.is_text()) continue;
                argument.large_integers.clear();
                if (argument.kind == rib::Argument::Kind::Number)
                    argument.number = wrong;
                else if (!argument.floats.empty())
                    argument.floats[count % argument.floats.size()] = wrong;
                else
                    continue;
                expect_said(changed);
            }
            return true;
        };
        const std::vector<std::string> files{path.string()};
        read_rib(files, options, diagnostics, [](Scene&&) {});
    }
    EXPECT_GT(count, 1000u);
}

TEST(HostileRib, CountsBeyondAllBoundsAreSaid) {
    const char* const kCounts[] = {"2147483647", "2147483648", "4294967295", "-2147483648",
                                   "1e30",       "1e9",        "-1"};
    // "@" is the count.
    const std::vector<std::string> requests{
        R"(PatchMesh "bilinear" @ "nonperiodic" @ "nonperiodic" "P" [0 0 0 1 0 0 0 1 0 1 1 0])",
        R"(PatchMesh "bicubic" 4 "periodic" @ "periodic" "P" [0 0 0])",
        R"(NuPatch @ 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 "P" [0 0 0 1 0 0 0 1 0 1 1 0])",
        R"(NuPatch 2 @ [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 "P" [0 0 0 1 0 0 0 1 0 1 1 0])",
        R"(NuPatch @ @ [0 0 1 1] 0 1 @ @ [0 0 1 1] 0 1 "P" [0 0 0 1 0 0 0 1 0 1 1 0])",
        R"(TrimCurve [@] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1])",
        R"(TrimCurve [@ @ @ @] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1])",
        R"(TrimCurve [1] [@] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1])",
        R"(TrimCurve [1] [2] [0 0 1 1] [0] [1] [@] [0 1] [0 1] [1 1])",
        R"(PointsPolygons [@] [0 1 2] "P" [0 0 0 1 0 0 0 1 0])",
        R"(PointsPolygons [3] [0 1 @] "P" [0 0 0 1 0 0 0 1 0])",
        R"(PointsPolygons [@ @ @ @ @ @ @ @] [0 1 2] "P" [0 0 0 1 0 0 0 1 0])",
        R"(PointsGeneralPolygons [@] [3] [0 1 2] "P" [0 0 0 1 0 0 0 1 0])",
        R"(PointsGeneralPolygons [1] [@] [0 1 2] "P" [0 0 0 1 0 0 0 1 0])",
        R"(GeneralPolygon [@] "P" [0 0 0 1 0 0 0 1 0])",
        R"(GeneralPolygon [@ @ @ @] "P" [0 0 0 1 0 0 0 1 0])",
        R"(SubdivisionMesh "catmull-clark" [@] [0 1 2] "P" [0 0 0 1 0 0 0 1 0])",
        R"(SubdivisionMesh "catmull-clark" [3] [0 1 @] "P" [0 0 0 1 0 0 0 1 0])",
        R"(SubdivisionMesh "catmull-clark" [3] [0 1 2] ["crease"] [@ 1] [0 1] [3] "P" [0 0 0 1 0 0 0 1 0])",
        R"(SubdivisionMesh "catmull-clark" [3] [0 1 2] ["crease"] [2 @] [0 1] [3] "P" [0 0 0 1 0 0 0 1 0])",
        R"(SubdivisionMesh "catmull-clark" [3] [0 1 2] ["hole"] [1 0] [@] [] "P" [0 0 0 1 0 0 0 1 0])",
        R"(Curves "linear" [@] "nonperiodic" "P" [0 0 0 1 0 0])",
        R"(Curves "cubic" [@ @ @] "periodic" "P" [0 0 0 1 0 0])",
        R"(Blobby @ [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [""])",
        R"(Blobby 1 [1001 @] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [""])",
        R"(Blobby 1 [1001 0 0 @ 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [""])",
        R"(Blobby 1 [1001 0 @] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [""])",
        R"(Blobby 1 [1003 @ @] [1 0 0 0] [""])",
        R"(Polygon "P" [0 0 0 1 0 0 0 1 0] "vertex float[@] a" [1 2 3])",
        R"(Sphere 1 -1 1 360 "constant string[@] a" ["b"])",
        R"(Declare "a" "uniform float[@]")",
        R"(ObjectInstance @)",
        R"(Illuminate @ 1)",
    };
    for (const std::string& request : requests)
        for (const char* const count : kCounts) {
            std::string text = request;
            for (size_t at; (at = text.find('@')) != std::string::npos;) text.replace(at, 1, count);
            const Reading reading = read("WorldBegin\n" + text + "\n" + kSphere + "WorldEnd\n");
            EXPECT_TRUE(contains(reading.messages, "<made.rib>:2:")) << text;
            EXPECT_GE(reading.primitives, 1u) << text;
            EXPECT_LT(reading.seconds, kMostSeconds) << text;
        }
}

/// Lengths that are not there, in all of the binary encoding's forms.
TEST(HostileRib, EncodedLengthsBeyondTheEndAreSaid) {
    using namespace std::string_literals;
    const std::string lengths[] = {"\xa3\xff\xff\xff\xff"s,
                                   "\xa2\xff\xff\xff"s,
                                   "\xa3\x7f\xff\xff\xff"s,
                                   "\xcb\xff\xff\xff\xff"s,
                                   "\xcb\x80\x00\x00\x00"s,
                                   "\xcb\x40\x00\x00\x00"s,
                                   "\xca\xff\xff\xff"s,
                                   "\xcf\xff\xff"s,
                                   "\xcd\xff\xa3\xff\xff\xff\xff"s,
                                   "\xcc\xff\xa3\xff\xff\xff\xff"s};
    for (const std::string& length : lengths) {
        const Reading reading = read("WorldBegin\n" + kSphere + "Color " + length + " 1 2 3\n" + kSphere);
        EXPECT_GE(reading.errors, 1u);
        EXPECT_GE(reading.primitives, 1u);
        EXPECT_LT(reading.seconds, kMostSeconds);
    }
}

TEST(HostileRib, BlocksWithinBlocksEndAtALimit) {
    constexpr int kDeep = 20000;
    const std::pair<std::string, std::string> blocks[] = {
        {"AttributeBegin\n", "AttributeEnd\n"},
        {"TransformBegin\n", "TransformEnd\n"},
        {"SolidBegin \"union\"\n", "SolidEnd\n"},
        {"AttributeBegin LightSource \"pointlight\" 1\n", "AttributeEnd\n"},
        {"ObjectBegin 1\n", "ObjectEnd\n"},
        {"MotionBegin [0 1]\n", "MotionEnd\n"},
        {"WorldBegin\n", "WorldEnd\n"},
        {"FrameBegin 1\n", "FrameEnd\n"},
        {"ResourceBegin\n", "ResourceEnd\n"},
        {"AttributeBegin Attribute \"user\" \"uniform float a\" [1] TransformBegin\n",
         "TransformEnd AttributeEnd\n"},
    };
    for (const auto& [begin, end] : blocks)
        for (const bool closed : {false, true}) {
            std::string text = "WorldBegin\n" + kSphere;
            for (int i = 0; i < kDeep; ++i) text += begin;
            if (closed)
                for (int i = 0; i < kDeep; ++i) text += end;
            const Reading reading = read(text + kSphere);
            EXPECT_GE(reading.errors, 1u) << begin;
            EXPECT_GE(reading.primitives, 1u) << begin;
            EXPECT_LT(reading.seconds, kMostSeconds) << begin;
        }
}

TEST(HostileRib, DeepConditionsAndArchivesEnd) {
    constexpr int kDeep = 10000;
    std::string conditions = "WorldBegin\n", archives = "WorldBegin\n",
                parentheses = "WorldBegin\nIfBegin \"", definitions = "WorldBegin\n";
    for (int i = 0; i < kDeep; ++i) {
        conditions += "IfBegin \"1\"\n";
        archives += "ArchiveBegin \"a" + std::to_string(i) + "\" ReadArchive \"a" + std::to_string(i + 1) +
                    "\" ArchiveEnd\n";
        parentheses += "(";
        definitions += "ArchiveBegin \"a\"\n";
    }
    const Reading deep_conditions = read(conditions + kSphere);
    EXPECT_TRUE(contains(deep_conditions.messages, "IfBegin")) << deep_conditions.messages.substr(0, 1000);
    const Reading deep_archives = read(archives + "ReadArchive \"a0\"\n" + kSphere);
    EXPECT_TRUE(contains(deep_archives.messages, "nested more than 64 deep"));
    EXPECT_EQ(deep_archives.primitives, 1u);
    const Reading deep_parentheses = read(parentheses + "1\" IfEnd\n" + kSphere);
    EXPECT_TRUE(contains(deep_parentheses.messages, "nested too deep"));
    EXPECT_EQ(deep_parentheses.primitives, 1u);
    const Reading deep_definitions = read(definitions + kSphere);
    EXPECT_TRUE(contains(deep_definitions.messages, "ArchiveEnd is missing"));
    for (const Reading* reading : {&deep_conditions, &deep_archives, &deep_parentheses, &deep_definitions})
        EXPECT_LT(reading->seconds, kMostSeconds);
}

TEST(HostileRib, ArchivesThatReadEachOtherEnd) {
    // Each reads the next twice: 2^40 without a limit.
    std::string text = "WorldBegin\nArchiveBegin \"a40\" ArchiveEnd\n";
    for (int i = 0; i < 40; ++i) {
        const std::string next = "ReadArchive \"a" + std::to_string(i + 1) + "\" ";
        text += "ArchiveBegin \"a" + std::to_string(i) + "\" " + next + next + "ArchiveEnd\n";
    }
    const Reading doubling = read(text + "ReadArchive \"a0\"\n" + kSphere);
    EXPECT_TRUE(contains(doubling.messages, "which is the limit"));
    EXPECT_EQ(doubling.primitives, 1u);
    EXPECT_LT(doubling.seconds, kMostSeconds);
    for (const char* request :
         {"ReadArchive \"a\"", "Procedural \"DelayedReadArchive\" [\"a\"] [0 1 0 1 0 1]"}) {
        const std::string reads_itself = std::string("ArchiveBegin \"a\" ") + request + "\nArchiveEnd\n";
        const Reading reading = read("WorldBegin\n" + reads_itself + request + "\n" + kSphere);
        EXPECT_TRUE(contains(reading.messages, "reads itself; not read again")) << request;
        EXPECT_EQ(reading.primitives, 1u);
    }
}

TEST(HostileRib, AFileThatReadsItselfIsReadOnce) {
    WorkFolder folder;
    const std::string whole =
        "ReadArchive \"a.rib\" ReadArchive \"link.rib\"\n"
        "Procedural \"DelayedReadArchive\" [\"./a.rib\"] [0 1 0 1 0 1]\n" +
        kSphere;
    folder.write("a.rib", whole);
    fs::create_symlink("a.rib", folder / "link.rib");
    std::string said;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { said += to_string(diagnostic) + "\n"; });
    folder.write("main.rib", "WorldBegin ReadArchive \"a.rib\"\n");
    const std::vector<std::string> files{(folder / "main.rib").string()};
    size_t primitives = 0;
    read_rib(files, {}, diagnostics, [&](Scene&& scene) { primitives += scene.primitives.size(); });
    EXPECT_EQ(primitives, 1u) << said;
    EXPECT_TRUE(contains(said, "\"a.rib\" reads itself")) << said;
    EXPECT_TRUE(contains(said, "\"link.rib\" reads itself")) << said;
    EXPECT_TRUE(contains(said, "\"./a.rib\" reads itself")) << said;
}

TEST(HostileRib, AWorldsPrimitivesAreBounded) {
    ReadOptions options;
    options.most_scene_bytes = size_t{1} << 20;
    // Lights are switched on one after another: each primitive has its own list of them.
    std::string lights = "WorldBegin\n", trimmed = "WorldBegin\n", spheres = lights, instances = lights;
    for (int i = 0; i < 1000; ++i) {
        for (const char* const red : {"0 ", "1 "})
            spheres += kSphere + "Color [" + red + "0 " + std::to_string(i / 1000.0) + "]\n";
        lights += "LightSource \"pointlight\" " + std::to_string(i) + "\n" + kSphere;
    }
    std::string zeros, ones;
    for (int i = 0; i < 501; ++i) zeros += "0 ", ones += "1 ";
    // A curve of 1000 points, which each patch keeps.
    const std::string points = "[" + zeros + ones.substr(4) + "] ";
    trimmed += "TrimCurve [1] [2] [" + zeros + ones + "] [0] [1] [1000] " + points + points + "[1 " + ones +
               ones.substr(6) + "]\n";
    for (int i = 0; i < 1000; ++i)
        trimmed += "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n";
    instances += "ObjectBegin 1\n" + kSphere + "ObjectEnd\n";
    for (int i = 0; i < 20000; ++i) instances += "ObjectInstance 1\n";
    for (const std::string& text : {spheres, lights, trimmed, instances}) {
        const Reading reading = read(text + "WorldEnd\nWorldBegin\n" + kSphere + "WorldEnd\n", options);
        EXPECT_TRUE(contains(reading.messages, "the scene takes more than 1 MiB")) << reading.messages;
        EXPECT_GT(reading.primitives, 20u);
        EXPECT_LT(reading.primitives, (size_t{1} << 20) / sizeof(Primitive));
        EXPECT_EQ(read(text + "WorldEnd\n").errors, 0u) << read(text).messages;  // without the limit
    }
}

}  // namespace
}  // namespace trapeze::testing
