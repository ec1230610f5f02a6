/// Embree sees what brute force sees, but for what its own edges decide otherwise: the shares below are what
/// is allowed of that, twice to five times what is found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/simd/simd_limit.h"
#include "sample/frame_harness.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

const char* const kForms[] = {
    "embree",
    "embree:mode=1",
    "embree:mode=8",
    "embree:mode=16",
    "embree:mode=stream",
    "embree:geometry=quad",
    "embree:geometry=quad,mode=1",
    "embree:geometry=quad,mode=16",
    "embree:geometry=quad,mode=stream,quality=high",
    "embree:quality=low",
    "embree:geometry=quad,quality=low",
};

struct ResolvedByEmbree {
    HitBuffer hits;
    SampleStats stats;
    BuildStats build;
};

ResolvedByEmbree resolve(std::string_view name, const TestFrame& frame, const Grids& grids) {
    std::string error;
    const auto sampler = choose_sampler(name, "", &error);
    EXPECT_TRUE(sampler) << error;
    const auto pattern = sampler->make_pattern(frame.context);
    const auto visibility = sampler->prepare(frame.context, grids);
    SampleTile samples;
    pattern->make_tile({0, 0, frame.options.width, frame.options.height}, samples);
    ResolvedByEmbree resolved;
    SampleScratch scratch;
    visibility->resolve(samples, resolved.hits, scratch, resolved.stats);
    resolved.build = visibility->build_stats();
    EXPECT_EQ(resolved.hits.size(), samples.size());
    return resolved;
}

/// Wavy sheets at random places, of any number of rows and columns, ribbons among them.
void add_wavy_sheets(GridMaker& maker, int count, int keys, uint32_t seed) {
    std::mt19937 engine(seed);
    const auto noise = [&](float from, float to) {
        return std::uniform_real_distribution<float>(from, to)(engine);
    };
    const auto point = [&](float xy, float z_from, float z_to) {
        const float x = noise(-xy, xy), y = noise(-xy, xy);
        return V3f(x, y, noise(z_from, z_to));
    };
    for (int n = 0; n < count; ++n) {
        const V3f origin = point(3, 3, 9), along_u = point(2, -1, 1), along_v = point(2, -1, 1);
        const V3f shift = point(1, -0.5f, 0.5f), bend = point(1, -0.5f, 0.5f);
        const int nu = n % 5 == 0 ? 1 : 1 + static_cast<int>(engine() % 16);
        const int nv = n % 7 == 0 ? 1 : 1 + static_cast<int>(engine() % 16);
        maker.add(nu, nv, keys, [=](int i, int j, float t) {
            const float u = static_cast<float>(i) / static_cast<float>(nu),
                        v = static_cast<float>(j) / static_cast<float>(nv);
            const V3f p = origin + along_u * u + along_v * v + V3f(0, 0, 0.2f * std::sin(5 * u + 4 * v));
            return keys == 1 ? p : p + shift * t + bend * (t * t);
        });
    }
}

struct Difference {
    double depth = 0;         ///< share of samples that see nothing, or something, or another depth
    double grid = 0;          ///< share of the others that see another grid
    double micropolygon = 0;  ///< share of these that see another micropolygon
    double hits = 0;          ///< share of samples that see anything
};

Difference compare(const HitBuffer& truth, const HitBuffer& tested) {
    Difference d;
    double same_depth = 0, same_grid = 0;
    for (size_t s = 0; s < truth.size(); ++s) {
        d.hits += !truth.of(s).empty();
        if (truth.of(s).size() != tested.of(s).size()) {
            ++d.depth;
            continue;
        }
        if (truth.of(s).empty()) continue;
        const Hit a = truth.of(s).back(), b = tested.of(s).back();
        if (std::abs(a.depth - b.depth) > 1e-3f * a.depth) {
            ++d.depth;
            continue;
        }
        ++same_depth;
        const auto a_id = MicropolygonId::unpack(a.id), b_id = MicropolygonId::unpack(b.id);
        if (a_id.grid != b_id.grid)
            ++d.grid;
        else
            ++same_grid, d.micropolygon += a.id != b.id;
    }
    d.hits /= static_cast<double>(truth.size()), d.depth /= static_cast<double>(truth.size());
    d.grid /= same_depth, d.micropolygon /= same_grid;
    return d;
}

TEST(Embree, SeesWhatBruteForceSeesButForFewSamples) {
    struct Case {
        const char* name;
        std::vector<int> keys;
        bool defocus;
    };
    const Case cases[] = {{"static", {1}, false},
                          {"static, defocus", {1}, true},
                          {"motion", {2}, false},
                          {"motion of some, defocus", {1, 2, 5, 9}, true}};
    for (const Case& scene : cases) {
        const bool motion = scene.keys.back() > 1;
        const TestFrame frame(64, 48, 4, motion, scene.defocus);
        GridMaker maker;
        for (const int keys : scene.keys)
            add_wavy_sheets(maker, 32 / static_cast<int>(scene.keys.size()), keys,
                            100 + static_cast<uint32_t>(keys));
        const HitBuffer truth = resolve("bruteforce", frame, maker.grids()).hits;
        for (const char* form : kForms) {
            const ResolvedByEmbree tested = resolve(form, frame, maker.grids());
            const Difference d = compare(truth, tested.hits);
            EXPECT_GT(d.hits, 0.3);
            EXPECT_LT(d.depth, 0.001) << scene.name << ", " << form;
            EXPECT_LT(d.grid, 0.0002) << scene.name << ", " << form;
            EXPECT_LT(d.micropolygon, 0.0002) << scene.name << ", " << form;
            EXPECT_EQ(tested.stats.rays, truth.size());
        }
    }
}

/// A wall across the whole picture.
void add_wide_wall(GridMaker& maker, float z, int keys = 1) {
    maker.add(4, 4, keys, [=](int i, int j, float) {
        return V3f(200 * (static_cast<float>(i) / 4 - 0.5f), 200 * (static_cast<float>(j) / 4 - 0.5f), z);
    });
}

/// Grids, depths to a thousandth.
std::vector<std::pair<uint32_t, float>> layers(const HitBuffer& hits, size_t sample) {
    std::vector<std::pair<uint32_t, float>> found;
    for (const Hit& hit : hits.of(sample))
        found.emplace_back(MicropolygonId::unpack(hit.id).grid, std::round(hit.depth * 1000) / 1000);
    return found;
}

class EmbreeForm : public ::testing::TestWithParam<const char*> {};

TEST_P(EmbreeForm, SeesNothingInAnEmptyScene) {
    EXPECT_TRUE(resolve(GetParam(), TestFrame(16, 16, 2, false, false), Grids{}).hits.hits.empty());
}

TEST_P(EmbreeForm, ListsLayersOnceFrontToBackAsFarAsTheOpaqueOne) {
    GridMaker maker;
    maker.opaque = false;
    add_wide_wall(maker, 7);
    add_wide_wall(maker, 3, 2);
    add_wide_wall(maker, 2);
    maker.opaque = true;
    add_wide_wall(maker, 5);
    const HitBuffer hits = resolve(GetParam(), TestFrame(16, 16, 2, true, true), maker.grids()).hits;
    for (size_t s = 0; s < hits.size(); ++s)
        ASSERT_THAT(layers(hits, s), ::testing::ElementsAre(::testing::Pair(2, 2), ::testing::Pair(1, 3),
                                                            ::testing::Pair(3, 5)));
}

TEST_P(EmbreeForm, ListsLayersWhereNothingIsOpaque) {
    GridMaker maker;
    maker.opaque = false;
    for (int n = 0; n < 20; ++n) add_wide_wall(maker, 3 + 0.25f * static_cast<float>(n * 7 % 20));
    const HitBuffer hits = resolve(GetParam(), TestFrame(16, 16, 2, false, true), maker.grids()).hits;
    for (size_t s = 0; s < hits.size(); ++s) {
        const auto found = layers(hits, s);
        ASSERT_EQ(found.size(), 20u);
        for (size_t n = 0; n < 20; ++n) ASSERT_EQ(found[n].second, 3 + 0.25f * static_cast<float>(n));
    }
}

TEST_P(EmbreeForm, OneSidedGridsShowOneSide) {
    for (const bool opaque : {true, false}) {
        GridMaker maker;
        maker.opaque = opaque;
        maker.facing = Facing::PositiveOnly;
        add_wide_wall(maker, 5);
        maker.facing = Facing::NegativeOnly;
        add_wide_wall(maker, 4);
        const HitBuffer hits = resolve(GetParam(), TestFrame(16, 16, 2, false, false), maker.grids()).hits;
        for (size_t s = 0; s < hits.size(); ++s)
            ASSERT_THAT(layers(hits, s), ::testing::ElementsAre(::testing::Pair(0, 5)));
    }
}

TEST_P(EmbreeForm, ClipsByDepth) {
    GridMaker maker;
    add_wide_wall(maker, 2);
    add_wide_wall(maker, 50);
    TestFrame frame(16, 16, 2, false, false);
    frame.options.near_clip = 2.1f, frame.options.far_clip = 49;
    frame.update();
    EXPECT_TRUE(resolve(GetParam(), frame, maker.grids()).hits.hits.empty());
    frame.options.near_clip = 1.9f;
    frame.update();
    EXPECT_THAT(layers(resolve(GetParam(), frame, maker.grids()).hits, 0),
                ::testing::ElementsAre(::testing::Pair(0, 2)));
    frame.options.near_clip = 2.1f, frame.options.far_clip = 51;
    frame.update();
    EXPECT_THAT(layers(resolve(GetParam(), frame, maker.grids()).hits, 0),
                ::testing::ElementsAre(::testing::Pair(1, 50)));
}

TEST_P(EmbreeForm, SaysWhatItsTreeTakesAndWhatWasCopied) {
    GridMaker few, many;
    add_wavy_sheets(few, 10, 2, 1);
    add_wavy_sheets(many, 1000, 2, 1);
    const TestFrame frame(16, 16, 1, true, false);
    const BuildStats a = resolve(GetParam(), frame, few.grids()).build,
                     b = resolve(GetParam(), frame, many.grids()).build;
    EXPECT_GT(a.tree_bytes, few.grids().micropolygon_count());
    EXPECT_GT(b.tree_bytes, 20 * a.tree_bytes);
    EXPECT_GT(a.setup_seconds, 0);
    EXPECT_LT(a.setup_seconds, 60);
}

TEST_P(EmbreeForm, RunsOnAnyInstructionSet) {
    GridMaker maker;
    add_wavy_sheets(maker, 40, 1, 5);
    const TestFrame frame(64, 48, 2, false, true);
    const HitBuffer truth = resolve("bruteforce", frame, maker.grids()).hits;
    std::string error;
    for (const std::string_view limit : simd_names()) {
        if (!limit_simd(limit, &error)) continue;
        EXPECT_LT(compare(truth, resolve(GetParam(), frame, maker.grids()).hits).depth, 0.002) << limit;
    }
    limit_simd("best", &error);
}

INSTANTIATE_TEST_SUITE_P(Table, EmbreeForm, ::testing::ValuesIn(kForms), [](const auto& tested) {
    std::string name(tested.param);
    std::erase_if(name, [](char c) { return !std::isalnum(c); });
    return name;
});

}  // namespace
}  // namespace trapeze
