/// Scenes on which all visibility methods are held against brute force: each kind of blur, thin and
/// degenerate things, looks and cameras.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/noise_harness.h"
#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze::testing {

struct TestScene {
    std::string name;
    TestFrame frame;
    GridMaker maker;
    bool must_hit = true;
};

inline V3f rotated(const V3f& p, float angle) {
    return {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle),
            p.z};
}

/// Wavy sheets at random places and orientations.
inline void add_sheets(GridMaker& maker, int count, int keys, uint32_t seed, float motion = 1) {
    Noise noise{std::mt19937(seed)};
    for (int n = 0; n < count; ++n) {
        const V3f origin = noise.point(3, 3, 9), along_u = noise.point(2, -1, 1),
                  along_v = noise.point(2, -1, 1);
        const V3f shift = noise.point(motion, -motion / 2, motion / 2);
        const float turn = noise(-motion, motion);
        const int nu = 1 + static_cast<int>(noise.engine() % 16),
                  nv = 1 + static_cast<int>(noise.engine() % 16);
        maker.add(nu, nv, keys, [=](int i, int j, float t) {
            const float u = static_cast<float>(i) / static_cast<float>(nu),
                        v = static_cast<float>(j) / static_cast<float>(nv);
            const V3f p = origin + along_u * u + along_v * v + V3f(0, 0, 0.2f * std::sin(9 * u + 7 * v));
            return keys == 1 ? p : rotated(p, turn * t) + shift * t;
        });
    }
}

/// Loose quads of random corners, needles and points among them.
inline void add_shards(GridMaker& maker, int count, int keys, uint32_t seed, float z_from, float z_to) {
    Noise noise{std::mt19937(seed)};
    for (int n = 0; n < count; ++n) {
        const int kind = n % 5;
        const V3f centre = noise.point(3, z_from, z_to);
        std::array<std::array<V3f, 4>, 2> corner;
        for (auto& pose : corner)
            for (V3f& p : pose) p = centre + noise.point(1, -1, 1);
        for (auto& pose : corner) {
            if (kind == 1) pose[2] = pose[0], pose[3] = pose[1];   // a line
            if (kind == 2) pose[1] = pose[2] = pose[3] = pose[0];  // a point
            if (kind == 3)
                pose[3] = pose[0] + (pose[1] - pose[0]) * 0.5f, pose[2] = pose[0] + V3f(1e-6f, 0, 1e-6f);
            if (kind == 4) std::swap(pose[2], pose[3]);  // likelier a bow-tie
        }
        maker.add(1, 1, keys, [&](int i, int j, float t) {
            const size_t c = static_cast<size_t>(i + 2 * j);
            return corner[0][c] + (corner[1][c] - corner[0][c]) * t;
        });
    }
}

/// Adds an empty scene of a name to a list that has room.
class AddScene {
  public:
    explicit AddScene(std::vector<TestScene>& scenes) : scenes_(scenes) {}
    TestScene& operator()(const char* name, bool motion, bool defocus) const {
        return scenes_.emplace_back(TestScene{name, TestFrame(40, 24, 3, motion, defocus), {}});
    }

  private:
    std::vector<TestScene>& scenes_;
};

inline void add_kinds_of_blur(const AddScene& scene) {
    add_sheets(scene("static", false, false).maker, 30, 1, 1);
    add_sheets(scene("motion", true, false).maker, 30, 2, 2);
    add_sheets(scene("defocus", false, true).maker, 30, 1, 3);
    {
        TestScene& parallel = scene("orthographic without a lens", false, false);
        parallel.frame.options.projection = "orthographic";
        parallel.frame.options.screen_window = {-4, 4, -3, 3};
        parallel.frame.update();
        add_sheets(parallel.maker, 30, 1, 35);
    }
    add_sheets(scene("motion and defocus", true, true).maker, 30, 2, 4);
    {
        TestScene& blades = scene("blades and motion", true, true);
        blades.frame.context.camera.aperture = {5, 36, -.8f, .7f};
        add_sheets(blades.maker, 30, 2, 36);
        TestScene& triangle = scene("three blades", false, true);
        triangle.frame.context.camera.aperture = {3, 10, 0, 0};
        add_sheets(triangle.maker, 30, 1, 37);
    }
    add_sheets(scene("five keys", true, true).maker, 20, 5, 5, 2);
    {
        GridMaker& maker = scene("mixed key counts", true, true).maker;
        int seed = 10;
        for (const int keys : {1, 2, 3, 5, 9, 65}) add_sheets(maker, 6, keys, seed++);
    }
}

inline void add_thin_things(const AddScene& scene) {
    {
        GridMaker& maker = scene("hair", true, true).maker;
        Noise noise{std::mt19937(20)};
        for (int n = 0; n < 200; ++n) {
            const V3f root = noise.point(3, 4, 8), lean = noise.point(1, -1, 1),
                      shift = noise.point(1, -1, 1);
            maker.add(1, 16, 2, [=](int i, int j, float t) {
                const float s = static_cast<float>(j) / 16;
                return root + lean * s + V3f(0.5f * s * s + 0.002f * static_cast<float>(i), 0, 0) +
                       shift * (t * s);
            });
        }
    }
    {
        // Slivers along the very rays of samples: the weights of their hits round to anything.
        TestScene& slivers = scene("edge-on slivers", false, false);
        Noise noise{std::mt19937(21)};
        SampleTile samples;
        StratifiedPattern(slivers.frame.context).make_tile({16, 8, 25, 17}, samples);
        for (size_t n = 0; n < 3 * samples.size(); ++n) {
            const AxisRay& ray = samples.rays[n / 3];
            const float middle = 5 + 0.01f * static_cast<float>(n % 3), thin = std::pow(10.0f, noise(-9, -6));
            const V2f lean(noise(-0.3f, 0.3f), noise(-0.3f, 0.3f));
            std::array<V3f, 4> corner;
            for (V3f& p : corner) {  // nearly on a line through the ray, slanted in depth
                const float along = noise(-1, 1), z = middle + 2 * along;
                p = V3f(ray.ux * z + lean.x * along, ray.uy * z + lean.y * along, z) +
                    noise.point(thin, -thin, thin);
            }
            slivers.maker.add(1, 1, 1,
                              [&](int i, int j, float) { return corner[static_cast<size_t>(i + 2 * j)]; });
        }
        add_sheets(slivers.maker, 3, 1, 34);
    }
}

inline void add_degenerate_things(const AddScene& scene) {
    {
        TestScene& behind = scene("behind the lens", true, true);
        behind.must_hit = false;
        add_shards(behind.maker, 100, 2, 22, -9, -2);
    }
    add_shards(scene("crossing the eye plane", true, true).maker, 100, 2, 23, -1, 1);
    add_shards(scene("needles, bow-ties, points", false, false).maker, 300, 1, 24, 2, 8);
    add_shards(scene("needles, bow-ties, points moving", true, true).maker, 300, 2, 25, 2, 8);
    {
        GridMaker& maker = scene("floor under the camera", false, true).maker;
        for (int part = 0; part < 8; ++part)
            maker.add(16, 16, 1, [=](int i, int j, float) {
                return V3f(static_cast<float>(i) * 4 - 32, -1, static_cast<float>(j + 16 * part) * 0.5f - 20);
            });
    }
}

inline void add_looks_and_cameras(const AddScene& scene) {
    {
        GridMaker& maker = scene("transparent layers", true, true).maker;
        maker.opaque = false;
        add_sheets(maker, 40, 2, 26);
        maker.opaque = true;
        add_sheets(maker, 6, 2, 27);
    }
    {
        GridMaker& maker = scene("one-sided", true, false).maker;
        maker.facing = Facing::PositiveOnly;
        add_sheets(maker, 15, 2, 28);
        maker.facing = Facing::NegativeOnly;
        add_sheets(maker, 15, 1, 29);
    }
    {
        GridMaker& maker = scene("ties", false, true).maker;
        for (int copy = 0; copy < 3; ++copy) add_sheets(maker, 10, 1, 30);
        maker.opaque = false;
        for (int copy = 0; copy < 2; ++copy) add_sheets(maker, 10, 1, 30);
    }
    {
        GridMaker& maker = scene("all at one place", false, false).maker;
        for (int n = 0; n < 70; ++n)
            maker.add(3, 2, 1, [](int i, int j, float) { return V3f(0.3f * i - 0.5f, 0.3f * j, 4); });
    }
    {
        TestScene& ortho = scene("orthographic", true, true);
        ortho.frame.options.projection = "orthographic";
        ortho.frame.options.screen_window = std::array{-4.0f, 4.0f, -3.0f, 3.0f};
        ortho.frame.update();
        add_sheets(ortho.maker, 30, 2, 31);
    }
    {
        TestScene& clipped = scene("clipped", true, true);
        clipped.frame.options.near_clip = 4.5f, clipped.frame.options.far_clip = 6;
        clipped.frame.update();
        clipped.maker.opaque = false;
        add_sheets(clipped.maker, 30, 2, 32);
    }
    {
        GridMaker& maker = scene("far from the origin and huge", true, false).maker;
        maker.add(8, 8, 2,
                  [](int i, int j, float t) { return V3f(1e3f * (i - 4), 1e3f * (j - 4) + 500 * t, 900); });
        maker.add(1, 1, 1, [](int i, int j, float) {
            return V3f(2e30f * (i - 0.5f), 3e30f * (j - 0.5f), 1e20f * (i + 1));
        });
        maker.add(1, 1, 1,
                  [](int i, int j, float) { return V3f(1e16f * (i - 0.5f), 1e16f * (j - 0.5f), 100); });
        add_sheets(maker, 10, 2, 33);
    }
}

inline std::vector<TestScene> make_scenes() {
    std::vector<TestScene> scenes;
    scenes.reserve(32);  // scenes stay where they are: their contexts are referred to
    const AddScene scene(scenes);
    add_kinds_of_blur(scene);
    add_thin_things(scene);
    add_degenerate_things(scene);
    add_looks_and_cameras(scene);
    return scenes;
}

}  // namespace trapeze::testing
