#include "pipeline/rays/ray_places.h"

#include <Imath/ImathBoxAlgo.h>

#include <cmath>

#include "core/hyper_trapezoid.h"

namespace trapeze {
namespace {

Imath::Box3f box_of(const GridExtent& extent) {
    const KeyBounds& at = extent.box.at[0];
    return {V3f(at.low[0], at.low[1], at.low[2]), V3f(at.high[0], at.high[1], at.high[2])};
}

KeyBounds bounds_of(const Imath::Box3f& box) {
    KeyBounds bounds;
    for (int k = 0; k < 3; ++k) bounds.low[k] = box.min[k], bounds.high[k] = box.max[k];
    return bounds;
}

/// How much longer a space makes things, at most.
float most_stretch(const M44d& m) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += m[i][j] * m[i][j];
    return static_cast<float>(std::sqrt(sum));
}

/// Camera space. Grown by what rounds on the way there and of rays on the way back; the larger of both spaces
/// counts, for rays come from far away in either.
GridExtent placed(const GridExtent& extent, const ObjectPlace& place) {
    GridExtent out{};
    out.absolute_max = 0;
    const std::vector<M44d>& poses = place.camera_from_shared;
    Imath::Box3f ends[2], all;
    for (size_t key = 0; key < poses.size(); ++key) {
        Imath::Box3f box = Imath::transform(box_of(extent), poses[key]);
        const float stretch = most_stretch(poses[key]);
        const float pad = kTraceRounding * (largest_coordinate(box) + stretch * extent.absolute_max);
        box.min -= V3f(pad), box.max += V3f(pad);
        out.absolute_max = std::max(out.absolute_max, largest_coordinate(box));
        out.largest_micropolygon = std::max(out.largest_micropolygon, stretch * extent.largest_micropolygon);
        if (key == 0) ends[0] = box;
        ends[1] = box;
        all.extendBy(box);
    }
    // Between more than two keys the way is bent: it stays in the box about all of them.
    const bool bent = poses.size() > 2;
    for (int end = 0; end < 2; ++end) out.box.at[end] = bounds_of(bent ? all : ends[end]);
    if (!std::isfinite(extent.absolute_max)) out.absolute_max = extent.absolute_max;
    return out;
}

std::vector<uint32_t> numbers_of(std::span<const ObjectPlace> places,
                                 std::span<const std::optional<GridExtent>> extents) {
    std::vector<uint32_t> numbers;
    for (uint32_t i = 0; i < places.size(); ++i)
        if (extents[places[i].object]) numbers.push_back(i);
    return numbers;
}

std::vector<GridExtent> all_placed(std::span<const ObjectPlace> places,
                                   std::span<const std::optional<GridExtent>> extents,
                                   std::span<const uint32_t> numbers) {
    std::vector<GridExtent> all;
    for (const uint32_t number : numbers)
        all.push_back(placed(*extents[places[number].object], places[number]));
    return all;
}

}  // namespace

RayPlaces::RayPlaces(std::span<const ObjectPlace> places, std::span<const std::optional<GridExtent>> extents)
    : places_(places), numbers_(numbers_of(places, extents)), tree_(all_placed(places, extents, numbers_)) {}

}  // namespace trapeze
