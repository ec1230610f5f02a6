/// A frame that is cancelled or runs out of memory again and again, and goes on with its finished tiles each
/// time, is the same bits in the end.
#include <gtest/gtest.h>

#include <new>

#include "composite/film/film.h"
#include "composite/film/kept_bytes_harness.h"
#include "core/random.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Keeps tiles in memory from attempt to attempt.
class MemoryKeeper final : public FilmKeeper {
  public:
    bool begin(Film& film) override {
        film_ = &film;
        ++begun;
        bytes_.at = 0;
        EXPECT_TRUE(bytes_.text.empty() || film.read_finished(bytes_.reader()));
        EXPECT_EQ(bytes_.at, bytes_.text.size());
        return true;
    }
    void end(bool is_cancelled) noexcept override {
        ++ended;
        was_cancelled = is_cancelled;
        if (!film_) return;
        bytes_ = {};
        EXPECT_TRUE(film_->write_finished(bytes_.writer()));
        tiles = film_->finished_tiles().size();
        film_ = nullptr;
    }
    void give_up(const std::string& why) override {
        reason = why;
        film_ = nullptr;
        bytes_ = {};
    }
    int regions_at_least() const override { return regions; }

    size_t begun = 0, ended = 0, tiles = 0;
    bool was_cancelled = false;
    int regions = 1;
    std::string reason;

  private:
    Film* film_ = nullptr;
    KeptBytes bytes_;
};

struct Attempts {
    size_t cancelled = 0, with_tiles = 0;
};

/// Renders a world in attempts, each of which is cancelled, or has no more memory, when it is so far as a
/// number says, until one comes to its end.
std::optional<FrameResult> render_in_attempts(const Scene& scene, RenderSettings settings,
                                              Diagnostics& diagnostics, Attempts& attempts) {
    MemoryKeeper keeper;
    settings.keeper = &keeper;
    for (uint32_t attempt = 0; attempt < 40; ++attempt) {
        std::atomic<bool> cancelled{false};
        const double until = attempt < 4 ? unit_float(hash(attempt, settings.seed)) : 2;
        settings.cancelled = &cancelled;
        settings.on_progress = [&](double part) {
            if (part < until) return;
            cancelled = true;
            if (attempt % 2 == 1) throw std::bad_alloc();
        };
        keeper.regions = attempt % 2 ? 3 : 1;
        try {
            auto result = render_frame(make_context(scene, settings, diagnostics), settings);
            if (result) return result;
            EXPECT_EQ(attempt % 2, 0u);
        } catch (const std::bad_alloc&) {
            EXPECT_EQ(attempt % 2, 1u);
        }
        EXPECT_TRUE(cancelled.load());
        EXPECT_EQ(keeper.begun, keeper.ended);
        EXPECT_TRUE(keeper.begun == 0 || keeper.was_cancelled);
        ++attempts.cancelled;
        if (keeper.tiles > 0) ++attempts.with_tiles;
    }
    return {};
}

/// All worlds of a scene, whole and in attempts.
Attempts expect_same_in_attempts(const std::string& path, const std::string& first_rib = {},
                                 RenderSettings settings = {}) {
    Diagnostics diagnostics;
    Attempts attempts;
    ReadOptions options;
    if (!first_rib.empty()) options.first_texts.push_back({"test", first_rib});
    const std::vector<std::string> files{path};
    read_rib(files, options, diagnostics, [&](Scene&& scene) {
        const auto whole = render_frame(make_context(scene, settings, diagnostics), settings);
        const auto resumed = render_in_attempts(scene, settings, diagnostics, attempts);
        ASSERT_TRUE(whole && resumed);
        EXPECT_TRUE(same_bits(whole->image, resumed->image)) << path;
        EXPECT_EQ(whole->image.matte_loss, resumed->image.matte_loss);
        EXPECT_EQ(whole->stats.shows_something, resumed->stats.shows_something);
    });
    return attempts;
}

TEST(Resume, EveryTinySceneIsTheSameBits) {
    Attempts all;
    for (const std::string& name : tiny_scenes_without_maps()) {
        const Attempts attempts = expect_same_in_attempts(tiny_scene_path(name));
        all.cancelled += attempts.cancelled, all.with_tiles += attempts.with_tiles;
    }
    EXPECT_GT(all.cancelled, 100u);
    EXPECT_GT(all.with_tiles, 50u);
}

/// Twelve tiles and more, of which each attempt makes a few.
constexpr const char* kLarge = "Format 160 112 1 ";

TEST(Resume, AdaptiveSamplesDeepPicturesAndMattesAreTheSameBits) {
    for (const std::string rib :
         {"PixelSamples 6 6 PixelVariance .001", "Display \"a.exr\" \"deepexr\" \"rgba\"",
          "Display \"a.exr\" \"openexr\" \"rgba\" Display \"+m.exr\" \"openexr\" \"crypto_object\"",
          "PixelFilter \"sinc\" 21 17",
          "PixelFilter \"box\" 1 1 Display \"a.exr\" \"openexr\" \"rgba\" "
          "Display \"+z.exr\" \"openexr\" \"varying float __depth\""}) {
        const Attempts attempts =
            expect_same_in_attempts(tiny_scene_path("defocus_motion.rib"), std::string(kLarge) + rib);
        EXPECT_GT(attempts.with_tiles, 0u) << rib;
    }
}

TEST(Resume, EveryMethodIsTheSameBits) {
    for (const std::string& method : methods_beside_ray_tracing()) {
        RenderSettings settings;
        settings.sampler = method;
        EXPECT_GT(expect_same_in_attempts(tiny_scene_path("defocus_motion.rib"), kLarge, settings).with_tiles,
                  0u);
    }
}

}  // namespace
}  // namespace trapeze::testing
