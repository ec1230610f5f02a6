/// RiTransformPoints (RISpec 4.3).
#include "pipeline/ri/ri_harness.h"

namespace trapeze::ri {
namespace {

class RiSpaces : public Ri {
  protected:
    void expect(const char* from, const char* to, const RtPoint& point, double x, double y, double z) {
        RtPoint points[1] = {{point[0], point[1], point[2]}};
        ASSERT_EQ(RiTransformPoints(from, to, 1, points), points) << from << " to " << to;
        EXPECT_NEAR(points[0][0], x, 1e-4) << from << " to " << to;
        EXPECT_NEAR(points[0][1], y, 1e-4) << from << " to " << to;
        EXPECT_NEAR(points[0][2], z, 1e-4) << from << " to " << to;
    }
};

TEST_F(RiSpaces, ReachFromTheObjectToTheCamera) {
    rib_of([this] {
        const RtPoint origin = {0, 0, 0}, p = {1, 0, 0};
        RiTranslate(0, 0, 10);
        RiWorldBegin();
        RiTransformBegin();
        RiTranslate(1, 2, 3);
        RiRotate(90, 0, 0, 1);
        expect("object", "world", p, 1, 3, 3);
        expect("current", "camera", p, 1, 3, 13);
        expect("camera", "object", origin, -2, 1, -13);
        RiCoordinateSystem("hand");
        RiTransformEnd();
        expect("hand", "current", p, 1, 3, 3);
        RiScale(2, 2, 2);
        expect("hand", "current", p, 0.5, 1.5, 1.5);
        RiCoordSysTransform("hand");
        expect("current", "world", p, 1, 3, 3);
        RiWorldEnd();
    });
    EXPECT_TRUE(reported().empty());
}

TEST_F(RiSpaces, ReachThroughThePerspective) {
    rib_of([this] {
        RtFloat fov = 90;
        // x = z fills half the screen's height in a square picture.
        const RtPoint right = {2, 0, 2}, up = {0, 1, 2}, ahead = {0, 0, 5};
        RiFormat(100, 100, 1);
        RiClipping(1, 3);
        RiProjection(RI_PERSPECTIVE, RI_FOV, &fov, RI_NULL);
        RiWorldBegin();
        // The depth at 2 between planes at 1 and 3: f (z - n) / (z (f - n)) = 3/4; at 5 it is 6/5.
        expect("camera", "screen", right, 1, 0, 0.75);
        expect("camera", "NDC", right, 1, 0.5, 0.75);
        expect("world", "raster", up, 50, 25, 0.75);
        expect("camera", "raster", ahead, 50, 50, 1.2);
        const RtPoint corner = {100, 50, 0.75f};
        expect("raster", "camera", corner, 2, 0, 2);
        RiWorldEnd();
    });
    EXPECT_TRUE(reported().empty());
}

TEST_F(RiSpaces, OfMotionTheFirstKeyCounts) {
    rib_of([this] {
        const RtPoint origin = {0, 0, 0};
        RiWorldBegin();
        RiMotionBegin(2, 0.0, 1.0);
        RiTranslate(1, 0, 0);
        RiTranslate(5, 0, 0);
        RiMotionEnd();
        expect("object", "world", origin, 1, 0, 0);
        RiWorldEnd();
    });
}

TEST_F(RiSpaces, UnknownOrFlatOnesGiveNull) {
    rib_of([] {
        RtPoint points[1] = {{1, 2, 3}};
        RiWorldBegin();
        EXPECT_EQ(RiTransformPoints("nowhere", "world", 1, points), nullptr);
        EXPECT_EQ(RiTransformPoints("world", "nowhere", 1, points), nullptr);
        RiScale(0, 1, 1);
        EXPECT_EQ(RiTransformPoints("world", "object", 1, points), nullptr);
        EXPECT_EQ(points[0][2], 3);
        RiWorldEnd();
    });
    EXPECT_EQ(reported().size(), 3u);
}

}  // namespace
}  // namespace trapeze::ri
