/// A tile's samples as the tuples of the interleaved pattern see them: for each tuple a picture of one sample
/// for every k x k pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/hit_buffer.h"
#include "core/samples.h"
#include "sample/patterns/interleaved_pattern.h"

namespace trapeze {

/// What the rays of a tuple share, in planes padded to whole vectors: camera-space length on the lens, and
/// its part of the slope.
struct UvtTuples {
    static constexpr size_t kPadding = 16;

    size_t count = 0;
    std::vector<float> lens_x, lens_y, slope_x, slope_y, time;

    UvtTuples(const InterleavedPattern& pattern, const Camera& camera);
};

/// The k x k cells over a rectangle of pixels, numbered row by row with one more column and row, so that a
/// range of cells may end one past the last.
class UvtTile {
  public:
    /// In cell_pixels() where the group's pixel is not in the rectangle.
    static constexpr int32_t kNoPixel = 0x7fff7fff;

    /// Makes cells, rays and empty hits of a rectangle of pixels; reuses memory.
    void build(const PixelRect& pixels, const InterleavedPattern& pattern, const Camera& camera);

    int cell_side() const { return side_; }
    /// The corner of cell 0; coordinates below are from there.
    int x0() const { return x0_; }
    int y0() const { return y0_; }
    int width() const { return width_; }  ///< to the end of the rectangle
    int height() const { return height_; }
    int cells_x() const { return cells_x_; }
    int cells_y() const { return cells_y_; }

    /// Cell -> the pixel that has a group's tuples, x in the low half, y in the high.
    const int32_t* cell_pixels(int group) const { return cell_pixels_.data() + group * cell_count_; }

    /// The cell that holds a pixel, as cell_pixels() has it.
    size_t cell_of(int32_t pixel) const {
        return static_cast<size_t>((pixel >> 16 >> side_shift_) * cells_x_ +
                                   ((pixel & 0xffff) >> side_shift_));
    }

    /// Column or row -> what depends on it of the rays of a tuple: slope for perspective cameras, else
    /// origin.
    const float* columns(size_t tuple) const { return columns_.data() + tuple * static_cast<size_t>(width_); }
    /// A tuple's rays by rows of the tile: one coordinate for each, as the other depends on the column.
    const float* rows(size_t tuple) const { return rows_.data() + tuple * static_cast<size_t>(height_); }

    /// Cell -> depth of the nearest opaque hit of a tuple's sample: infinity where nothing was hit yet,
    /// -infinity where the tuple has no pixel of the tile.
    float* depths(size_t tuple) { return depths_.data() + tuple * plane_size_; }
    uint64_t* ids(size_t tuple) { return ids_.data() + tuple * plane_size_; }

    /// Copies the nearest opaque hits to nearest[sample], in the order of the rectangle's samples.
    void copy_nearest(std::vector<Hit>& nearest) const;

  private:
    void build_cells(const PixelRect& pixels, const InterleavedPattern& pattern);
    void clear_hits(const InterleavedPattern& pattern);
    void build_rays(const InterleavedPattern& pattern, const Camera& camera);

    int side_shift_ = 0, side_ = 1, x0_ = 0, y0_ = 0, width_ = 0, height_ = 0, cells_x_ = 0, cells_y_ = 0;
    size_t cell_count_ = 0, plane_size_ = 0, samples_per_pixel_ = 1;
    PixelRect pixels_;
    std::vector<int32_t> cell_pixels_;   ///< [group][cell]
    std::vector<uint32_t> first_tuple_;  ///< of pixels of the rectangle
    std::vector<float> columns_, rows_;  ///< [tuple][column or row]
    std::vector<float> depths_;          ///< [tuple][cell]
    std::vector<uint64_t> ids_;
};

}  // namespace trapeze
