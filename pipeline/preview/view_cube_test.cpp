#include "pipeline/preview/view_cube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace trapeze {
namespace {

/// A tone curve that mixes channels: what views do.
class ToneCurve final : public ColorTransform {
  public:
    void apply(float* rgba, size_t pixels) const override {
        for (size_t i = 0; i < pixels; ++i, rgba += 4) {
            const float luma = 0.2f * rgba[0] + 0.7f * rgba[1] + 0.1f * rgba[2];
            for (int c = 0; c < 3; ++c) {
                const float v = 0.9f * rgba[c] + 0.1f * luma;
                const float shown = v / (v + 0.6f);
                rgba[c] = shown <= 0.0031308f ? 12.92f * shown : 1.055f * std::pow(shown, 1 / 2.4f) - 0.055f;
            }
        }
    }
};

/// As the page does it.
float at(const ViewCube& cube, const float* rgb, int channel) {
    const float scale =
        static_cast<float>(ViewCube::kSide - 1) / std::log2(ViewCube::kMost / ViewCube::kToe + 1);
    int place[3];
    float part[3];
    for (int c = 0; c < 3; ++c) {
        const float x = std::log2(std::clamp(rgb[c], 0.0f, ViewCube::kMost) / ViewCube::kToe + 1) * scale;
        place[c] = std::min(ViewCube::kSide - 2, static_cast<int>(x));
        part[c] = x - static_cast<float>(place[c]);
    }
    float sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int r = corner & 1, g = (corner >> 1) & 1, b = corner >> 2;
        const float weight =
            (r ? part[0] : 1 - part[0]) * (g ? part[1] : 1 - part[1]) * (b ? part[2] : 1 - part[2]);
        const int index = ((place[2] + b) * ViewCube::kSide + place[1] + g) * ViewCube::kSide + place[0] + r;
        sum += weight * cube.rgb[static_cast<size_t>(3 * index + channel)];
    }
    return sum;
}

TEST(ViewCube, IsTheViewWithinOneOf255) {
    const ToneCurve view;
    const ViewCube cube = bake_view(view);
    ASSERT_EQ(cube.rgb.size(), size_t{3} * ViewCube::kSide * ViewCube::kSide * ViewCube::kSide);
    float worst = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        float rgba[4] = {};
        // From 2^-10 to 2^6, and each channel black now and then.
        for (uint32_t c = 0; c < 3; ++c)
            rgba[c] = hash(i, c, 9) % 16 == 0 ? 0 : std::exp2(16 * unit_float(hash(i, c)) - 10);
        float exact[4] = {rgba[0], rgba[1], rgba[2], 1};
        view.apply(exact, 1);
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(at(cube, rgba, c) - exact[c]));
    }
    EXPECT_LE(worst, 1 / 255.0f);
    EXPECT_GT(worst, 0);
}

}  // namespace
}  // namespace trapeze
