/// Culling and bounds are judged by rays: whatever a camera ray hits was listed, with its pixel in its bound.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/raster_bound.h"

namespace trapeze {
namespace {

using testing::TestScene;

/// What a ray hits first, by brute force over all subpatches' micropolygons.
struct Nearest {
    float depth = kInfinity;
    size_t subpatch = 0;
};

Nearest nearest_hit(const std::vector<Grid>& grids, const AxisRay& ray, const Camera& camera) {
    Nearest nearest;
    for (size_t g = 0; g < grids.size(); ++g)
        for (int v = 0; v < grids[g].shape.nv; ++v)
            for (int u = 0; u < grids[g].shape.nu; ++u) {
                float depth;
                if (!hit_micropolygon(ray, grids[g].quad(u, v, ray.time), Facing::Both, &depth)) continue;
                if (depth < camera.near_clip || depth > camera.far_clip || depth >= nearest.depth) continue;
                nearest = {depth, g};
            }
    return nearest;
}

/// Rays over the whole picture, lens and shutter: the culled scene shows what the scene with everything kept
/// shows, inside the bounds.
void expect_same_picture(const std::function<void(TestScene&)>& build, uint32_t seed, int rays = 400) {
    TestScene culled, kept;
    build(culled);
    build(kept);
    kept.keep_all();
    const RenderContext context = culled.context();
    const Tessellation tessellation(context);
    const std::vector<SubpatchInfo>& infos = tessellation.subpatches();
    const testing::DicedScene seen(culled), all(kept);
    ASSERT_EQ(infos.size(), seen.grids.size());
    EXPECT_LT(seen.grids.size(), all.grids.size());
    const PixelRect picture = sampled_pixels(context.camera, culled.scene.options);
    int hits = 0;
    for (uint32_t i = 0; i < static_cast<uint32_t>(rays); ++i) {
        const auto random = [&](uint32_t dimension) { return unit_float(hash(seed, i, dimension)); };
        const float x = static_cast<float>(picture.x0) + random(0) * static_cast<float>(picture.width());
        const float y = static_cast<float>(picture.y0) + random(1) * static_cast<float>(picture.height());
        const float angle = 6.2831853f * random(2), radius = std::sqrt(random(3));
        const AxisRay ray =
            context.camera.ray(x, y, radius * std::cos(angle), radius * std::sin(angle), random(4));
        const Nearest a = nearest_hit(seen.grids, ray, context.camera);
        const Nearest b = nearest_hit(all.grids, ray, context.camera);
        EXPECT_EQ(a.depth, b.depth);
        if (a.depth == kInfinity) continue;
        ++hits;
        const PixelRect bound = infos[a.subpatch].bound;
        EXPECT_TRUE(x >= static_cast<float>(bound.x0) && x < static_cast<float>(bound.x1));
        EXPECT_TRUE(y >= static_cast<float>(bound.y0) && y < static_cast<float>(bound.y1));
    }
    EXPECT_GT(hits, rays / 20);
}

M44f turned(float angle, float x, float y, float z) {
    M44f m;
    m.rotate(V3f(angle, 0.4f * angle, 0.2f * angle));
    return m * testing::translation(x, y, z);
}

std::shared_ptr<const Shape> whole_sphere() {
    return testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360}));
}

TEST(RasterBound, StaticPinhole) {
    expect_same_picture(
        [](TestScene& s) {
            s.add(whole_sphere(), turned(0.3f, 1.2f, 0.8f, 2));
            s.add(whole_sphere(), turned(0.3f, -4, 0, 3));
        },
        1);
}

TEST(RasterBound, MotionThroughTheFrame) {
    expect_same_picture(
        [](TestScene& s) {
            s.add({whole_sphere()}, {turned(0, -6, 1, 3), turned(0.8f, -1, 1, 2.5f), turned(1.5f, 8, -1, 3)});
            s.add({whole_sphere()}, {turned(0, -6, 6, 3), turned(0.8f, -4, 5, 2.5f), turned(1.5f, 4, 6, 3)});
        },
        2);
}

TEST(RasterBound, LensAndMotion) {
    expect_same_picture(
        [](TestScene& s) {
            s.scene.options.f_stop = 1, s.scene.options.focal_length = 0.8f;
            s.scene.options.focal_distance = 4;
            s.add({whole_sphere()}, {turned(0, -2.5f, 0, 1.6f), turned(0.5f, -2.2f, 0.3f, 6)});
            s.add(whole_sphere(), turned(0, 3.5f, 0, 2.5f));
        },
        3);
}

TEST(RasterBound, SurfacesThroughTheEyePlane) {
    const auto floor = [](TestScene& s) {
        PatchMesh mesh;
        ParameterList variables;
        variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                         {-20, -1, -20, 20, -1, -20, -20, -1.2f, 40, 20, -1, 40}));
        s.scene.options.width = 40, s.scene.options.height = 30;
        s.add(testing::shape_of(mesh, variables), M44f());
    };
    expect_same_picture(floor, 4, 150);
    // What lies beside the eye and behind it is not diced.
    TestScene seen;
    floor(seen);
    const RenderContext context = seen.context();
    const Tessellation tessellation(context);
    uint64_t on_whole_picture = 0;
    for (const SubpatchInfo& info : tessellation.subpatches())
        on_whole_picture += info.bound == sampled_pixels(context.camera, seen.scene.options);
    EXPECT_LT(on_whole_picture, 4u);
    EXPECT_LT(tessellation.stats().micropolygons, 20u * 40 * 30);
}

TEST(RasterBound, EyeInsideAMovingSphere) {
    expect_same_picture(
        [](TestScene& s) {
            s.scene.options.width = 40, s.scene.options.height = 30;
            s.add({whole_sphere()}, {turned(0, 0.2f, 0, 0.3f), turned(0.3f, 0, 0.3f, -0.2f)});
        },
        5, 150);
}

TEST(RasterBound, Orthographic) {
    expect_same_picture(
        [](TestScene& s) {
            s.scene.options.projection = "orthographic";
            s.scene.options.f_stop = 2, s.scene.options.focal_length = 1, s.scene.options.focal_distance = 3;
            s.add({whole_sphere()}, {turned(0, 1.5f, 0.6f, 2), turned(0.5f, 1.2f, 0.3f, 5)});
        },
        6);
}

TEST(RasterBound, CropWithFilterMargin) {
    expect_same_picture(
        [](TestScene& s) {
            s.scene.options.crop_window = {0.5f, 0.75f, 0.25f, 0.5f};
            s.scene.options.filter.width_x = s.scene.options.filter.width_y = 5;
            s.add(whole_sphere(), turned(0.3f, 0.4f, 0.3f, 2));
        },
        7);
}

/// Corners that snap to an older edge's vertex leave the rectangle that was split off.
TEST(RasterBound, HoldsEveryVertexThoughCornersSnap) {
    for (const float rate : {1.0f, 30.0f, 500.0f}) {
        TestScene scene;
        scene.scene.options.width = 320, scene.scene.options.height = 240;
        scene.attributes->shading_rate = rate;
        scene.add({whole_sphere()}, {turned(0.3f, 0.3f, 0.2f, 1.1f), turned(0.6f, 0.3f, 0.2f, 1.1f)});
        PatchMesh mesh;  // a floor whose near edge has many times the far edge's segments
        ParameterList variables;
        variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                         {-8, -1, 1.05f, 8, -1, 1.05f, -8, -1, 30, 8, -1, 25}));
        scene.add(testing::shape_of(mesh, variables), M44f());
        const RenderContext context = scene.context();
        const Tessellation tessellation(context);
        const PixelRect picture = sampled_pixels(context.camera, scene.scene.options);
        DiceScratch scratch;
        ShadingGrid grid;
        for (size_t s = 0; s < tessellation.subpatches().size(); ++s) {
            tessellation.dice(s, grid, scratch);
            const PixelRect bound = tessellation.subpatches()[s].bound;
            for (const Triples& P : grid.P)
                for (size_t i = 0; i < grid.vertex_count(); ++i) {
                    const V2f at = context.camera.raster_from_camera(P.at(i));
                    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
                    if (P.at(i).z < context.camera.near_clip) continue;
                    if (intersection(picture, {x, y, x + 1, y + 1}).empty()) continue;
                    EXPECT_FALSE(intersection(bound, {x, y, x + 1, y + 1}).empty());
                }
        }
    }
}

struct Bounds {
    Camera camera;
    RasterBound bound;

    Bounds() : camera(camera_of()), bound(camera, {0, 0, 100, 100}) {}
    static Camera camera_of() {
        Options options;
        options.projection = "perspective";
        options.width = options.height = 100;
        options.near_clip = 0.5f, options.far_clip = 50;
        return make_camera(options);
    }
    RasterBound::Result of(const Box3f& box) const { return bound.of({&box, 1}); }
};

TEST(RasterBound, Boxes) {
    const Bounds b;
    // 90 degrees over 100 pixels: at depth 10, 5 pixels for each unit, the middle at 50.
    EXPECT_EQ(b.of({{-1, 1, 10}, {1, 2, 10}}).rect, (PixelRect{44, 39, 56, 46}));
    EXPECT_TRUE(b.of({{-1, 1, 10}, {1, 2, 10}}).inside);
    EXPECT_TRUE(b.of({{-1, -1, -5}, {1, 1, 0.4f}}).rect.empty());  // before the near plane
    EXPECT_TRUE(b.of({{-1, -1, 51}, {1, 1, 60}}).rect.empty());    // beyond the far plane
    EXPECT_TRUE(b.of({{12, -1, 10}, {14, 1, 11}}).rect.empty());   // to the right
    EXPECT_EQ(b.of({{-1, -1, -5}, {1, 1, 20}}).rect, (PixelRect{0, 0, 100, 100}));
    EXPECT_TRUE(b.of({{30, -1, -5}, {40, 1, 20}}).rect.empty());  // through the eye plane, far to the right
    EXPECT_FALSE(b.of({{-1, -1, 10}, {30, 1, 10}}).inside);
    EXPECT_TRUE(b.of({}).rect.empty());
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(b.of({{-inf, -inf, 1}, {inf, inf, 2}}).rect, (PixelRect{0, 0, 100, 100}));
}

}  // namespace
}  // namespace trapeze
