#include "pipeline/compare/report/viridis.h"

#include <algorithm>

namespace trapeze {

std::array<uint8_t, 3> viridis(float t) {
    // Matt Zucker's least squares fit (public domain), from the constant term up.
    constexpr float kTerms[7][3] = {
        {0.2777273f, 0.0054073f, 0.3340998f},   {0.1050930f, 1.4046135f, 1.3845902f},
        {-0.3308618f, 0.2148476f, 0.0950952f},  {-4.6342305f, -5.7991010f, -19.3324410f},
        {6.2282699f, 14.1799334f, 56.6905526f}, {4.7763850f, -13.7451454f, -65.3530326f},
        {-5.4354559f, 4.6458526f, 26.3124352f}};
    const float x = std::clamp(t, 0.0f, 1.0f);
    std::array<uint8_t, 3> rgb;
    for (size_t c = 0; c < 3; ++c) {
        float value = 0;
        for (int k = 6; k >= 0; --k) value = value * x + kTerms[k][c];
        rgb[c] = static_cast<uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
    }
    return rgb;
}

}  // namespace trapeze
