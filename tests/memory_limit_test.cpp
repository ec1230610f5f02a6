/// What `trapeze render --memory` holds to when the input is made to take more: measured from outside.
#include <sys/resource.h>
#include <sys/wait.h>
#include <zlib.h>

#include <chrono>

#include "core/sanitizer_harness.h"
#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

const std::string kUnitSphere = "Sphere 1 -1 1 360\n";
const std::string kHead =
    "Display \"a.exr\" \"file\" \"rgba\"\nFormat 64 48 1\nPixelSamples 1 1\n"
    "Projection \"perspective\"\nTranslate 0 0 5\nWorldBegin\n";

struct Measured {
    Outcome outcome;
    double mebibytes = 0;  ///< resident, at most
    double seconds = 0;
};

/// In a process between, for a process knows the peak of all its children only.
Measured measured(const WorkFolder& folder, const std::string& arguments) {
    int ends[2];
    if (pipe(ends) != 0) return {};
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
        const Outcome outcome = run_program(folder, arguments);
        rusage usage{};
        getrusage(RUSAGE_CHILDREN, &usage);
        const long values[] = {usage.ru_maxrss, outcome.exit_code};
        _exit(write(ends[1], values, sizeof values) == sizeof values ? 0 : 1);
    }
    close(ends[1]);
    long values[2] = {0, -1};
    const bool good = ::read(ends[0], values, sizeof values) == sizeof values;
    close(ends[0]);
    waitpid(child, nullptr, 0);
    Measured result;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!good) return result;
    result.mebibytes = static_cast<double>(values[0]) / 1024;
    result.outcome = {static_cast<int>(values[1]), file_text(folder / ".stdout"),
                      file_text(folder / ".stderr")};
    return result;
}

/// What the program takes for next to nothing; sanitizers take their own.
double least_mebibytes() {
    WorkFolder folder;
    folder.write("a.rib", kHead + kUnitSphere + "WorldEnd\n");
    return measured(folder, "render a.rib -t 2 --memory 64M").mebibytes;
}

constexpr double kMostSecondsOfMuch = kSanitized ? 1200 : 120;  ///< on a slow and busy machine

/// `times` the limit of 64 MiB may be taken.
void expect_bounded(const Measured& run, double times) {
    EXPECT_LT(run.seconds, kMostSecondsOfMuch);
    if (kSanitized) return;
    EXPECT_LT(run.mebibytes, least_mebibytes() + times * 64) << run.outcome.err;
}

void expect_said(const Measured& run, const std::string& message) {
    EXPECT_NE(run.outcome.err.find(message), std::string::npos) << run.outcome.err;
}

/// Writes `text` over and over, packed.
void write_bomb(const std::filesystem::path& path, const std::string& first, const std::string& text,
                size_t mebibytes) {
    gzFile file = gzopen(path.c_str(), "wb1");
    gzwrite(file, first.data(), static_cast<unsigned>(first.size()));
    std::string block;
    while (block.size() < (size_t{1} << 20)) block += text;
    for (size_t i = 0; i < mebibytes; ++i) gzwrite(file, block.data(), static_cast<unsigned>(block.size()));
    gzclose(file);
}

TEST(MemoryLimit, GzipThatUnpacksToMoreIsCut) {
    WorkFolder folder;
    write_bomb(folder / "a.rib.gz", kHead + kUnitSphere, "        ", 512);
    const Measured run = measured(folder, "render a.rib.gz -t 2 --memory 64M");
    expect_said(run, "inflates to more than 64 MiB");
    EXPECT_EQ(run.outcome.exit_code, 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "a.exr"));
    expect_bounded(run, 4);
}

TEST(MemoryLimit, ASceneOfMoreIsCut) {
    WorkFolder folder;
    write_bomb(folder / "a.rib.gz", kHead, "Polygon \"P\" [0 0 0 .01 0 0 0 .01 0]\nTranslate .00001 0 0\n",
               60);
    const Measured run = measured(folder, "render a.rib.gz -t 2 --memory 64M");
    expect_said(run, "the scene takes more than 64 MiB");
    EXPECT_EQ(run.outcome.exit_code, 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "a.exr"));
    expect_bounded(run, 10);
}

TEST(MemoryLimit, GridsOfMoreAreMadeInParts) {
    WorkFolder folder;
    folder.write("a.rib",
                 "Display \"a.exr\" \"file\" \"rgba\"\nFormat 512 512 1\nPixelSamples 1 1\n"
                 "ShadingRate .05\nWorldBegin\n" +
                     kUnitSphere + "WorldEnd\n");
    const Measured whole = measured(folder, "render a.rib -t 2 --memory 4G");
    const Measured run = measured(folder, "render a.rib -t 2 --memory 64M");
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.err;
    expect_bounded(run, 4);
    if (kSanitized) return;
    EXPECT_LT(run.mebibytes, whole.mebibytes);
}

TEST(MemoryLimit, PicturesOfStrangersAreBounded) {
    WorkFolder folder;
    folder.write("a.rib", "Format 6000 6000 1\nWorldBegin\n" + kUnitSphere + "WorldEnd\n");
    const Measured run = measured(folder, "render a.rib -t 2 --memory 64M --safe");
    expect_said(run, "a picture of 6002x6002 pixels takes");
    EXPECT_EQ(run.outcome.exit_code, 7);
    expect_bounded(run, 1);
}

/// Each fills the picture, and all are there to be split before the first is diced.
TEST(MemoryLimit, PrimitivesOfMoreSplitsAreLeftOut) {
    WorkFolder folder;
    std::string text = "Display \"a.exr\" \"file\" \"rgba\"\nFormat 64 64 1\nPixelSamples 1 1\nWorldBegin\n";
    for (int i = 0; i < 1000; ++i) text += kUnitSphere;
    folder.write("a.rib", text + "WorldEnd\n");
    const Measured run = measured(folder, "render a.rib -t 2 --memory 4M");
    expect_said(run, "the grids into which primitives are split take more than 4 MiB to list");
    EXPECT_EQ(run.outcome.exit_code, 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "a.exr"));
    expect_bounded(run, 4);
}

TEST(MemoryLimit, AMeshOfMoreSplitsIsLeftOut) {
    WorkFolder folder;
    std::string text =
        "Display \"a.exr\" \"file\" \"rgba\"\nFormat 512 512 1\nPixelSamples 1 1\nShadingRate 4\nWorldBegin\n"
        "PointsPolygons [";
    constexpr int kFaces = 3000;
    for (int i = 0; i < kFaces; ++i) text += "4 ";
    text += "] [";
    for (int i = 0; i < kFaces; ++i) text += "0 1 2 3 ";
    folder.write("a.rib", text + "] \"P\" [-1 -1 1 1 -1 1 1 1 1 -1 1 1]\nSphere .5 -.5 .5 360\nWorldEnd\n");
    const Measured run = measured(folder, "render a.rib -t 2 --memory 16M");
    expect_said(run, "a.rib:6:1: error: the grids into which it is split take more than 16 MiB to list");
    EXPECT_EQ(run.outcome.exit_code, 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "a.exr"));
    expect_bounded(run, 4);
}

TEST(MemoryLimit, SolidsWithinSolidsAreRendered) {
    WorkFolder folder;
    std::string text = kHead;
    constexpr int kDeep = 9000;
    for (int i = 0; i < kDeep; ++i) text += i % 2 ? "SolidBegin \"union\"\n" : "SolidBegin \"difference\"\n";
    text += "SolidBegin \"primitive\"\n" + kUnitSphere + "SolidEnd\n";
    for (int i = 0; i < kDeep; ++i) text += "SolidEnd\n";
    folder.write("a.rib", text + "WorldEnd\n");
    const Measured run = measured(folder, "render a.rib -t 2 --memory 64M");
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.err;
    expect_bounded(run, 4);
}

TEST(MemoryLimit, SurfacesThatReachForInfinityAreSplitSoFar) {
    WorkFolder folder;
    // Weights of either sign: the surface passes through infinity.
    folder.write("a.rib",
                 kHead +
                     "ShadingRate .25\nNuPatch 4 4 [0 0 0 0 1 1 1 1] 0 1 4 4 [0 0 0 0 1 1 1 1] 0 1 \"Pw\" ["
                     "-2 -2 0 1 -1 -2 1 -1 0 -2 0 1 1 -2 1 -1  -2 -1 2 -1 -1 -1 3 1 0 -1 0 -1 1 -1 2 1 "
                     "-2 0 1 1 -1 0 2 -2 0 0 3 1 1 0 3 -2  -2 1 1 -3 -1 1 3 3 0 1 3 -3 1 1 3 3]\nWorldEnd\n");
    const Measured run = measured(folder, "render a.rib -t 2 --memory 64M");
    expect_bounded(run, 4);
}

}  // namespace
}  // namespace trapeze::testing
