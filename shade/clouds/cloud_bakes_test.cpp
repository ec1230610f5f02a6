#include "shade/clouds/cloud_bakes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"
#include "shade/clouds/clouds_harness.h"

namespace trapeze::testing {
namespace {

/// A call that bakes so many points, which say where they come from by x (the grid), y (the call) and z.
BakedCall baked_call(const std::string& file, uint64_t grid, size_t call, size_t points) {
    BakedCall baked;
    baked.file = file;
    baked.at = {0, 3, 1 + static_cast<uint32_t>(call)};
    for (size_t i = 0; i < points; ++i)
        baked.points.insert(baked.points.end(), {static_cast<float>(grid), static_cast<float>(call),
                                                 static_cast<float>(i), 0, 0, 1, 1});
    return baked;
}

BakedGrid baked_grid(const std::string& file, uint64_t ordinal) {
    return {ordinal, {baked_call(file, ordinal, 0, 1 + ordinal % 3), baked_call(file, ordinal, 1, 2)}};
}

/// As calls do: what there is no room for is forgotten.
void add(BakedGrid grid, CloudBakes& bakes) {
    std::erase_if(grid.calls, [&](const BakedCall& call) { return !bakes.reserve(call); });
    bakes.add({std::move(grid)});
}

class CloudBakesTest : public ::testing::Test {
  protected:
    std::string file(const std::string& name) const { return folder_.file(name); }
    void write(CloudBakes& bakes) { bakes.write({}, kEverything, diagnostics_); }
    std::vector<V3f> positions(const std::string& name) const {
        std::string problem;
        const auto cloud = read_ptc(file_text(file(name)), &problem);
        EXPECT_TRUE(cloud) << problem;
        return cloud ? cloud->positions : std::vector<V3f>();
    }

    TemporaryFolder folder_;
    std::vector<Diagnostic> said_;
    Diagnostics diagnostics_{[this](const Diagnostic& d) {
        if (d.kind != "written-elsewhere") said_.push_back(d);
    }};
};

/// However grids come, and however often.
TEST_F(CloudBakesTest, StandInTheOrderOfGridsAndCalls) {
    std::vector<uint64_t> ordinals{0, 1, 2, 3, 4, 5, 77, uint64_t{1} << 40};
    std::string first;
    Numbers numbers(2);
    for (int round = 0; round < 6; ++round) {
        CloudBakes bakes;
        for (const uint64_t ordinal : ordinals) add(baked_grid(file("a.ptc"), ordinal), bakes);
        for (const uint64_t ordinal : {uint64_t{3}, uint64_t{0}})
            add(baked_grid(file("a.ptc"), ordinal), bakes);
        write(bakes);
        const std::vector<V3f> places = positions("a.ptc");
        EXPECT_EQ(places.size(), 8u * 2 + 1 + 2 + 3 + 1 + 2 + 3 + 77 % 3 + 1 + (uint64_t{1} << 40) % 3 + 1);
        EXPECT_TRUE(std::ranges::is_sorted(places, [](const V3f& a, const V3f& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        }));
        const std::string bytes = file_text(file("a.ptc"));
        if (round == 0) first = bytes;
        EXPECT_EQ(bytes, first);
        for (size_t i = 0; i < ordinals.size(); ++i)
            std::swap(ordinals[i], ordinals[numbers.bits() % ordinals.size()]);
    }
    EXPECT_TRUE(said_.empty());
}

TEST_F(CloudBakesTest, OfMoreThanTheLimitNothingIsWritten) {
    CloudBakes bakes;
    bakes.set_limit(4000);
    for (uint64_t ordinal = 0; ordinal < 20; ++ordinal) add(baked_grid(file("a.ptc"), ordinal), bakes);
    write(bakes);
    ASSERT_EQ(said_.size(), 1u);
    EXPECT_NE(said_[0].text.find("is not written"), std::string::npos) << said_[0].text;
    EXPECT_FALSE(std::filesystem::exists(file("a.ptc")));
    // What was written, or was not, is forgotten.
    add(baked_grid(file("b.ptc"), 1), bakes);
    write(bakes);
    EXPECT_EQ(positions("b.ptc").size(), 4u);
    EXPECT_EQ(said_.size(), 1u);
}

TEST_F(CloudBakesTest, WhatIsClearedIsNotWritten) {
    CloudBakes bakes;
    add(baked_grid(file("a.ptc"), 1), bakes);
    bakes.clear();
    add(baked_grid(file("a.ptc"), 1), bakes);
    write(bakes);
    EXPECT_EQ(positions("a.ptc").size(), 4u);
}

TEST_F(CloudBakesTest, AFileThatCannotBeWrittenLeavesNothing) {
    std::filesystem::create_directory(file("a.ptc"));
    CloudBakes bakes;
    add(baked_grid(file("a.ptc"), 1), bakes);
    write(bakes);
    ASSERT_EQ(said_.size(), 1u);
    EXPECT_EQ(said_[0].severity, Severity::Error);
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.ptc"});
}

TEST_F(CloudBakesTest, OnAFullDiskTheOldFileStays) {
    CloudBakes bakes;
    add(baked_grid(file("a.ptc"), 1), bakes);
    write(bakes);
    const std::string old = file_text(file("a.ptc"));
    for (uint64_t ordinal = 0; ordinal < 3000; ++ordinal) add(baked_grid(file("a.ptc"), ordinal), bakes);
    {
        const FileSizeLimit full(1 << 16);
        write(bakes);
    }
    ASSERT_EQ(said_.size(), 1u);
    EXPECT_NE(said_[0].text.find("cannot be written"), std::string::npos) << said_[0].text;
    EXPECT_EQ(file_text(file("a.ptc")), old);
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.ptc"});
}

}  // namespace
}  // namespace trapeze::testing
