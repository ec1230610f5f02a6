#include "sample/raytrace/blur_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace trapeze {
namespace {

/// A grid in the picture, at mid-shutter.
struct Seen {
    float z = -1;  ///< not positive: not seen
    float x0, y0, x1, y1;
    float lens, motion, grid;
};

/// No grid is taken for larger, so that near ones do not blot out the map.
constexpr float kLargestReach = 256;

/// What lies this much farther than the nearest of a cell is taken for hidden.
constexpr float kHiddenBeyond = 1.5f;

/// In the picture, of the grid's middle; as far as it is before the camera. In pixels, along straight pieces
/// between keys.
float length_of_way(const Camera& camera, const Grid& grid) {
    if (!grid.moves()) return 0;
    float length = 0;
    V2f last(0, 0);
    for (int key = 0; key < grid.key_count; ++key) {
        const V3f p = grid.vertex_at_key(grid.shape.nu / 2, grid.shape.nv / 2, key, grid.key_count);
        if (!(p.z > 0 || !camera.perspective)) continue;
        const V2f at = camera.raster_from_camera(p);
        if (key > 0) length += (at - last).length();
        last = at;
    }
    return length;
}

/// Taken at the middle of the shutter, by corners and the middle vertex: a map for choosing orders wants
/// speed and no bounds.
Seen look_at(const Camera& camera, const Grid& grid) {
    Seen seen;
    const int nu = grid.shape.nu, nv = grid.shape.nv;
    const V3f open = grid.vertex(nu / 2, nv / 2, 0),
              close = grid.moves() ? grid.vertex(nu / 2, nv / 2, 1) : open;
    const V3f middle = 0.5f * (open + close);
    const float nearest = std::max(camera.near_clip, std::numeric_limits<float>::min());
    if (!(std::min(open.z, close.z) >= nearest && middle.z <= camera.far_clip)) return seen;
    const V2f at = camera.raster_from_camera(middle), confusion = camera.circle_of_confusion(middle.z);
    const V2f scale = camera.pixels_per_length(middle.z);
    const V3f diagonal = grid.vertex(nu, nv, 0) - grid.vertex(0, 0, 0);
    const float side = std::abs(scale.x) * diagonal.length() * 0.71f;
    seen.z = middle.z;
    seen.lens = 2 * std::max(std::abs(confusion.x), std::abs(confusion.y));
    seen.motion = length_of_way(camera, grid);
    seen.grid = std::clamp(side, 0.5f, kLargestReach);
    const float reach = 0.5f * seen.grid + 0.5f * static_cast<float>(BlurMap::kSide);
    seen.x0 = at.x - reach, seen.x1 = at.x + reach, seen.y0 = at.y - reach, seen.y1 = at.y + reach;
    return seen;
}

/// The cell of a coordinate; what is not a number is in the first.
int cell_of(float raster, int count) {
    const float cell = raster / static_cast<float>(BlurMap::kSide);
    return cell > 0 ? static_cast<int>(std::min(cell, static_cast<float>(count - 1))) : 0;
}

}  // namespace

/// Two rounds over the grids of each cell: first the nearest depth, then the sums over those that are not far
/// behind it. Sums are added in the order of the grids, for any number of threads.
BlurMap::BlurMap(const Camera& camera, const Grids& grids)
    : columns_(std::max(1, (camera.width + kSide - 1) / kSide)),
      rows_(std::max(1, (camera.height + kSide - 1) / kSide)),
      cells_(static_cast<size_t>(columns_) * rows_) {
    std::vector<Seen> all(grids.grids.size());
    tbb::parallel_for(size_t{0}, all.size(), [&](size_t i) { all[i] = look_at(camera, grids.grids[i]); });
    std::vector<float> nearest(cells_.size(), std::numeric_limits<float>::infinity());
    const auto for_cells = [&](const auto& visit) {
        const float right = static_cast<float>(columns_ * kSide), bottom = static_cast<float>(rows_ * kSide);
        for (const Seen& seen : all) {
            if (!(seen.z > 0 && seen.x1 > 0 && seen.y1 > 0 && seen.x0 < right && seen.y0 < bottom)) continue;
            const int x1 = cell_of(seen.x1, columns_), y1 = cell_of(seen.y1, rows_);
            for (int y = cell_of(seen.y0, rows_); y <= y1; ++y)
                for (int x = cell_of(seen.x0, columns_); x <= x1; ++x)
                    visit(seen, static_cast<size_t>(y) * columns_ + x);
        }
    };
    for_cells([&](const Seen& seen, size_t cell) { nearest[cell] = std::min(nearest[cell], seen.z); });
    for_cells([&](const Seen& seen, size_t cell) {
        if (seen.z <= kHiddenBeyond * nearest[cell]) cells_[cell].add(seen.lens, seen.motion, seen.grid);
    });
}

/// All products that a count of grids met by a group of rays can need (Footprint::meets in bundle_order.cpp),
/// so that one sum serves every order that is tried.
void BlurMoments::add(float lens, float motion, float grid) {
    const float inverse = 1 / grid, relative_lens = lens * inverse, relative_motion = motion * inverse;
    one += 1, r += inverse, p += relative_lens, q += relative_motion;
    rr += inverse * inverse, rp += inverse * relative_lens, rq += inverse * relative_motion;
    pp += relative_lens * relative_lens, pq += relative_lens * relative_motion;
}

/// The cell at the middle speaks for the whole tile: what it decides is the order of rays, which changes
/// speed and no hit.
const BlurMoments& BlurMap::at(const PixelRect& pixels) const {
    const auto middle = [](int a, int b) { return 0.5f * (static_cast<float>(a) + static_cast<float>(b)); };
    const int x = cell_of(middle(pixels.x0, pixels.x1), columns_),
              y = cell_of(middle(pixels.y0, pixels.y1), rows_);
    return cells_[static_cast<size_t>(y) * columns_ + x];
}

}  // namespace trapeze
