/// Layers in passes: however few of them a method is asked for at a time, and however little room it has, the
/// passes together find what one pass finds that is asked for all.
#include <gtest/gtest.h>

#include <random>

#include "core/scene/scene.h"
#include "core/simd/targets_harness.h"
#include "sample/frame_harness.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::for_each_target;
using testing::GridMaker;
using testing::TestFrame;

/// Sheets that samples see through, across the picture, tilted and moving; each fourth is there twice, so
/// that depths are equal, and a few are opaque.
GridMaker sheets(int count, bool motion) {
    GridMaker maker;
    std::mt19937 engine(5);
    const auto noise = [&engine](float size) {
        return std::uniform_real_distribution<float>(-size, size)(engine);
    };
    for (int n = 0; n < count; ++n) {
        const float z = 5 + noise(2), tilt_x = noise(0.5f), tilt_y = noise(0.5f), move = noise(1);
        const float half = n % 3 == 0 ? 6 : 2;
        const V3f centre(n % 3 == 0 ? 0 : noise(2), n % 3 == 0 ? 0 : noise(2), z);
        maker.opaque = n % 10 == 9;
        for (int twice = 0; twice < (n % 4 == 0 ? 2 : 1); ++twice)
            maker.add(8, 5, motion ? 2 : 1, [=](int i, int j, float t) {
                const float u = half * (static_cast<float>(i) / 4 - 1),
                            v = half * (static_cast<float>(j) / 2.5f - 1);
                return centre + V3f(u + move * t, v, u * tilt_x + v * tilt_y + move * t);
            });
    }
    return maker;
}

/// A method, a tile of a frame, and the lists of all samples.
class Tile {
  public:
    Tile(const char* method, const char* pattern, const TestFrame& frame, const Grids& grids) {
        std::string error;
        const auto sampler = choose_sampler(method, pattern, &error);
        EXPECT_TRUE(sampler) << error;
        sampler->make_pattern(frame.context)->make_tile({0, 0, 16, 16}, samples_);
        visibility_ = sampler->prepare(frame.context, grids);
    }

    std::vector<std::vector<Hit>> whole_lists() {
        scratch_.window = {};
        visibility_->resolve(samples_, hits_, scratch_, stats_);
        EXPECT_FALSE(scratch_.found.is_cut());
        std::vector<std::vector<Hit>> lists(samples_.size());
        add_to(lists);
        return lists;
    }

    /// As many passes as it takes, of some samples at a time.
    std::vector<std::vector<Hit>> lists_in_passes(uint32_t most, size_t room, size_t group) {
        std::vector<std::vector<Hit>> lists(samples_.size());
        for (size_t begin = 0; begin < samples_.size(); begin += group) {
            std::vector<Hit> behind(samples_.size(), kBehindAll);
            std::fill_n(behind.begin() + static_cast<std::ptrdiff_t>(begin),
                        std::min(group, samples_.size() - begin), kInFrontOfAll);
            for (bool more = true; more;) {
                scratch_.window = {behind, most, room};
                visibility_->resolve(samples_, hits_, scratch_, stats_);
                add_to(lists);
                more = false;
                for (size_t s = 0; s < samples_.size(); ++s) {
                    EXPECT_LE(hits_.of(s).size(), most);
                    behind[s] = scratch_.found.cut_at(s);
                    if (behind[s] == kBehindAll) continue;
                    more = true;
                    // A list that is cut has come on: else passes would never end.
                    EXPECT_FALSE(hits_.of(s).empty());
                    if (hits_.of(s).empty()) return lists;
                    EXPECT_EQ(hits_.of(s).back(), behind[s]);
                }
                most_bytes_ = std::max(most_bytes_, scratch_.found.bytes());
                ++passes_;
            }
        }
        return lists;
    }

    size_t sample_count() const { return samples_.size(); }
    size_t most_bytes() const { return most_bytes_; }
    int passes() const { return passes_; }

  private:
    void add_to(std::vector<std::vector<Hit>>& lists) const {
        for (size_t s = 0; s < lists.size(); ++s)
            lists[s].insert(lists[s].end(), hits_.of(s).begin(), hits_.of(s).end());
    }

    SampleTile samples_;
    std::unique_ptr<Visibility> visibility_;
    HitBuffer hits_;
    SampleScratch scratch_;
    SampleStats stats_;
    size_t most_bytes_ = 0;
    int passes_ = 0;
};

struct Case {
    const char *method, *pattern;
};

class LayerWindows : public ::testing::TestWithParam<Case> {
  protected:
    static void expect_agreement(const TestFrame& frame, const Grids& grids, uint32_t most, size_t room,
                                 size_t group) {
        const auto truth = Tile("bruteforce", GetParam().pattern, frame, grids).whole_lists();
        Tile tile(GetParam().method, GetParam().pattern, frame, grids);
        EXPECT_TRUE(tile.lists_in_passes(most, room, group) == truth)
            << most << " layers, room for " << room << ", groups of " << group;
    }
};

TEST_P(LayerWindows, TogetherFindWhatBruteForceFinds) {
    const GridMaker maker = sheets(60, true);
    const Grids& grids = maker.grids();
    const TestFrame frame(16, 16, 2, true, true);
    constexpr size_t kAll = size_t{1} << 40;
    for (const uint32_t most : {1u, 5u, 40u}) expect_agreement(frame, grids, most, kAll, kAll);
    for (const size_t room : {size_t{1}, size_t{2500}})
        expect_agreement(frame, grids, kAllLayers, room, kAll);
    expect_agreement(frame, grids, 5, 500, 100);
}

TEST_P(LayerWindows, FindStillThingsThroughAPinhole) {
    const GridMaker maker = sheets(60, false);
    const Grids& grids = maker.grids();
    const TestFrame frame(16, 16, 3, false, false);
    for_each_target([&] {
        expect_agreement(frame, grids, 2, 1000, 700);
        expect_agreement(frame, grids, kAllLayers, 5000, size_t{1} << 20);
    });
}

/// Where a list begins in a solid follows from what lies in front of it and behind.
TEST_P(LayerWindows, FindWhatIsLeftOfSolids) {
    GridMaker maker = sheets(60, true);
    Grids& grids = maker.grids();
    TestFrame frame(16, 16, 1, true, true);
    Scene scene;
    using Operation = Solid::Operation;
    scene.solids = {{Operation::Difference, -1, 0},
                    {Operation::Primitive, 0, 0},
                    {Operation::Union, 0, 1},
                    {Operation::Primitive, 2, 0},
                    {Operation::Primitive, 2, 1}};
    for (const int solid : {1, 3, 4, -1}) {
        Attributes attributes;
        attributes.sides = solid == 3 ? 1 : 2;
        Primitive& primitive = scene.primitives.emplace_back();
        primitive.solid = solid;
        primitive.attributes = std::make_shared<const Attributes>(attributes);
        primitive.camera_from_object = {M44f()};
    }
    scene.clipping_planes.push_back({V3f(0, 0.1f, 1), 3.5f});
    for (size_t i = 0; i < grids.grids.size(); ++i) {
        grids.grids[i].primitive = static_cast<uint32_t>(i % scene.primitives.size());
        if (scene.primitives[grids.grids[i].primitive].solid >= 0) grids.grids[i].opaque = false;
    }
    frame.context.scene = &scene;
    constexpr size_t kAll = size_t{1} << 40;
    expect_agreement(frame, grids, 3, kAll, kAll);
    expect_agreement(frame, grids, kAllLayers, 5000, kAll);
    expect_agreement(frame, grids, 5, 2000, 100);
    // Lists that are longer than the room, each for itself.
    if (std::string_view(GetParam().method).starts_with("raytrace")) expect_agreement(frame, grids, 5, 20, 2);
}

TEST_P(LayerWindows, KeepToTheirRoom) {
    const GridMaker maker = sheets(300, true);
    const TestFrame frame(16, 16, 2, true, false);
    Tile tile(GetParam().method, GetParam().pattern, frame, maker.grids());
    const size_t room = 4 * tile.sample_count();
    tile.lists_in_passes(kAllLayers, room, size_t{1} << 20);
    EXPECT_GT(tile.passes(), 5);
    EXPECT_LE(tile.most_bytes(), room * sizeof(LooseHits::Entry));
}

INSTANTIATE_TEST_SUITE_P(All, LayerWindows,
                         ::testing::Values(Case{"bruteforce", "stratified"}, Case{"raytrace", "stratified"},
                                           Case{"raytrace:tree=paper", "stratified"},
                                           Case{"raytrace:tree=paper,bundle=off,split=sah", "stratified"},
                                           Case{"interval", "interval"},
                                           Case{"interval:pairing=shuffled,cull=on", "stratified"},
                                           Case{"interleaveuvt", "interleaved"},
                                           Case{"interleaveuvt:cull=on", "interleaved"},
                                           Case{"dualspace", "stratified"}),
                         [](const ::testing::TestParamInfo<Case>& tested) {
                             std::string name = tested.param.method;
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                             return name;
                         });

}  // namespace
}  // namespace trapeze
