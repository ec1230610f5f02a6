#include "composite/film/finished_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>

#include "composite/film/awaited_tiles.h"
#include "composite/film/film.h"
#include "composite/film/film_tiles.h"
#include "composite/film/kept_bytes_harness.h"
#include "composite/film/raster_harness.h"

namespace trapeze {
namespace {

using testing::KeptBytes;
using testing::RasterScene;

constexpr int kGridColumns = 6, kGridRows = 4;  // the picture is 96x64

/// Asks for all that a film keeps of a pixel: depth, ids, variables summed and chosen, deep samples.
void ask_for_all(RasterScene& scene, const char* filter, float width) {
    scene.scene.options.filter = {filter, width, width};
    Display chosen = testing::aov_display("foo", ValueType::Float);
    chosen.parameters.set({"filter", {StorageClass::Uniform, ValueType::String, 1}, {}, {"min"}});
    Display deep = testing::aov_display("Ci", ValueType::Color, "a.exr");
    deep.type = "deepexr";
    scene.scene.options.displays = {chosen, deep};
    scene.scene.options.exposure_gain = 1.5f;
    scene.update();
}

Grids all_grids() {
    testing::GridLook look;
    look.color = [](int x, int y) {
        const auto channel = [&](uint32_t c) {
            return unit_float(hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), c));
        };
        return V3f(channel(0), channel(1), channel(2));
    };
    look.aov_channels = 4;
    look.aov = [&](int x, int y, int channel) { return static_cast<float>(x * y + channel); };
    look.depth = 5, look.primitive = 3;
    Grids grids;
    testing::add_grids(grids, kGridColumns, kGridRows, look);
    return grids;
}

bool in_ring(float x, float y) {
    const float r = std::hypot(x - 48, y - 32);
    return r > 9.5f && r < 40.2f;
}

void add_ring_tile(const RasterScene& scene, const Grids& grids, const PixelRect& pixels, Film& film) {
    const SampleTile samples = testing::make_samples(scene, pixels);
    film.add(samples, testing::make_hits(samples, grids, kGridColumns, kGridRows, in_ring), grids);
}

Image whole_picture(const RasterScene& scene, const Grids& grids) {
    Film film(scene.context, true);
    for (const PixelRect& tile : testing::tiles_of(scene.sampled())) add_ring_tile(scene, grids, tile, film);
    return film.finish();
}

/// Whether a tile is among those that a film begins with.
bool comes_first(uint32_t seed, const PixelRect& tile) {
    return hash(seed, static_cast<uint32_t>(tile.x0), static_cast<uint32_t>(tile.y0)) % 100 < 88;
}

TEST(FinishedTiles, APictureIsTheSameBitsWhenAnotherFilmGoesOnWithIt) {
    for (const auto& [filter, width] : {std::pair{"gaussian", 2.0f}, {"box", 1.0f}, {"sinc", 21.0f}}) {
        RasterScene scene(96, 64, 2);
        ask_for_all(scene, filter, width);
        const Grids grids = all_grids();
        const std::vector<PixelRect> tiles = testing::tiles_of(scene.sampled());
        const Image expected = whole_picture(scene, grids);
        ASSERT_FALSE(expected.deep.empty());
        ASSERT_GT(expected.aov_channels, 0);
        for (uint32_t seed = 0; seed < 4; ++seed) {
            Film first(scene.context, true);
            size_t left_out = 0;
            for (const PixelRect& tile : tiles)
                if (seed == 3 || comes_first(seed, tile))
                    add_ring_tile(scene, grids, tile, first);
                else
                    ++left_out;
            KeptBytes bytes;
            ASSERT_TRUE(first.write_finished(bytes.writer()));
            const size_t finished = first.finished_tiles().size();
            ASSERT_GT(finished, 0u);

            Film second(scene.context, true);
            ASSERT_TRUE(second.read_finished(bytes.reader()));
            EXPECT_EQ(bytes.at, bytes.text.size());
            EXPECT_EQ(second.finished_tiles().size(), finished);
            const AwaitedTiles awaited = second.awaited_tiles();
            size_t left = 0;
            for (const PixelRect& tile : tiles)
                if (awaited.meet(tile)) ++left, add_ring_tile(scene, grids, tile, second);
            EXPECT_EQ(second.waiting_bytes(), 0u);
            EXPECT_GE(left, left_out);
            EXPECT_EQ(left == 0, left_out == 0);
            EXPECT_TRUE(second.finish() == expected) << filter << seed;
        }
    }
}

TEST(FinishedTiles, AreFinishedAfterAllOthersHaveBeenRestored) {
    RasterScene scene(96, 64, 2);
    ask_for_all(scene, "gaussian", 2);
    const Grids grids = all_grids();
    const std::vector<PixelRect> tiles = testing::tiles_of(scene.sampled());
    const Image expected = whole_picture(scene, grids);
    // A tile or two at a time, each by a film of its own.
    KeptBytes bytes;
    Film(scene.context, true).write_finished(bytes.writer());
    for (int round = 0; round < 100; ++round) {
        Film film(scene.context, true);
        ASSERT_TRUE(film.read_finished(bytes.reader()));
        const AwaitedTiles awaited = film.awaited_tiles();
        const size_t before = film.finished_tiles().size();
        for (const PixelRect& tile : tiles)
            if (awaited.meet(tile) && film.finished_tiles().size() < before + 2)
                add_ring_tile(scene, grids, tile, film);
        bytes = {};
        ASSERT_TRUE(film.write_finished(bytes.writer()));
        if (film.finished_tiles().size() > before) continue;
        EXPECT_TRUE(film.finish() == expected);
        EXPECT_GT(round, 5);
        return;
    }
    FAIL() << "they never end";
}

/// Every pixel that is said to be finished, whatever tiles have come, is as it is in the end; and those that
/// no other tile reaches need no other tile.
TEST(FinishedPixels, AreThoseOfTheWholePictureAtAnyTime) {
    for (const auto& [filter, width] : {std::pair{"gaussian", 2.0f}, {"box", 1.0f}, {"sinc", 21.0f}}) {
        RasterScene scene(96, 64, 2);
        ask_for_all(scene, filter, width);
        const Grids grids = all_grids();
        const Image expected = whole_picture(scene, grids);
        std::vector<PixelRect> tiles = testing::tiles_of(scene.sampled());
        for (size_t i = tiles.size() - 1; i > 0; --i)
            std::swap(tiles[i], tiles[hash(7, static_cast<uint32_t>(i)) % (i + 1)]);
        Film film(scene.context, true);
        for (const PixelRect& tile : tiles) {
            add_ring_tile(scene, grids, tile, film);
            size_t of_tile = 0;
            for (int t = 0; t < film.tile_count(); ++t) {
                const PixelRect finished = film.finished_pixels(t);
                for (int y = finished.y0; y < finished.y1; ++y)
                    for (int x = finished.x0; x < finished.x1; ++x) {
                        ASSERT_TRUE(testing::same_pixel(film.unfinished(), expected, x, y)) << x << " " << y;
                        if (tile.contains(x, y)) ++of_tile;
                    }
            }
            const int reach = std::string(filter) == "gaussian" ? 1 : std::string(filter) == "box" ? 0 : 10;
            const auto inner = static_cast<size_t>(std::max(0, kTileSide - 2 * reach));
            const bool is_whole = tile.width() == kTileSide && tile.height() == kTileSide;
            if (is_whole && scene.context.camera.crop.contains(tile.x0, tile.y0)) {
                EXPECT_GE(of_tile, inner * inner) << filter << tile.x0 << " " << tile.y0;
            }
        }
        EXPECT_TRUE(film.finish() == expected);
    }
}

TEST(FinishedTiles, OfAnotherFilmOrCutShortAreRefused) {
    RasterScene scene(96, 64, 2);
    ask_for_all(scene, "gaussian", 2);
    const Grids grids = all_grids();
    Film film(scene.context, true);
    for (const PixelRect& tile : testing::tiles_of(scene.sampled())) add_ring_tile(scene, grids, tile, film);
    KeptBytes bytes;
    ASSERT_TRUE(film.write_finished(bytes.writer()));
    for (uint32_t i = 0; i < 50; ++i) {
        KeptBytes part{bytes.text.substr(0, hash(i) % bytes.text.size()), 0};
        EXPECT_FALSE(Film(scene.context, true).read_finished(part.reader()));
    }
    // Whatever is in them, nothing is read or written that is not theirs.
    for (uint32_t i = 0; i < 300; ++i) {
        KeptBytes part{bytes.text, 0};
        for (uint32_t j = 0; j < 4; ++j)
            part.text[hash(i, j) % (i % 2 ? part.text.size() : 60)] = static_cast<char>(hash(i, j, 7));
        Film other(scene.context, true);
        if (other.read_finished(part.reader())) other.finish();
    }
    EXPECT_FALSE(Film(scene.context, false).read_finished(KeptBytes{bytes.text, 0}.reader()));
    RasterScene larger(96, 80, 2);
    ask_for_all(larger, "gaussian", 2);
    EXPECT_FALSE(Film(larger.context, true).read_finished(KeptBytes{bytes.text, 0}.reader()));
    WriteBytes full = [left = 5000](const void*, size_t count) mutable {
        left -= static_cast<int>(count);
        return left >= 0;
    };
    EXPECT_FALSE(film.write_finished(full));
}

TEST(FinishedTiles, AreWrittenWhileOthersAreAdded) {
    RasterScene scene(96, 64, 2);
    ask_for_all(scene, "gaussian", 2);
    const Grids grids = all_grids();
    const std::vector<PixelRect> tiles = testing::tiles_of(scene.sampled());
    const Image expected = whole_picture(scene, grids);

    Film film(scene.context, true);
    std::atomic<bool> done{false};
    std::vector<KeptBytes> written;
    std::thread saver([&] {
        while (!done) {
            KeptBytes& bytes = written.emplace_back();
            EXPECT_TRUE(film.write_finished(bytes.writer()));
        }
    });
    for (const PixelRect& tile : tiles) add_ring_tile(scene, grids, tile, film);
    done = true;
    saver.join();
    for (size_t i = 0; i < written.size(); i += 1 + written.size() / 8) {
        Film next(scene.context, true);
        ASSERT_TRUE(next.read_finished(written[i].reader()));
        for (const PixelRect& tile : tiles) add_ring_tile(scene, grids, tile, next);
        EXPECT_TRUE(next.finish() == expected);
    }
}

TEST(AwaitedTiles, MeetAndBoundAsCountedOneByOne) {
    const PixelRect sampled{-3, -17, 90, 70}, window{0, 0, 88, 66};
    FilmTiles tiles(sampled, window, 2, 2);
    for (int tile = 0; tile < tiles.count(); ++tile)
        tiles[tile].added = hash(static_cast<uint32_t>(tile)) % 5 > 0;
    const AwaitedTiles awaited(tiles);
    for (uint32_t i = 0; i < 3000; ++i) {
        const auto pick = [i](uint32_t c, int from, int to) {
            return from + static_cast<int>(hash(i, c) % static_cast<uint32_t>(to - from));
        };
        PixelRect pixels{pick(0, -40, 110), pick(1, -40, 90), 0, 0};
        pixels.x1 = pixels.x0 + pick(2, 0, 60), pixels.y1 = pixels.y0 + pick(3, 0, 60);
        PixelRect bound{1000, 1000, -1000, -1000};
        for (int tile = 0; tile < tiles.count(); ++tile) {
            const PixelRect part = intersection(tiles.square(tile), pixels);
            if (part.empty() || tiles[tile].added) continue;
            bound = {std::min(bound.x0, part.x0), std::min(bound.y0, part.y0), std::max(bound.x1, part.x1),
                     std::max(bound.y1, part.y1)};
        }
        EXPECT_EQ(awaited.meet(pixels), !bound.empty());
        const PixelRect found = awaited.bound(pixels);
        EXPECT_TRUE(bound.empty() ? found.empty() : found == bound);
    }
}

}  // namespace
}  // namespace trapeze
