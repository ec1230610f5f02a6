/// Constructive solid geometry as trees of solids.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Operation = Solid::Operation;

struct Node {
    Operation operation;
    int parent, place;
};

void expect_solids(const ReadOutcome& r, const std::vector<Node>& expected) {
    const std::vector<Solid>& solids = r.scene().solids;
    ASSERT_EQ(solids.size(), expected.size());
    for (size_t i = 0; i < solids.size(); ++i) {
        EXPECT_EQ(solids[i].operation, expected[i].operation) << i;
        EXPECT_EQ(solids[i].parent, expected[i].parent) << i;
        EXPECT_EQ(solids[i].place, expected[i].place) << i;
    }
}

const std::string kLeaf = "SolidBegin \"primitive\" " + kSphere + "SolidEnd ";

TEST(ReadSolids, TreesAndTheirSurfaces) {
    const ReadOutcome r = read_world("SolidBegin \"difference\" SolidBegin \"union\" " + kLeaf + kLeaf +
                                     "SolidEnd SolidBegin \"primitive\" " + kSphere + "Color 1 0 0 " +
                                     kSphere + "SolidEnd SolidEnd " + kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    expect_solids(r, {{Operation::Difference, -1, 0},
                      {Operation::Union, 0, 0},
                      {Operation::Primitive, 1, 0},
                      {Operation::Primitive, 1, 1},
                      {Operation::Primitive, 0, 1}});
    ASSERT_EQ(r.count(), 5u);
    const int expected[] = {2, 3, 4, 4, -1};
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(r.primitive(i).solid, expected[i]);
    EXPECT_EQ(r.attributes(4).color, V3f(1, 1, 1)) << "solids save attributes";
}

TEST(ReadSolids, InstancesHaveSolidsOfTheirOwn) {
    const ReadOutcome r =
        read_world("ObjectBegin 1 SolidBegin \"intersection\" " + kLeaf + kLeaf +
                   "SolidEnd ObjectEnd ObjectInstance 1 "
                   "SolidBegin \"union\" ObjectInstance 1 SolidEnd "
                   "ObjectBegin 2 " +
                   kSphere + kSphere + "ObjectEnd SolidBegin \"primitive\" ObjectInstance 2 SolidEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    expect_solids(r, {{Operation::Intersection, -1, 0},
                      {Operation::Primitive, 0, 0},
                      {Operation::Primitive, 0, 1},
                      {Operation::Union, -1, 0},
                      {Operation::Intersection, 3, 0},
                      {Operation::Primitive, 4, 0},
                      {Operation::Primitive, 4, 1},
                      {Operation::Primitive, -1, 0}});
    const int expected[] = {1, 2, 5, 6, 7, 7};
    ASSERT_EQ(r.count(), 6u);
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(r.primitive(i).solid, expected[i]);
}

TEST(ReadSolids, ObjectsInSolidsOfObjects) {
    const ReadOutcome r =
        read_world("ObjectBegin 1 " + kLeaf + "ObjectEnd ObjectBegin 2 SolidBegin \"union\" " + kLeaf +
                   "ObjectInstance 1 SolidEnd ObjectEnd ObjectInstance 2");
    EXPECT_THAT(r.messages, IsEmpty());
    expect_solids(r, {{Operation::Union, -1, 0}, {Operation::Primitive, 0, 0}, {Operation::Primitive, 0, 1}});
    ASSERT_EQ(r.count(), 2u);
    EXPECT_EQ(r.primitive(0).solid, 1);
    EXPECT_EQ(r.primitive(1).solid, 2);
}

TEST(ReadSolids, MovingSurfacesBelongToTheirSolid) {
    const ReadOutcome r = read_world(
        "SolidBegin \"primitive\" MotionBegin [0 1] Sphere 1 -1 1 360 Sphere 2 -2 2 360 MotionEnd SolidEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(r.primitive().solid, 0);
}

TEST(ReadSolids, SurfacesWithoutAPrimitiveSolidAreSolidsWithAWarning) {
    const ReadOutcome r = read_world("SolidBegin \"difference\" " + kSphere + kSphere + "SolidEnd");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("SolidBegin \"primitive\""));
    expect_solids(
        r, {{Operation::Difference, -1, 0}, {Operation::Primitive, 0, 0}, {Operation::Primitive, 0, 1}});
}

TEST(ReadSolids, WrongOnesAreReported) {
    const ReadOutcome r = read_text(
        "SolidBegin \"union\"\nWorldBegin\nSolidBegin \"xor\"\n"
        "SolidBegin \"primitive\"\nSolidBegin \"union\"\nSolidEnd\nSolidEnd\nWorldEnd\n");
    ASSERT_EQ(r.messages.size(), 4u);
    EXPECT_THAT(r.messages[0], HasSubstr("\"xor\" is none of"));
    EXPECT_THAT(r.messages[1], HasSubstr("inside a primitive solid"));
    EXPECT_THAT(r.messages[2], HasSubstr("no SolidBegin is open"));
    EXPECT_THAT(r.messages[3], HasSubstr("a.rib:1"));
}

}  // namespace
}  // namespace trapeze::testing
