#include "sample/interleave/uvt_tile.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace trapeze {
namespace {

/// Keeps the planes of tuples from lying at equal places of cache sets.
constexpr size_t kPlanePadding = 16;

/// Rounds towards minus infinity.
int floor_to_multiple(int at, int of) {
    return (at >= 0 ? at : at - of + 1) / of * of;
}

}  // namespace

/// A ray through lens point l runs from l towards its place on the plane in focus: l / focal distance is what
/// its slope loses.
UvtTuples::UvtTuples(const InterleavedPattern& pattern, const Camera& camera)
    : count(static_cast<size_t>(pattern.tuple_count())) {
    for (auto* plane : {&lens_x, &lens_y, &slope_x, &slope_y, &time}) plane->assign(count + kPadding, 0.0f);
    for (size_t t = 0; t < count; ++t) {
        const SampleTuple& tuple = pattern.tuple(static_cast<int>(t));
        lens_x[t] = tuple.lens_u * camera.lens_radius, lens_y[t] = tuple.lens_v * camera.lens_radius;
        slope_x[t] = lens_x[t] / camera.focal_distance, slope_y[t] = lens_y[t] / camera.focal_distance;
        time[t] = tuple.time;
    }
}

/// Cells are anchored at multiples of the pattern's side in the whole picture, not at the tile: the pattern
/// is the same however the picture is cut.
void UvtTile::build(const PixelRect& pixels, const InterleavedPattern& pattern, const Camera& camera) {
    pixels_ = pixels;
    side_ = pattern.side(), side_shift_ = std::countr_zero(static_cast<unsigned>(side_));
    samples_per_pixel_ = static_cast<size_t>(pattern.sample_count());
    x0_ = floor_to_multiple(pixels.x0, side_), y0_ = floor_to_multiple(pixels.y0, side_);
    width_ = pixels.x1 - x0_, height_ = pixels.y1 - y0_;
    cells_x_ = (width_ + side_ - 1) / side_ + 1;
    cells_y_ = (height_ + side_ - 1) / side_ + 1;
    cell_count_ = static_cast<size_t>(cells_x_) * static_cast<size_t>(cells_y_);
    plane_size_ = (cell_count_ + kPlanePadding - 1) / kPlanePadding * kPlanePadding + kPlanePadding;
    build_cells(pixels, pattern);
    build_rays(pattern, camera);
    clear_hits(pattern);
}

/// Infinitely far where a pixel has the tuple; -infinity where none has, so that no hit is nearer and culling
/// takes the cell for covered.
void UvtTile::clear_hits(const InterleavedPattern& pattern) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    const auto tuples = static_cast<size_t>(pattern.tuple_count());
    depths_.resize(plane_size_ * tuples);
    ids_.assign(plane_size_ * tuples, MicropolygonId::kNone);
    for (size_t t = 0; t < tuples; ++t) {
        const int32_t* pixel = cell_pixels(static_cast<int>(t / samples_per_pixel_));
        float* depth = depths(t);
        for (size_t cell = 0; cell < cell_count_; ++cell)
            depth[cell] = pixel[cell] == kNoPixel ? -kInfinite : kInfinite;
    }
}

/// Which pixel of each cell has which group of tuples; the pattern permutes groups from cell to cell.
void UvtTile::build_cells(const PixelRect& pixels, const InterleavedPattern& pattern) {
    const int group_count = pattern.group_count();
    cell_pixels_.assign(cell_count_ * static_cast<size_t>(group_count), kNoPixel);
    first_tuple_.resize(static_cast<size_t>(pixels.width()) * pixels.height());
    for (int cy = 0; cy * side_ < height_; ++cy)
        for (int cx = 0; cx * side_ < width_; ++cx) {
            const InterleavedPattern::Groups groups =
                pattern.groups_of_tile(x0_ / side_ + cx, y0_ / side_ + cy);
            for (int i = 0; i < group_count; ++i) {
                const int x = cx * side_ + i % side_, y = cy * side_ + i / side_;
                const int px = x0_ + x, py = y0_ + y;
                if (px < pixels.x0 || px >= pixels.x1 || py < pixels.y0 || py >= pixels.y1) continue;
                const size_t group = groups[static_cast<size_t>(i)];
                cell_pixels_[group * cell_count_ + static_cast<size_t>(cy * cells_x_ + cx)] = x | y << 16;
                first_tuple_[static_cast<size_t>(py - pixels.y0) * pixels.width() + (px - pixels.x0)] =
                    static_cast<uint32_t>(group * samples_per_pixel_);
            }
        }
}

/// By the same function as the samples' rays, so that both agree to the bit. Per column and per row instead
/// of per pixel: samples of a tuple have the same place in all of their pixels.
void UvtTile::build_rays(const InterleavedPattern& pattern, const Camera& camera) {
    const auto tuples = static_cast<size_t>(pattern.tuple_count());
    columns_.resize(tuples * static_cast<size_t>(width_));
    rows_.resize(tuples * static_cast<size_t>(height_));
    float *column = columns_.data(), *row = rows_.data();
    for (size_t t = 0; t < tuples; ++t) {
        const SampleTuple& tuple = pattern.tuple(static_cast<int>(t));
        // Each coordinate of a ray depends on the same coordinate of its sample.
        const auto ray = [&](float x, float y) {
            return camera.ray(x, y, tuple.lens_u, tuple.lens_v, tuple.time);
        };
        for (int x = 0; x < width_; ++x) {
            const AxisRay r = ray(InterleavedPattern::coordinate(x0_ + x, tuple.x), 0);
            *column++ = camera.perspective ? r.ux : r.ox;
        }
        for (int y = 0; y < height_; ++y) {
            const AxisRay r = ray(0, InterleavedPattern::coordinate(y0_ + y, tuple.y));
            *row++ = camera.perspective ? r.uy : r.oy;
        }
    }
}

/// A pixel's samples are consecutive tuples, at the same cell of consecutive planes. Pixels of cells that
/// reach out of the tile have no samples in it, and are left out.
void UvtTile::copy_nearest(std::vector<Hit>& nearest) const {
    size_t sample = 0, pixel = 0;
    for (int y = pixels_.y0 - y0_; y < height_; ++y)
        for (int x = pixels_.x0 - x0_; x < width_; ++x, ++pixel) {
            const auto cell = static_cast<size_t>(y / side_ * cells_x_ + x / side_);
            size_t at = first_tuple_[pixel] * plane_size_ + cell;
            for (size_t s = 0; s < samples_per_pixel_; ++s, ++sample, at += plane_size_)
                nearest[sample] = {depths_[at], ids_[at]};
        }
}

}  // namespace trapeze
