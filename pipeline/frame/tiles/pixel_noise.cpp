#include "pipeline/frame/tiles/pixel_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze {
namespace {

constexpr size_t kChannels = 4;

/// Few samples may look as if nothing but main effects were there: some part of the variance is always left.
constexpr float kLeastPart = 1.0f / 16;

/// A half's first samples are spread evenly over the pixel, and a little less so over the lens and the
/// shutter: this part of what changes along them makes no noise (pixel_noise_test measures it).
constexpr float kEvenOnLens = 0.6f, kEvenInTime = 0.75f;

float squared_distance(const float* a, const float* b) {
    float sum = 0;
    for (size_t c = 0; c < kChannels; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

/// The samples' own variance, without bias; from their differences to the first, so that it is 0 where all
/// are alike.
float variance_of(const float* rgba, size_t count) {
    float mean[kChannels] = {}, squares = 0;
    for (size_t s = 1; s < count; ++s)
        for (size_t c = 0; c < kChannels; ++c) {
            const float difference = rgba[kChannels * s + c] - rgba[c];
            mean[c] += difference, squares += difference * difference;
        }
    const auto n = static_cast<float>(count);
    for (const float sum : mean) squares -= sum * sum / n;
    return squares / (kChannels * (n - 1));
}

/// The variance that is left among neighbours: half their mean squared difference. Those that `is_close`
/// denies do not count.
template <class IsClose>
float variance_among(const float* rgba, const std::vector<SamplePair>& pairs, const IsClose& is_close) {
    float sum = 0;
    size_t count = 0;
    for (const SamplePair& pair : pairs) {
        if (!is_close(pair)) continue;
        sum += squared_distance(rgba + kChannels * pair.a, rgba + kChannels * pair.b);
        ++count;
    }
    return count == 0 ? kInfinity : sum / (2 * kChannels * static_cast<float>(count));
}

}  // namespace

PixelNoise pixel_noise(const float* rgba, const float* times, size_t count,
                       const SampleLevels::Neighbours& neighbours, SampleDomains domains) {
    const float all = variance_of(rgba, count);
    if (!(all > 0)) return {};
    if (!(all < kInfinity)) return {kInfinity, 0};
    const auto always = [](const SamplePair&) { return true; };
    const auto explained = [all](float left) { return std::max(0.0f, all - left); };
    const float left_in_pixel = variance_among(rgba, neighbours.pixel, always);
    float noise = all - explained(left_in_pixel);
    if (domains.lens) noise -= kEvenOnLens * explained(variance_among(rgba, neighbours.lens, always));
    if (domains.motion)
        noise -=
            kEvenInTime * explained(variance_among(rgba, neighbours.time, [times](const SamplePair& pair) {
                return std::abs(times[pair.a] - times[pair.b]) < 0.5f;  // not from the last to the first
            }));
    noise = std::max(noise, kLeastPart * all);
    if (!domains.lens && !domains.motion) return {noise, 0};
    // Blur is what places in the pixel tell nothing about.
    const float blurred = std::clamp(2 * left_in_pixel / all - 1, 0.0f, 1.0f);
    return {(1 - blurred) * noise, blurred * noise};
}

}  // namespace trapeze
