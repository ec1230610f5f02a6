/// Sharp packets, on every instruction set of the machine: pinhole rays that lie close together see what
/// testing everything sees, to the bit.
#include "accel/wide/bundle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

#include "accel/rays_harness.h"
#include "core/simd/targets_harness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/sharp_packets_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "accel/wide/bundle_trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

void trace_sharp(const TraceInput& in) {
    BundleTrace<false, false, true>(in).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

HWY_EXPORT(trace_sharp);

using testing::for_each_target;
using testing::GridMaker;
using testing::Noise;

/// Rays through one point, sixteen in each of the cells of a square of the image plane, about `middle`.
std::vector<AxisRay> pinhole_rays(V2f middle, float cell, int side, Noise& noise) {
    std::vector<AxisRay> rays;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int i = 0; i < 16; ++i)
                rays.push_back({0, 0, 0, middle.x + cell * (static_cast<float>(x) + noise(0, 1)),
                                middle.y + cell * (static_cast<float>(y) + noise(0, 1)), 0});
    return rays;
}

/// Nearest opaque hits, and what is in front of them.
struct Seen {
    std::vector<Hit> nearest;
    std::vector<std::vector<Hit>> layers;
};

Seen seen_naively(const Grids& grids, const std::vector<AxisRay>& rays, DepthRange range) {
    Seen seen;
    for (const AxisRay& ray : rays) {
        Hit nearest{range.max, MicropolygonId::kNone};
        std::vector<Hit> layers;
        for (size_t g = 0; g < grids.grids.size(); ++g) {
            const Grid& grid = grids.grids[g];
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u) {
                    float depth;
                    if (!hit_micropolygon(ray, grid.quad(u, v, 0), grid.facing, &depth)) continue;
                    if (!(depth >= range.min && depth <= range.max)) continue;
                    const MicropolygonId id{static_cast<uint32_t>(g), static_cast<uint8_t>(u),
                                            static_cast<uint8_t>(v)};
                    const Hit hit{depth, id.packed()};
                    if (!grid.opaque)
                        layers.push_back(hit);
                    else if (in_front(hit, nearest))
                        nearest = hit;
                }
        }
        std::erase_if(layers, [&](const Hit& hit) { return !in_front(hit, nearest); });
        std::sort(layers.begin(), layers.end(), in_front);
        seen.nearest.push_back(nearest);
        seen.layers.push_back(std::move(layers));
    }
    return seen;
}

/// What sharp packets of the best target that is allowed see.
Seen seen_sharply(const WideTree& tree, const std::vector<AxisRay>& rays, DepthRange range) {
    const auto bundle = std::make_unique<RayBundle>();
    const BundleScratchPointer scratch = make_bundle_scratch();
    SampleStats stats;
    std::vector<uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    fill_bundle(rays, order, {false, false}, *bundle);
    bundle->layers.begin(rays.size(), {});
    HWY_DYNAMIC_DISPATCH(trace_sharp)({tree, range, 0, *bundle, *scratch, stats});
    Seen seen;
    seen.layers.resize(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        const bool missed = bundle->id[i] == RayBundle::kNone;
        seen.nearest.push_back({bundle->depth[i], missed ? MicropolygonId::kNone : bundle->id[i]});
    }
    bundle->layers.for_each([&](uint32_t ray, const BundleLayer& layer) {
        const Hit hit{layer.depth, layer.id};
        if (in_front(hit, seen.nearest[ray])) seen.layers[ray].push_back(hit);
    });
    for (auto& layers : seen.layers) std::sort(layers.begin(), layers.end(), in_front);
    EXPECT_EQ(stats.rays, rays.size());
    return seen;
}

/// Sheets of every shape before the eye, some of them of small micropolygons, ribbons, ties, layers, and what
/// is seen from one side.
void add_things(GridMaker& maker, bool layers, Noise& noise) {
    for (int n = 0; n < 60; ++n) {
        maker.opaque = !(layers && n % 3 == 0);
        maker.facing = n % 7 == 0 ? Facing::PositiveOnly : Facing::Both;
        const V3f origin = V3f(0, 0, 6) + noise.point(3);
        const float size = n % 2 ? 0.5f : 0.04f;
        const V3f along_u = noise.point(size), along_v = noise.point(size);
        const int nu = n % 5 == 0 ? 1 : 1 + static_cast<int>(noise.engine() % 16),
                  nv = 1 + static_cast<int>(noise.engine() % 16);
        for (int copy = n % 10 == 0 ? 0 : 1; copy < 2; ++copy)
            maker.add(nu, nv, 1, [=](int i, int j, float) {
                return origin + along_u * static_cast<float>(i) + along_v * static_cast<float>(j) +
                       V3f(0, 0, 0.05f * std::sin(static_cast<float>(i + 2 * j)));
            });
    }
}

TEST(SharpPackets, SeeWhatTestingEverythingSeesOnEveryTarget) {
    for (const bool layers : {false, true}) {
        Noise noise;
        GridMaker maker;
        add_things(maker, layers, noise);
        const WideTree tree(maker.grids(), {});
        size_t hits = 0, behind = 0;
        for (int round = 0; round < 12; ++round) {
            const float cell = round % 3 == 0 ? 0.001f : 0.02f;
            auto rays = pinhole_rays({noise(-0.6f, 0.5f), noise(-0.6f, 0.5f)}, cell, 8, noise);
            rays.resize(round % 4 == 0 ? 1024 : round % 4 == 1 ? 1003 : round % 4 == 2 ? 21 : 1);
            const DepthRange range = round % 5 == 0 ? DepthRange{5, 7} : DepthRange{0.1f, 100};
            const Seen truth = seen_naively(maker.grids(), rays, range);
            for (const Hit& hit : truth.nearest) hits += hit.id != MicropolygonId::kNone;
            for (const auto& list : truth.layers) behind += list.size();
            for_each_target([&] {
                const Seen seen = seen_sharply(tree, rays, range);
                EXPECT_EQ(seen.nearest, truth.nearest) << round;
                EXPECT_EQ(seen.layers, truth.layers) << round;
            });
        }
        EXPECT_GT(hits, 1000u);
        EXPECT_EQ(behind > 100, layers);
    }
}

/// Sheets that pass beside and behind the eye, some of their vertices in its plane or nearly so: slopes are
/// of any size there, or none.
void add_things_about_the_eye(GridMaker& maker, Noise& noise) {
    for (int n = 0; n < 40; ++n) {
        const float size = n % 4 == 0 ? 0.3f : n % 4 == 1 ? 1e-3f : n % 4 == 2 ? 1e-19f : 1e-41f;
        const V3f corner = noise.point(4 * size), along_u = noise.point(size), along_v = noise.point(size);
        const int flat = n % 3;  // 0: in the plane of the eye; 1: with a row of vertices there
        maker.add(9, 7, 1, [=](int i, int j, float) {
            V3f p = corner + along_u * static_cast<float>(i) + along_v * static_cast<float>(j);
            if (flat == 0 || (flat == 1 && j == 3)) p.z = 0;
            return p;
        });
    }
}

TEST(SharpPackets, SeeWhatIsBesideTheEye) {
    Noise noise;
    GridMaker maker;
    add_things_about_the_eye(maker, noise);
    const WideTree tree(maker.grids(), {});
    size_t hits = 0;
    for (int round = 0; round < 12; ++round) {
        auto rays = pinhole_rays({noise(-0.9f, 0.8f), noise(-0.9f, 0.8f)}, 0.02f, 8, noise);
        for (size_t i = 0; i < rays.size(); i += 7) rays[i].ux = 0;
        const DepthRange range = round % 2 ? DepthRange{-100, 100} : DepthRange{0, 100};
        const Seen truth = seen_naively(maker.grids(), rays, range);
        for (const Hit& hit : truth.nearest) hits += hit.id != MicropolygonId::kNone;
        for_each_target([&] { EXPECT_EQ(seen_sharply(tree, rays, range).nearest, truth.nearest) << round; });
    }
    EXPECT_GT(hits, 1000u);
}

TEST(SharpPackets, SeeWhatIsJustAtVertices) {
    Noise noise;
    GridMaker maker;
    add_things(maker, false, noise);
    const WideTree tree(maker.grids(), {});
    size_t hits = 0;
    for (int round = 0; round < 12; ++round) {
        std::vector<AxisRay> rays;
        while (rays.size() < 1024) {
            const Grid& grid = maker.grids().grids[noise.engine() % maker.grids().grids.size()];
            const V3f p = grid.vertex(static_cast<int>(noise.engine() % (grid.shape.nu + 1u)),
                                      static_cast<int>(noise.engine() % (grid.shape.nv + 1u)), 0);
            if (p.z < 0.1f) continue;
            // A packet of one ray alone, whose slopes have no width.
            rays.insert(rays.end(), 16, AxisRay{0, 0, 0, p.x / p.z, p.y / p.z, 0});
        }
        const Seen truth = seen_naively(maker.grids(), rays, {0.1f, 100});
        for (const Hit& hit : truth.nearest) hits += hit.id != MicropolygonId::kNone;
        for_each_target([&] {
            EXPECT_EQ(seen_sharply(tree, rays, {0.1f, 100}).nearest, truth.nearest) << round;
        });
    }
    EXPECT_GT(hits, 1000u);
}

}  // namespace
}  // namespace trapeze
#endif  // HWY_ONCE
