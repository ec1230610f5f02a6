#include "shade/maps/cube_faces.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace trapeze {
namespace {

constexpr float kHalfTurnRadians = 3.14159265f;  ///< radians
constexpr int kSamplesAcross = 2;                ///< samples of a pixel along each axis

/// The axes of a view: what is in its middle, to its right and up.
struct Face {
    V3f forward, right, up;
};
/// The faces of RISpec 3.2, section 7, in its order: +x, -x, +y, -y, +z, -z.
const Face kFaces[6] = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                        {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};

/// Adds a face's bilinear value at x, y (0..1 across the picture and down it) to `sum`.
void add_sample(const Raster& face, float x, float y, float* sum) {
    const auto place = [](float at, int size, int& low, int& high) {
        const float texel =
            std::clamp(at * static_cast<float>(size) - 0.5f, 0.0f, static_cast<float>(size - 1));
        low = static_cast<int>(texel);
        high = std::min(low + 1, size - 1);
        return texel - static_cast<float>(low);
    };
    int x0, x1, y0, y1;
    const float u = place(x, face.width, x0, x1), v = place(y, face.height, y0, y1);
    const float *a = face.at(x0, y0), *b = face.at(x1, y0), *c = face.at(x0, y1), *d = face.at(x1, y1);
    for (int k = 0; k < face.channels; ++k)
        sum[k] += (a[k] * (1 - u) + b[k] * u) * (1 - v) + (c[k] * (1 - u) + d[k] * u) * v;
}

/// Adds what the faces show in a direction. `widening`: tangent of half the faces' field of view.
void add_direction(const std::array<Raster, 6>& faces, float widening, const V3f& d, float* sum) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::fabs(d[k]) > std::fabs(d[axis])) axis = k;
    const int index = 2 * axis + (d[axis] < 0 ? 1 : 0);
    const Face& face = kFaces[index];
    const float scale = 0.5f / (widening * std::fabs(d[axis]));
    add_sample(faces[index], 0.5f + d.dot(face.right) * scale, 0.5f - d.dot(face.up) * scale, sum);
}

}  // namespace

Raster lat_long_from_cube(const std::array<Raster, 6>& faces, float fov) {
    int widest = 1;
    for (const Raster& face : faces) widest = std::max({widest, face.width, face.height});
    Raster out{4 * widest, 2 * widest, faces[0].channels, {}};
    out.pixels.assign(static_cast<size_t>(out.width) * out.height * out.channels, 0.0f);
    const float widening =
        portable::tan((fov >= 90 ? std::min(fov, 170.0f) : 90.0f) * kHalfTurnRadians / 360);
    constexpr float kStep = 1.0f / kSamplesAcross;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            float* sum = out.at(x, y);
            for (int sample = 0; sample < kSamplesAcross * kSamplesAcross; ++sample) {
                const float px =
                    static_cast<float>(x) + (static_cast<float>(sample % kSamplesAcross) + 0.5f) * kStep;
                const float py =
                    static_cast<float>(y) + (static_cast<float>(sample / kSamplesAcross) + 0.5f) * kStep;
                const float longitude = px / static_cast<float>(out.width) * 2 * kHalfTurnRadians;
                const float polar = py / static_cast<float>(out.height) * kHalfTurnRadians;
                const V3f d(portable::sin(polar) * portable::cos(longitude),
                            portable::sin(polar) * portable::sin(longitude), portable::cos(polar));
                add_direction(faces, widening, d, sum);
            }
            for (int k = 0; k < out.channels; ++k) sum[k] *= kStep * kStep;
        }
    return out;
}

}  // namespace trapeze
