/// Rays of shaders find what testing every micropolygon finds, bit for bit: of every kind, whatever moves, on
/// all levels, in instances, and whether all is in memory or made as rays come by.
#include "tests/rays/every_micropolygon_harness.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/rays/herd_harness.h"

namespace trapeze::testing {
namespace {

constexpr RayKind kKinds[] = {RayKind::Diffuse, RayKind::Specular, RayKind::Transmission};

/// Attributes of the i-th thing: each set of kinds of rays sees some, some are seen from outside alone, some
/// let light through. The 6th is seen by all, from both sides, and opaque.
std::string attributes_of(size_t i) {
    const size_t kinds = i % 7 + 1;
    return "Attribute \"visibility\" \"int diffuse\" " + std::to_string(kinds & 1) + " \"int specular\" " +
           std::to_string(kinds >> 1 & 1) + " \"int transmission\" " + std::to_string(kinds >> 2) + ' ' +
           (i % 3 == 1   ? "Opacity .5 .5 .5 "
            : i % 5 == 2 ? "Sides 1 "
                         : "");
}

/// A patch that bends where it moves, about as large as 1.
std::string bent_patch(const V3f& at, float bend) {
    std::string patch = "Patch \"bilinear\" \"P\" [";
    for (int k = 0; k < 4; ++k)
        patch += text(at + V3f(k & 1 ? .8f : -.8f, k & 2 ? .6f : -.6f,
                               (k == 3 ? .5f : -.2f) + bend * static_cast<float>(k)));
    return patch + "] ";
}

/// Balls and pairs of patches about a middle.
std::string things_about(const V3f& middle, float reach, size_t count, bool moves) {
    RayNumbers number;
    std::string things;
    for (size_t i = 0; i < count; ++i) {
        const V3f at = middle + number.in_cube(reach), way = number.in_cube(reach / 2);
        things += "AttributeBegin ";
        if (i % 2 == 0) {
            const std::string place = "Translate " + text(at);
            things +=
                moves ? "MotionBegin [0 1] " + place + "Translate " + text(at + way) + "MotionEnd " : place;
            things += attributes_of(i) + "Sphere .6 -.6 .5 360 ";
        } else {
            const std::string patch = moves ? "MotionBegin [0 .5 1] " + bent_patch(at, 0) +
                                                  bent_patch(at + way, .3f) +
                                                  bent_patch(at + way * 1.5f, -.2f) + "MotionEnd "
                                            : bent_patch(at, .1f);
            // Twice in one place: of one side each, back to back, or for all rays and for some.
            const std::string own = attributes_of(i), of_all = attributes_of(6);
            things += i % 4 == 1 ? own + "Sides 1 " + patch + of_all + "Sides 1 ReverseOrientation " + patch
                                 : of_all + "Sides 2 " + patch + own + "Sides 2 " + patch;
        }
        things += "AttributeEnd ";
    }
    return things;
}

RaySegment some_ray(RayNumbers& number, const EveryMicropolygon& all, const V3f& middle, float reach, int i) {
    const float time = i % 9 == 0 ? 0 : i % 9 == 1 ? 1 : number(0, 1);
    const V3f from = middle + number.in_cube((i % 5 == 3 ? 20 : 1.5f) * reach);
    V3f target = middle + number.in_cube(reach);
    if (i % 4 == 0) target = all.some_vertex(number, time);
    if (i % 16 == 2) target = from + V3f(0, number(-1, 1), 0);
    RaySegment ray = ray_to(from, target - from, i % 3 == 0 ? 0 : number(0, .5f));
    ray.time = time;
    if (i % 5 == 0) ray.max = number(0, 2 * reach);
    if (i % 7 == 0) ray.min = number(0, reach);
    if (i % 6 == 0) ray.left = {number(0, reach), .1f, number.in_cube(1).normalized()};
    return ray;
}

struct Tally {
    int hits = 0, open = 0, closed = 0, unsure = 0, of_level[kMostRayLevels] = {};
};

void expect_same(const std::optional<RaySurfaceHit>& hit, const std::optional<FoundHit>& truth, size_t ray) {
    ASSERT_EQ(hit.has_value(), truth.has_value()) << ray;
    if (!hit) return;
    ASSERT_EQ(hit->distance, truth->distance) << ray;
    ASSERT_EQ(hit->primitive, truth->primitive) << ray;
    ASSERT_EQ(hit->place.id, truth->id) << ray;
    ASSERT_EQ(hit->level, truth->level) << ray;
}

/// Each ray alone, in memory and in bricks, and all together.
void expect_truth(const EveryMicropolygon& all, const RayWorld& whole, const RayWorld& bricks,
                  const std::vector<RaySegment>& rays, RayKind kind, Tally& tally) {
    std::vector<const RaySegment*> asked;
    for (const RaySegment& ray : rays) asked.push_back(&ray);
    std::vector<std::optional<RaySurfaceHit>> together(rays.size()), together_whole(rays.size());
    std::vector<std::optional<bool>> blocked(rays.size()), blocked_whole(rays.size());
    bricks.closest(asked, kind, together);
    whole.closest(asked, kind, together_whole);
    bricks.blocked(asked, kind, blocked);
    whole.blocked(asked, kind, blocked_whole);
    for (size_t i = 0; i < rays.size(); ++i) {
        const auto [truth, is_blocked] = all.answer(rays[i], kind);
        for (const auto& hit :
             {whole.closest(rays[i], kind), bricks.closest(rays[i], kind), together[i], together_whole[i]}) {
            expect_same(hit, truth, i);
            if (::testing::Test::HasFatalFailure()) return;
        }
        for (const auto& answer :
             {whole.blocked(rays[i], kind), bricks.blocked(rays[i], kind), blocked[i], blocked_whole[i]})
            ASSERT_EQ(answer, is_blocked) << i;
        tally.hits += truth.has_value();
        if (truth) ++tally.of_level[truth->level];
        tally.open += is_blocked == false, tally.closed += is_blocked == true, tally.unsure += !is_blocked;
    }
}

/// Rays about a middle; with so many bytes bricks are made.
Tally expect_what_testing_all_finds(const std::string& things, const std::string& options, const V3f& middle,
                                    float reach, int ray_count, size_t places = 0) {
    constexpr size_t kFewBytes = size_t{1} << 17;
    const RayWorldScene whole(things, options), bricks(things, options, kFewBytes);
    EXPECT_EQ(whole.world().rays_at_once(), 0u);
    EXPECT_GT(bricks.world().rays_at_once(), 0u);
    const EveryMicropolygon all(whole);
    EXPECT_EQ(all.places(), places);
    EXPECT_EQ(all.micropolygons(), whole.world().micropolygon_count());
    EXPECT_EQ(all.micropolygons(), bricks.world().micropolygon_count());
    RayNumbers number;
    std::vector<RaySegment> rays;
    for (int i = 0; i < ray_count; ++i) rays.push_back(some_ray(number, all, middle, reach, i));
    Tally tally;
    for (const RayKind kind : kKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        expect_truth(all, whole.world(), bricks.world(), rays, kind, tally);
    }
    for (const int count : {tally.hits, tally.open, tally.closed, tally.unsure})
        EXPECT_GT(count, ray_count / 8);
    return tally;
}

const std::string kMoves = "Shutter 0 1 ";
const std::string kMovesForRays = "Attribute \"trace\" \"int samplemotion\" 1 ";
const V3f kFarAway(0, 0, 20);

/// The first of two patches in one place does not count for half of the rays, which meet the second.
TEST(RaysAgainstEveryMicropolygon, OneSidedPatchesBackToBackAreBothMet) {
    const std::string patch = bent_patch(V3f(0), 0);
    const RayWorldScene scene("Sides 1 " + patch + "ReverseOrientation " + patch, "Format 64 64 1 ");
    std::array<int, 2> met{};
    for (const float side : {-1.0f, 1.0f}) {
        RayNumbers number;
        for (int i = 0; i < 1000; ++i) {
            const V3f from(number(-.3f, .3f), number(-.3f, .3f), side * number(2, 3));
            const V3f target(number(-.5f, .5f), number(-.4f, .4f), 0);
            const auto hit = scene.world().closest(ray_to(from, target - from, 0), RayKind::Diffuse);
            ASSERT_TRUE(hit) << i;
            ++met[hit->primitive];
        }
    }
    EXPECT_GT(met[0], 500);
    EXPECT_GT(met[1], 500);
}

TEST(RaysAgainstEveryMicropolygon, FindTheSameInStillAndMovingThings) {
    for (const bool moves : {false, true})
        expect_what_testing_all_finds(
            "ShadingRate 8 " + (moves ? kMovesForRays : "") + things_about(V3f(0), 2, 14, moves),
            kMoves + "Format 64 64 1 ", V3f(0), 2, 150);
}

/// Instances near a middle, of so many looks; two of them are in one place.
std::string balls_about(const V3f& middle, int count, size_t looks, bool moves) {
    Herd herd(count);
    for (V3f& place : herd.places) place = middle + (place - kFarAway) * .25f;
    herd.places[4] = herd.places[1];
    return kBallObject + herd.with("Rotate 30 1 2 3 ObjectInstance 1", [&](size_t i) {
        const std::string way = "Translate " + text(V3f(.3f, .2f * static_cast<float>(i % 2), -.2f));
        return attributes_of(6 + 3 * (i % looks)) +
               (moves ? "MotionBegin [0 1] Translate 0 0 0 " + way + "MotionEnd " : "");
    });
}

TEST(RaysAgainstEveryMicropolygon, FindTheSameOnAllLevels) {
    for (const bool moves : {false, true}) {
        const Tally tally =
            expect_what_testing_all_finds((moves ? kMovesForRays : "") + things_about(kFarAway, 2, 5, moves) +
                                              balls_about(kFarAway, 5, 1, moves),
                                          kMoves + kLevels + kPerspectiveView, kFarAway, 2, 70, 5);
        EXPECT_GT(tally.of_level[0], 20);
        EXPECT_GT(tally.of_level[1], 10);
        EXPECT_GT(tally.of_level[2], 0);
    }
}

TEST(RaysAgainstEveryMicropolygon, FindTheSameInInstances) {
    for (const bool moves : {false, true})
        expect_what_testing_all_finds((moves ? kMovesForRays : "") + "ShadingRate 9 " +
                                          balls_about(kFarAway, 15, 3, moves) + "ShadingRate 30 " +
                                          things_about(kFarAway, 2, 4, moves),
                                      kMoves + kPerspectiveView, kFarAway, 2, 150, 15);
}

}  // namespace
}  // namespace trapeze::testing
