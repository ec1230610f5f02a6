#include "composite/film/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "composite/film/raster_harness.h"

namespace trapeze {
namespace {

using testing::add_grids;
using testing::GridLook;
using testing::make_hits;
using testing::make_samples;
using testing::RasterScene;
using testing::tiles_of;

constexpr int kColumns = 4, kRows = 3;  // grids; the picture is 64x48

/// A picture with edges inside pixels, empty parts and colours that are no round numbers.
Grids busy_grids() {
    GridLook look;
    look.color = [](int x, int y) {
        const auto channel = [&](uint32_t c) {
            return unit_float(hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), c));
        };
        return V3f(channel(0), channel(1), channel(2));
    };
    look.depth = 5;
    look.primitive = 3;
    Grids grids;
    add_grids(grids, kColumns, kRows, look);
    return grids;
}

/// The same, with its colours (and a float) as output variables besides.
Grids busy_grids_with_variables(RasterScene& scene) {
    scene.scene.options.displays = {testing::aov_display("Ci", ValueType::Color),
                                    testing::aov_display("foo", ValueType::Float)};
    const Grids plain = busy_grids();
    GridLook look;
    look.color = [&](int x, int y) {
        const int column = std::min(x / kMaxGridSide, kColumns - 1),
                  row = std::min(y / kMaxGridSide, kRows - 1);
        return plain.grids[row * kColumns + column].color(x - column * kMaxGridSide, y - row * kMaxGridSide);
    };
    look.aov_channels = 4;
    look.aov = [&](int x, int y, int channel) { return channel < 3 ? look.color(x, y)[channel] : 1000; };
    look.depth = 5;
    look.primitive = 3;
    Grids grids;
    add_grids(grids, kColumns, kRows, look);
    return grids;
}

bool in_blob(float x, float y) {
    return std::hypot(x - 30, y - 20) < 17.3f || x > 55.5f;
}

void add_tile(const RasterScene& scene, const Grids& grids, const PixelRect& pixels, Film& film,
              const std::function<bool(float, float)>& covers = in_blob) {
    const SampleTile samples = make_samples(scene, pixels);
    film.add(samples, make_hits(samples, grids, kColumns, kRows, covers), grids);
}

Image render(const RasterScene& scene, const Grids& grids,
             const std::function<bool(float, float)>& covers = in_blob) {
    Film film(scene.context, true);
    for (const PixelRect& tile : tiles_of(scene.sampled())) add_tile(scene, grids, tile, film, covers);
    EXPECT_EQ(film.waiting_bytes(), 0u);
    return film.finish();
}

Grids constant_grids(V3f color) {
    GridLook look;
    look.color = [color](int, int) { return color; };
    Grids grids;
    add_grids(grids, kColumns, kRows, look);
    return grids;
}

TEST(Film, SameBitsForAnyOrderOfTiles) {
    for (const auto& [name, width] : {std::pair{"gaussian", 2.0f}, {"catmull-rom", 4.0f}, {"sinc", 40.0f}}) {
        RasterScene scene(64, 48, 3);
        scene.scene.options.filter = {name, width, width};
        const Grids grids = busy_grids();
        const Image expected = render(scene, grids);
        std::vector<PixelRect> tiles = tiles_of(scene.sampled());
        for (uint32_t seed = 0; seed < 3; ++seed) {
            for (size_t i = tiles.size(); i > 1; --i)
                std::swap(tiles[i - 1], tiles[hash(seed, static_cast<uint32_t>(i)) % i]);
            Film film(scene.context, true);
            for (const PixelRect& tile : tiles) add_tile(scene, grids, tile, film);
            EXPECT_TRUE(film.finish() == expected) << name;
        }
    }
}

TEST(Film, OutputVariablesAreFilteredAsColourIs) {
    for (const auto& [name, width] : {std::pair{"gaussian", 2.0f}, {"mitchell", 4.0f}, {"disk", 3.3f}}) {
        RasterScene scene(64, 48, 3);
        scene.scene.options.filter = {name, width, width};
        scene.scene.options.exposure_gain = 2;  // not theirs
        const Image plain = render(scene, busy_grids());
        const Image image = render(scene, busy_grids_with_variables(scene));
        ASSERT_EQ(image.aov_channels, 4);
        ASSERT_EQ(image.aovs.size(), image.rgba.size());
        EXPECT_EQ(image.rgba, plain.rgba);
        EXPECT_EQ(image.z, plain.z);
        EXPECT_TRUE(plain.aovs.empty());
        for (size_t i = 0; i < image.aovs.size(); ++i) {
            if (i % 4 < 3)
                ASSERT_NEAR(2 * image.aovs[i], image.rgba[i], 1e-5f) << name << i;
            else
                ASSERT_NEAR(image.aovs[i], 1000 * image.rgba[i], 1e-2f) << name << i;
        }
    }
}

TEST(Film, OutputVariablesHaveTheSameBitsForAnyOrderAndAnyCrop) {
    RasterScene scene(64, 48, 3);
    const Grids grids = busy_grids_with_variables(scene);
    const Image whole = render(scene, grids);
    std::vector<PixelRect> tiles = tiles_of(scene.sampled());
    std::reverse(tiles.begin(), tiles.end());
    std::swap(tiles[1], tiles[tiles.size() / 2]);
    Film film(scene.context, true);
    for (const PixelRect& tile : tiles) add_tile(scene, grids, tile, film);
    EXPECT_TRUE(film.finish() == whole);

    scene.scene.options.crop_window = {0.3f, 0.72f, 0.1f, 0.9f};
    scene.update();
    const Image crop = render(scene, grids);
    for (int y = crop.window.y0; y < crop.window.y1; ++y)
        for (int x = crop.window.x0; x < crop.window.x1; ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(crop.aovs[4 * crop.index(x, y) + c], whole.aovs[4 * whole.index(x, y) + c]);
}

TEST(Film, SameBitsForAnyNumberOfThreads) {
    RasterScene scene(64, 48, 3);
    const Grids grids = busy_grids_with_variables(scene);
    const Image expected = render(scene, grids);
    const std::vector<PixelRect> tiles = tiles_of(scene.sampled());
    for (const size_t count : {2u, 7u}) {
        Film film(scene.context, true);
        std::atomic<size_t> next{0};
        std::vector<std::thread> threads;
        for (size_t t = 0; t < count; ++t)
            threads.emplace_back([&] {
                for (size_t i; (i = next.fetch_add(1)) < tiles.size();)
                    add_tile(scene, grids, tiles[i], film);
            });
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(film.waiting_bytes(), 0u);
        EXPECT_TRUE(film.finish() == expected);
    }
}

TEST(Film, ACropEqualsThePixelsOfTheWholePicture) {
    for (const auto& [name, width] :
         {std::pair{"gaussian", 2.0f}, {"box", 1.0f}, {"mitchell", 4.0f}, {"disk", 3.3f}}) {
        RasterScene scene(64, 48, 2);
        scene.scene.options.filter = {name, width, width + 1};
        const Grids grids = busy_grids();
        const Image whole = render(scene, grids);
        for (const std::array<float, 4>& window :
             {std::array{0.3f, 0.72f, 0.1f, 0.9f}, {0.0f, 1.0f, 0.4f, 0.42f}, {0.26f, 0.5f, 0.0f, 1.0f}}) {
            scene.scene.options.crop_window = window;
            scene.update();
            const Image crop = render(scene, grids);
            EXPECT_EQ(crop.window, scene.context.camera.crop);
            for (int y = crop.window.y0; y < crop.window.y1; ++y)
                for (int x = crop.window.x0; x < crop.window.x1; ++x) {
                    const size_t a = crop.index(x, y), b = whole.index(x, y);
                    for (int c = 0; c < 4; ++c)
                        ASSERT_EQ(crop.rgba[4 * a + c], whole.rgba[4 * b + c]) << name << x << "," << y;
                    ASSERT_EQ(crop.z[a], whole.z[b]);
                    ASSERT_EQ(crop.id[a], whole.id[b]);
                }
        }
        scene.scene.options.crop_window = {0, 1, 0, 1};
    }
}

TEST(Film, AConstantStaysConstantAndOpaqueStaysExactlyOpaque) {
    const Grids grids = constant_grids({0.25f, 0.7f, 3});
    for (const char* name :
         {"box", "gaussian", "sinc", "catmull-rom", "mitchell", "bessel", "blackman-harris"}) {
        RasterScene scene(32, 32, 4);
        scene.scene.options.filter = {name, 4, 4};
        const Image image = render(scene, grids, {});
        const float expected[] = {0.25f, Imath::half(0.7f), 3};
        for (int y = 4; y < 28; ++y)
            for (int x = 4; x < 28; ++x) {
                const float* rgba = &image.rgba[4 * image.index(x, y)];
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgba[c], expected[c], 2e-5f * expected[c]) << name;
                EXPECT_EQ(rgba[3], 1.0f) << name;
            }
    }
}

TEST(Film, IsTheWeightedMeanOfTheSamplesAround) {
    RasterScene scene(64, 48, 3);
    scene.scene.options.filter = {"gaussian", 3, 2};
    const Grids grids = busy_grids();
    const Image image = render(scene, grids);
    const SampleTile samples = make_samples(scene, scene.sampled());
    for (const auto& [px, py] : {std::pair{0, 0}, {15, 16}, {31, 3}, {40, 31}, {63, 47}}) {
        double weights = 0, alpha = 0, red = 0;
        for (size_t s = 0; s < samples.size(); ++s) {
            const float x = samples.x[s], y = samples.y[s];
            const double dx = x - (px + 0.5), dy = y - (py + 0.5);
            if (std::abs(dx) > 1.5 || std::abs(dy) > 1) continue;
            const double weight = filter_value("gaussian", dx, dy, 3, 2);
            weights += weight;
            const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
            if (ix < 0 || iy < 0 || ix >= 64 || iy >= 48 || !in_blob(x, y)) continue;
            alpha += weight;
            const Imath::half value =
                unit_float(hash(static_cast<uint32_t>(ix), static_cast<uint32_t>(iy), 0u));
            red += weight * value;
        }
        EXPECT_NEAR(image.rgba[4 * image.index(px, py)], red / weights, 1e-5);
        EXPECT_NEAR(image.rgba[4 * image.index(px, py) + 3], alpha / weights, 1e-5);
    }
}

TEST(Film, FilteringKeepsTheEnergyOfAPattern) {
    // Wide enough that every sample of the pattern is far from the picture's edge; a partition of unity
    // spreads its weight over pixels without loss, up to the jitter of the weight sums.
    RasterScene scene(64, 48, 8);
    const Grids grids = constant_grids({1, 1, 1});
    const auto square = [](float x, float y) { return x > 20 && x < 30.5f && y > 10.25f && y < 22; };
    for (const char* name : {"triangle", "mitchell"}) {
        const float width = name == std::string("triangle") ? 2.0f : 4.0f;
        scene.scene.options.filter = {name, width, width};
        const Image image = render(scene, grids, square);
        double sum = 0;
        for (size_t i = 3; i < image.rgba.size(); i += 4) sum += image.rgba[i];
        EXPECT_NEAR(sum, 10.5 * 11.75, 0.005 * 10.5 * 11.75) << name;
    }
}

TEST(Film, AnEmptyTileCountsInItsNeighbours) {
    // Only pixels left of 16 are covered, so tiles from 16 on are empty, yet they darken what their samples
    // reach.
    RasterScene scene(64, 48, 4);
    const Grids grids = constant_grids({1, 1, 1});
    const Image image = render(scene, grids, [](float x, float) { return x < 16; });
    EXPECT_EQ(image.rgba[4 * image.index(8, 20) + 3], 1.0f);
    const float left = image.rgba[4 * image.index(15, 20) + 3],
                right = image.rgba[4 * image.index(16, 20) + 3];
    EXPECT_GT(left, 0.6f);
    EXPECT_LT(left, 0.99f);
    EXPECT_NEAR(left + right, 1, 0.1);
    EXPECT_EQ(image.rgba[4 * image.index(17, 20) + 3], 0.0f);
}

TEST(Film, DepthAndIdAreOfThePixelAlone) {
    RasterScene scene(64, 48, 3);
    const Grids grids = busy_grids();
    const Image image =
        render(scene, grids, [](float x, float y) { return x > 20.4f && x < 22 && y > 9 && y < 10; });
    EXPECT_EQ(image.z[image.index(20, 9)], 5);
    EXPECT_EQ(image.z[image.index(21, 9)], 5);
    EXPECT_EQ(image.z[image.index(19, 9)], kInfinity);
    EXPECT_EQ(image.z[image.index(22, 9)], kInfinity);
    EXPECT_EQ(image.z[image.index(21, 10)], kInfinity);
    EXPECT_EQ(image.id[image.index(21, 9)], 3u);
    EXPECT_EQ(image.id[image.index(21, 8)], kNoPrimitive);
}

TEST(Film, DepthFilters) {
    Grids grids;
    for (const float depth : {2.0f, 4.0f}) {
        GridLook look;
        look.color = [](int, int) { return V3f(1); };
        look.depth = depth;
        add_grids(grids, 1, 1, look);
    }
    for (const auto& [name, expected] :
         {std::pair{"min", 2.0f}, {"max", 4.0f}, {"average", 3.0f}, {"medium", 2.0f}}) {
        RasterScene scene(16, 16, 2);
        Parameter parameter{"depthfilter", {StorageClass::Uniform, ValueType::String, 1}, {}, {name}};
        scene.scene.options.hider_parameters.set(parameter);
        Film film(scene.context);
        for (const PixelRect& tile : tiles_of(scene.sampled())) {
            const SampleTile samples = make_samples(scene, tile);
            HitBuffer hits = make_hits(samples, grids, 1, 1, {});
            for (size_t i = 0; i < hits.hits.size(); i += 2) {  // every other sample sees the far grid
                MicropolygonId id = MicropolygonId::unpack(hits.hits[i].id);
                id.grid = 1;
                hits.hits[i] = {4, id.packed()};
            }
            film.add(samples, hits, grids);
        }
        EXPECT_EQ(film.finish().z[5 * 16 + 5], expected) << name;
        EXPECT_EQ(scene.diagnostics.count(Severity::Warning), name == std::string("medium") ? 1u : 0u);
    }
}

TEST(Film, ExposureTouchesColourOnly) {
    RasterScene scene(64, 48, 2);
    scene.scene.options.exposure_gain = 2;
    scene.scene.options.exposure_gamma = 2.2f;
    const Grids grids = constant_grids({0.25f, 0.125f, 0});
    const Image image = render(scene, grids, {});
    const float* rgba = &image.rgba[4 * image.index(20, 20)];
    EXPECT_NEAR(rgba[0], std::pow(0.5, 1 / 2.2), 1e-5);
    EXPECT_NEAR(rgba[1], std::pow(0.25, 1 / 2.2), 1e-5);
    EXPECT_EQ(rgba[2], 0);
    EXPECT_EQ(rgba[3], 1);
}

TEST(Film, WaitsOnlyForAFrontierOfTiles) {
    RasterScene scene(1024, 1024, 1);
    Film film(scene.context);
    const std::vector<PixelRect> tiles = tiles_of(scene.sampled());
    size_t most = 0;
    for (const PixelRect& tile : tiles) {
        film.add(make_samples(scene, tile), HitBuffer{}, Grids{});
        most = std::max(most, film.waiting_bytes());
    }
    const size_t one_tile = 18 * 18 * sizeof(float), tiles_in_a_row = 66;
    EXPECT_LE(most, 3 * tiles_in_a_row * one_tile);
    EXPECT_EQ(film.waiting_bytes(), 0u);
}

TEST(Film, MissingAndRepeatedTilesDoNoHarm) {
    RasterScene scene(64, 48, 2);
    const Grids grids = constant_grids({1, 1, 1});
    Film film(scene.context);
    add_tile(scene, grids, {16, 16, 32, 32}, film, {});
    add_tile(scene, grids, {16, 16, 32, 32}, film, {});
    add_tile(scene, grids, {1600, 16, 1616, 32}, film, {});
    const Image image = film.finish();
    EXPECT_EQ(image.rgba[4 * image.index(20, 20) + 3], 1.0f);
    EXPECT_EQ(image.rgba[4 * image.index(40, 20) + 3], 0.0f);
}

TEST(Film, AnEmptyCropMakesAnEmptyImage) {
    RasterScene scene(64, 48, 2);
    scene.scene.options.crop_window = {0.5f, 0.5f, 0, 1};
    scene.update();
    Film film(scene.context);
    add_tile(scene, constant_grids({1, 1, 1}), {16, 16, 32, 32}, film, {});
    EXPECT_TRUE(film.finish().rgba.empty());
}

}  // namespace
}  // namespace trapeze
