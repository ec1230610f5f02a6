/// Synthetic scenes for measuring sampling: bumpy balls before a wavy wall, or balls of hair, of a wished
/// number of micropolygons about a pixel large. With motion every thing flies and turns by itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "core/grids_harness.h"
#include "sample/frame_harness.h"

namespace trapeze::testing {

struct SamplingSceneOptions {
    bool hair = false;
    double micropolygons = 1.5e6;
    float motion_pixels = 0;  ///< of the fastest
    float blur_pixels = 0;    ///< circle of confusion at depth 40
    int samples = 8;          ///< a pixel and axis
};

class SamplingScene {
  public:
    explicit SamplingScene(const SamplingSceneOptions& options)
        : frame(options.micropolygons < 5e5 ? 640 : 1280, options.micropolygons < 5e5 ? 360 : 720,
                options.samples, options.motion_pixels > 0, false),
          o_(options) {
        frame.options.fov = 45;
        frame.options.near_clip = 1, frame.options.far_clip = 1e30f;
        frame.update();
        pixels_ = 1 / frame.context.camera.plane_scale_x;  // a length's pixels at depth 1
        if (o_.blur_pixels > 0) {
            const float radius = o_.blur_pixels / 2 / (pixels_ * (1 / kFocus - 1 / 40.0f));
            frame.options.focal_distance = kFocus;
            frame.options.focal_length = 1, frame.options.f_stop = 0.5f / radius;
            frame.update();
        }
        if (o_.hair)
            add_hair();
        else
            add_balls();
    }

    TestFrame frame;
    GridMaker maker;

  private:
    static constexpr float kFocus = 15;

    struct Motion {
        V3f centre, shift, axis;
        float turn;

        V3f at(const V3f& p, float t) const {
            const V3f q = p - centre;
            const float s = std::sin(turn * t), c = std::cos(turn * t);
            return centre + q * c + axis.cross(q) * s + axis * (axis.dot(q) * (1 - c)) + shift * t;
        }
    };

    float random(float from, float to) {
        return from + (to - from) * static_cast<float>(engine_()) * 0x1p-32f;
    }
    V3f random_direction() {
        V3f v;
        do v = {random(-1, 1), random(-1, 1), random(-1, 1)};
        while (v.length2() > 1 || v.length2() < 0.01f);
        return v.normalized();
    }
    int keys() const { return o_.motion_pixels > 0 ? 2 : 1; }
    double made() const { return static_cast<double>(made_); }

    Motion random_motion(const V3f& centre, float pixels) {
        if (pixels == 0) return {centre, V3f(0), V3f(0, 0, 1), 0};
        const float speed = random(0, pixels) * centre.z / pixels_, angle = random(0, 6.2831853f);
        return {centre,
                V3f(speed * std::cos(angle), speed * std::sin(angle), random(-0.02f, 0.02f) * centre.z),
                random_direction(), random(-0.15f, 0.15f)};
    }

    /// A grid over [u0, u1] x [v0, v1] of a surface.
    template <class Surface>
    void add_patch(int nu, int nv, const Surface& surface, const Motion& motion, float u0, float u1, float v0,
                   float v1) {
        maker.add(nu, nv, keys(), [&](int i, int j, float t) {
            const V3f p = surface(u0 + (u1 - u0) * static_cast<float>(i) / static_cast<float>(nu),
                                  v0 + (v1 - v0) * static_cast<float>(j) / static_cast<float>(nv));
            return t == 0 ? p : motion.at(p, t);
        });
        made_ += static_cast<size_t>(nu) * nv;
    }

    void add_wall(float area) {
        const float z = 45, margin = 60;
        const auto width = static_cast<float>(frame.options.width),
                   height = static_cast<float>(frame.options.height);
        const int nx = static_cast<int>(std::ceil((width + 2 * margin) / (16 * std::sqrt(area))));
        const int ny = static_cast<int>(std::ceil((height + 2 * margin) / (16 * std::sqrt(area))));
        const auto surface = [&](float u, float v) {
            const float x = -margin - width / 2 + u * (width + 2 * margin),
                        y = -margin - height / 2 + v * (height + 2 * margin);
            const float depth = z * (1 + 0.05f * std::sin(x * 0.03f) * std::sin(y * 0.04f) +
                                     0.01f * std::sin(x * 0.21f + y * 0.13f));
            return V3f(x / pixels_ * depth, y / pixels_ * depth, depth);
        };
        Motion motion = random_motion({0, 0, z}, o_.motion_pixels * 0.2f);
        motion.turn *= 0.1f;
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                add_patch(16, 16, surface, motion, part(i, nx), part(i + 1, nx), part(j, ny),
                          part(j + 1, ny));
    }
    static float part(int i, int n) { return static_cast<float>(i) / static_cast<float>(n); }

    void add_ball(float radius_pixels, float area) {
        const float z = 8 * std::exp(random(0, 1) * std::log(35.0f / 8));
        const auto width = static_cast<float>(frame.options.width),
                   height = static_cast<float>(frame.options.height);
        const V3f centre((random(-40, width + 40) - width / 2) / pixels_ * z,
                         (random(-40, height + 40) - height / 2) / pixels_ * z, z);
        const float radius = radius_pixels * z / pixels_, k1 = random(3, 9), k2 = random(3, 9),
                    k3 = random(15, 30);
        const Motion motion = random_motion(centre, o_.motion_pixels);
        const auto surface = [&](float u, float v) {
            const float theta = v * 3.1415927f, phi = u * 6.2831853f;
            const V3f n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const float bump = 0.06f * std::sin(k1 * n.x + k2 * n.y) * std::sin(k2 * n.z * 1.3f + 1) +
                               0.015f * std::sin(k3 * n.x) * std::sin(k3 * n.y + 2) * std::sin(k3 * n.z);
            return centre + n * (radius * (1 + bump));
        };
        const float edge = std::sqrt(area);
        const int nv = std::max(1, static_cast<int>(std::ceil(3.1415927f * radius_pixels / edge / 16)));
        for (int j = 0; j < nv; ++j) {
            const float from = part(j, nv), to = part(j + 1, nv);
            const float widest = from < 0.5f && to > 0.5f
                                     ? 1.0f
                                     : std::max(std::sin(from * 3.1415927f), std::sin(to * 3.1415927f));
            const int nu =
                std::max(1, static_cast<int>(std::ceil(6.2831853f * radius_pixels * widest / edge / 16)));
            for (int i = 0; i < nu; ++i)
                add_patch(16, 16, surface, motion, part(i, nu), part(i + 1, nu), from, to);
        }
    }

    void add_balls() {
        const bool small = o_.micropolygons < 5e5;
        add_wall(o_.micropolygons < 3e6 ? 2.0f : 1.0f);
        while (made() < o_.micropolygons) add_ball(random(25, small ? 70 : 130), 0.7f);
    }

    void add_hair() {
        add_wall(4);
        const int balls = std::max(3, static_cast<int>(o_.micropolygons / 5e5));
        const int hairs = static_cast<int>((o_.micropolygons - made()) / 32 / balls);
        for (int ball = 0; ball < balls; ++ball) {
            const float z = random(9, 35), pixel = z / pixels_;
            const V3f centre(random(-0.42f, 0.42f) * static_cast<float>(frame.options.width) * pixel,
                             random(-0.4f, 0.4f) * static_cast<float>(frame.options.height) * pixel, z);
            const float radius = random(50, 90) * pixel;
            const Motion motion = random_motion(centre, o_.motion_pixels);
            for (int hair = 0; hair < hairs; ++hair) add_strand(centre, radius, pixel, motion);
        }
    }

    /// A hair of 40 pixels as two ribbons of 16 micropolygons.
    void add_strand(const V3f& centre, float radius, float pixel, const Motion& motion) {
        const V3f out = random_direction(), root = centre + out * radius;
        const V3f along = (out + V3f(random(-1, 1), random(-1, 1), random(-1, 1)) * 0.7f).normalized();
        const V3f curl(random(-1, 1), random(-1, 1), random(-1, 1));
        const float length = 40 * pixel * random(0.7f, 1.3f);
        const auto place = [&](float t) {
            return root + along * (length * t) + curl * (length * 0.35f * t * t);
        };
        const auto surface = [&](float u, float v) {
            const V3f p = place(u), tangent = (place(u + 0.01f) - place(u - 0.01f)).normalized();
            const V3f side = tangent.cross(p).normalized();
            return p + side * ((v - 0.5f) * 0.8f * pixel * (1 - 0.5f * u));
        };
        add_patch(16, 1, surface, motion, 0, 0.5f, 0, 1);
        add_patch(16, 1, surface, motion, 0.5f, 1, 0, 1);
    }

    SamplingSceneOptions o_;
    float pixels_ = 1;
    size_t made_ = 0;
    std::mt19937 engine_{7};
};

}  // namespace trapeze::testing
