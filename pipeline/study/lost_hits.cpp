#include "pipeline/study/lost_hits.h"

#include <algorithm>

namespace trapeze {
namespace {

/// How bright what is right remains beside the marks.
constexpr float kRemaining = .25f;

bool same_pixel(const Image& a, const Image& b, size_t pixel) {
    return std::equal(&a.rgba[4 * pixel], &a.rgba[4 * pixel] + 4, &b.rgba[4 * pixel]);
}

}  // namespace

size_t pixels_that_differ(const Image& a, const Image& b) {
    size_t count = 0;
    for (size_t pixel = 0; pixel < a.rgba.size() / 4; ++pixel) count += !same_pixel(a, b, pixel);
    return count;
}

StudyCloseUps pictures_of_lost_hits(const std::string& scene, const Image& right, const Image& wrong) {
    LinearPicture marked = part_of(wrong, wrong.window);
    for (size_t pixel = 0; pixel < marked.rgb.size() / 3; ++pixel) {
        float* const rgb = &marked.rgb[3 * pixel];
        if (same_pixel(right, wrong, pixel))
            for (int c = 0; c < 3; ++c) rgb[c] *= kRemaining;
        else
            rgb[0] = 1, rgb[1] = rgb[2] = 0;
    }
    StudyCloseUps pictures{
        scene + ": hits that naive clipping loses", {}, "The whole picture; hits that are lost are marked."};
    pictures.pictures.emplace_back("clipped polygons", part_of(right, right.window));
    pictures.pictures.emplace_back("naive clipping", part_of(wrong, wrong.window));
    pictures.pictures.emplace_back("naive clipping, lost hits in red", std::move(marked));
    return pictures;
}

}  // namespace trapeze
