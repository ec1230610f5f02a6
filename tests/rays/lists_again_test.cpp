/// Lists of subpatches that do not fit are made again when they are asked for: the same subpatches, and the
/// same grids, bit for bit.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>

#include "tessellate/tessellate.h"
#include "tests/rays/ray_world_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// A scene of the project, of which rays see all.
struct SceneForLists {
    Diagnostics diagnostics;
    RenderSettings settings;
    std::vector<Scene> worlds;

    explicit SceneForLists(const std::string& path) {
        const WorkFolder folder;
        folder.write("seen.rib", kSeen);
        const std::vector<std::string> files{(folder / "seen.rib").string(), path};
        read_rib(files, ReadOptions{}, diagnostics,
                 [&](Scene&& scene) { worlds.push_back(std::move(scene)); });
    }
};

void expect_same(const ShadingGrid& a, const ShadingGrid& b) {
    ASSERT_EQ(a.primitive_index, b.primitive_index);
    ASSERT_EQ(a.ordinal, b.ordinal);
    ASSERT_EQ(a.seed, b.seed);
    ASSERT_EQ(a.key_count, b.key_count);
    ASSERT_TRUE(a.shape == b.shape);
    ASSERT_EQ(a.P.size(), b.P.size());
    for (size_t key = 0; key < a.P.size(); ++key) ASSERT_EQ(a.P[key].c, b.P[key].c);
    ASSERT_EQ(a.N.c, b.N.c);
    ASSERT_EQ(a.dPdu.c, b.dPdu.c);
    ASSERT_EQ(a.u, b.u);
    ASSERT_EQ(a.v, b.v);
    ASSERT_EQ(a.s, b.s);
}

/// Every subpatch of both, and a place of it; in an order that asks for blocks again and again.
void expect_same(const Tessellation& whole, const Tessellation& again) {
    ASSERT_EQ(whole.subpatch_count(), again.subpatch_count());
    EXPECT_EQ(whole.stats().micropolygons, again.stats().micropolygons);
    EXPECT_EQ(whole.stats().culled_subpatches, again.stats().culled_subpatches);
    constexpr size_t kParts = 7;
    tbb::parallel_for(size_t{0}, kParts, [&](size_t part) {
        DiceScratch of_whole, of_again;
        ShadingGrid a, b;
        for (size_t i = part; i < whole.subpatch_count(); i += kParts) {
            ASSERT_EQ(whole.primitive_of(i), again.primitive_of(i));
            ASSERT_EQ(whole.end_of_primitive(i), again.end_of_primitive(i));
            ASSERT_TRUE(whole.shape_of(i) == again.shape_of(i));
            whole.dice(i, a, of_whole), again.dice(i, b, of_again);
            expect_same(a, b);
            const SubpatchPoint place{i, {.3f, .01f}, {}};
            ASSERT_EQ(whole.dice_point(place, a, of_whole), again.dice_point(place, b, of_again));
            a.seed = b.seed = 0;
            expect_same(a, b);
        }
    });
}

/// All kinds of primitives, moving and still, as rays would have them with half the memory and a tenth, and
/// as the camera would with half.
TEST(ListsAgain, HaveTheSameSubpatches) {
    size_t made_again = 0, compared = 0, too_small = 0;
    for (const std::string& file : tiny_scenes()) {
        SCOPED_TRACE(file);
        SceneForLists read(tiny_scene_path(file));
        for (const Scene& scene : read.worlds)
            for (const SeenBy seen_by : {SeenBy::Rays, SeenBy::Camera}) {
                const RenderContext context = make_context(scene, read.settings, read.diagnostics);
                TessellationOptions options;
                options.seen_by = seen_by;
                const Tessellation whole(context, options);
                EXPECT_FALSE(whole.makes_lists_again());
                options.lists_again = true;
                for (const size_t part : {2, 10}) {
                    if (part == 10 && seen_by == SeenBy::Camera) continue;
                    options.most_bytes = whole.bytes() / part;
                    const auto errors = read.diagnostics.count(Severity::Error);
                    const Tessellation again(context, options);
                    // Edges and vertices alone may not fit.
                    const bool has_too_much = read.diagnostics.count(Severity::Error) > errors;
                    ++(has_too_much ? too_small : compared);
                    if (has_too_much) continue;
                    made_again += again.makes_lists_again() ? again.subpatch_count() : 0;
                    ASSERT_NO_FATAL_FAILURE(expect_same(whole, again));
                }
            }
    }
    EXPECT_GT(made_again, 10000u);
    EXPECT_GT(compared, 200u);
    EXPECT_LT(too_small, compared);
}

/// A ball next to the eye: its few faces have thousands of subpatches, of which a small part is held.
TEST(ListsAgain, OfLargeFacesAreHeldInParts) {
    const RayWorldScene scene("Translate 0 0 4 ShadingRate .1 Sphere .9 -.9 .9 360 ");
    TessellationOptions options;
    options.seen_by = SeenBy::Rays;
    const Tessellation whole(scene.context(), options);
    ASSERT_GT(whole.subpatch_count(), 5000u);
    options.lists_again = true, options.most_bytes = whole.bytes() / 6;
    const Tessellation again(scene.context(), options);
    ASSERT_TRUE(again.makes_lists_again());
    EXPECT_TRUE(again.subpatches().empty());
    ASSERT_NO_FATAL_FAILURE(expect_same(whole, again));
    EXPECT_LE(again.bytes(), options.most_bytes);
}

/// A face that wants more than is good for it is listed as a whole: where it is halved depends on how much of
/// it there is already.
TEST(ListsAgain, OfLimitedFacesAreWhole) {
    const RayWorldScene scene("Translate 0 0 4 ShadingRate .001 Sphere .9 -.9 .9 360 Sphere .4 -.4 .4 360 ",
                              "");
    TessellationOptions options;
    options.seen_by = SeenBy::Rays;
    const Tessellation whole(scene.context(), options);
    options.lists_again = true, options.most_bytes = 2 * whole.bytes();
    const Tessellation again(scene.context(), options);
    ASSERT_TRUE(again.makes_lists_again());
    ASSERT_NO_FATAL_FAILURE(expect_same(whole, again));
}

/// Which lists are kept may depend on the threads; what is left out does not.
TEST(ListsAgain, LeaveOutTheSameWithAnyThreads) {
    std::string things = "Translate 0 0 4 ";
    for (int i = 0; i < 24; ++i)
        things += "Translate .01 0 0 ShadingRate " + std::to_string(i % 3 == 0 ? .2 : 4) +
                  " Sphere .9 -.9 .9 360 Torus .5 .2 0 360 360 ";
    const RayWorldScene scene(things, "");
    Diagnostics said;
    RenderContext context = scene.context();
    context.diagnostics = &said;
    TessellationOptions options;
    options.seen_by = SeenBy::Rays;
    const size_t all = Tessellation(context, options).bytes();
    options.lists_again = true;
    for (size_t part = 2; part < 400; part = part * 5 / 4 + 1) {
        options.most_bytes = all / part;
        std::optional<size_t> count;
        for (const int threads : {1, 2, 4, 4}) {
            tbb::task_arena arena(threads);
            arena.execute([&] {
                const Tessellation made(context, options);
                EXPECT_EQ(count.value_or(made.subpatch_count()), made.subpatch_count()) << part;
                count = made.subpatch_count();
            });
        }
    }
}

/// What edges and vertices alone take has to fit.
TEST(ListsAgain, LeaveOutWhatHasTooManyEdges) {
    const RayWorldScene scene("Translate 0 0 4 Sphere .9 -.9 .9 360 ");
    Diagnostics said;
    RenderContext context = scene.context();
    context.diagnostics = &said;
    TessellationOptions options;
    options.seen_by = SeenBy::Rays, options.lists_again = true, options.most_bytes = 16;
    const Tessellation again(context, options);
    EXPECT_EQ(again.subpatch_count(), 0u);
    EXPECT_EQ(said.count(Severity::Error), 1);
}

}  // namespace
}  // namespace trapeze::testing
