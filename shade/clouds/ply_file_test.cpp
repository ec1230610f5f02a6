#include "shade/clouds/ply_file.h"

#include <gtest/gtest.h>

#include "shade/clouds/clouds_harness.h"

namespace trapeze::testing {
namespace {

/// Normals are of unit length as they are read, which may round each number once more.
void expect_same_cloud(const PointCloud& found, const PointCloud& expected) {
    EXPECT_EQ(found.channels, expected.channels);
    EXPECT_EQ(found.positions, expected.positions);
    EXPECT_EQ(found.radii, expected.radii);
    EXPECT_EQ(found.values, expected.values);
    ASSERT_EQ(found.normals.size(), expected.normals.size());
    for (size_t i = 0; i < expected.size(); ++i)
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(found.normals[i][k], expected.normals[i][k], 3e-7f);
}

PointCloud ply_read(const std::string& bytes) {
    std::string problem;
    const auto cloud = read_ply(bytes, &problem);
    EXPECT_TRUE(cloud) << problem;
    return cloud.value_or(PointCloud());
}

std::string ply_problem_of(const std::string& bytes) {
    std::string problem;
    EXPECT_FALSE(read_ply(bytes, &problem)) << problem;
    return problem;
}

TEST(PlyFile, ComesBackAsItWas) {
    const PointCloud cloud = some_cloud(123);
    expect_same_cloud(ply_read(ply_of(cloud, true)), cloud);
    expect_same_cloud(ply_read(ply_of(cloud, false)), cloud);
}

TEST(PlyFile, IsWrittenAsItIsDocumented) {
    PointCloud cloud;
    cloud.channels = {{"_area", ChannelType::Float}, {"_radiosity", ChannelType::Color}};
    cloud.positions = {{1, 2.5f, -3}}, cloud.normals = {{0, 0, 1}}, cloud.radii = {.125f};
    cloud.values = {7, .5f, .25f, 1e-9f};
    EXPECT_EQ(ply_of(cloud, true), R"(ply
format ascii 1.0
comment point cloud of Trapeze
comment channel float _area
comment channel color _radiosity
element vertex 1
property float x
property float y
property float z
property float nx
property float ny
property float nz
property float radius
property float _area
property float _radiosity_r
property float _radiosity_g
property float _radiosity_b
end_header
1 2.5 -3 0 0 1 0.125 7 0.5 0.25 1e-09
)");
}

TEST(PlyFile, OfOtherProgramsIsReadAsFarAsItGoes) {
    const PointCloud cloud = ply_read(R"(ply
format ascii 1.0
obj_info made elsewhere
element vertex 2
property uchar red
property double z
property uchar green
property float x
property uchar blue
property float y
property float confidence
property float speed_x
property float speed_y
property float speed_z
element face 1
property list uchar int vertex_indices
end_header
255 3 0 1 51 2 .5 7 8 9
0 -3 +255 -1 0 -2 .25 1 2 3
3 0 1 1
)");
    EXPECT_EQ(cloud.channels, (std::vector<CloudChannel>{{"Cs", ChannelType::Color},
                                                         {"confidence", ChannelType::Float},
                                                         {"speed", ChannelType::Vector}}));
    EXPECT_EQ(cloud.positions, (std::vector<V3f>{{1, 2, 3}, {-1, -2, -3}}));
    EXPECT_EQ(cloud.normals, (std::vector<V3f>{V3f(0), V3f(0)}));
    EXPECT_EQ(cloud.values, (std::vector<float>{1, 0, 51 / 255.0f, .5f, 7, 8, 9, 0, 1, 0, .25f, 1, 2, 3}));
}

TEST(PlyFile, OfBigEndiansIsRead) {
    const std::string header =
        "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty short y\r\n"
        "property float z\r\nend_header\r\n";
    const std::string point("\x3f\x80\0\0\xff\xfe\x40\0\0\0", 10);
    EXPECT_EQ(ply_read(header + point).positions, (std::vector<V3f>{{1, -2, 2}}));
}

TEST(PlyFile, CutShortAnywhereIsAMessage) {
    for (const bool ascii : {true, false}) {
        const std::string bytes = ply_of(some_cloud(2), ascii);
        // Of text the last digits, and the newline behind them, may go.
        const size_t end = ascii ? bytes.find_last_of(' ') : bytes.size();
        for (size_t size = 0; size < end; ++size) EXPECT_NE(ply_problem_of(bytes.substr(0, size)), "");
    }
}

TEST(PlyFile, WhatCannotBeIsAMessage) {
    const std::string start = "ply\nformat ascii 1.0\n",
                      places =
                          "property float x\nproperty float y\n"
                          "property float z\n",
                      end = "end_header\n1 2 3\n";
    EXPECT_EQ(ply_problem_of(start + "element vertex 18446744073709551615\n" + places + end),
              "it says that it has 18446744073709551615 points, and has no more than 1");
    EXPECT_EQ(ply_problem_of(start + "element vertex -1\n" + places + end), "it has \"-1\" of an element");
    EXPECT_EQ(ply_problem_of(start + "element vertex 1\nproperty float x\n" + end),
              "its vertices have no x, y and z");
    EXPECT_EQ(ply_problem_of(start + "element vertex 1\nproperty quad x\n" + end),
              "its vertices have a property of type \"quad\"");
    EXPECT_EQ(ply_problem_of(start + "element vertex 1\nproperty list uchar int x\n" + places + end),
              "its vertices have a property of type \"list\"");
    EXPECT_EQ(ply_problem_of(start + "element face 1\n" + places + "element vertex 1\n" + end),
              "its first element is \"face\", and not \"vertex\"");
    EXPECT_EQ(ply_problem_of("ply\nformat base64 1.0\n" + end), "its format is \"base64\"");
    EXPECT_EQ(ply_problem_of("ply\nelement vertex 1\n" + places + end), "it does not say its format");
    EXPECT_EQ(ply_problem_of(start + end), "it has no vertices");
    EXPECT_EQ(ply_problem_of(start + "element vertex 1\n" + places + "end_header\n1 two 3\n"),
              "its point 1 has no number for \"y\"");
    EXPECT_EQ(ply_problem_of(start + "nonsense\n" + end), "its header has a line \"nonsense\"");
}

}  // namespace
}  // namespace trapeze::testing
