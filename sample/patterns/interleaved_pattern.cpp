#include "sample/patterns/interleaved_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "sample/patterns/magic_square.h"
#include "sample/patterns/strata.h"

namespace trapeze {
namespace {

/// Which number of an index; part of what is hashed.
enum Dimension : uint32_t { kSubpixel, kLens, kTime, kPairing, kAssignment };

/// Rounds towards minus infinity: pixels may be negative, beyond the picture by the filter's radius.
int floor_divided(int at, int by) {
    return (at >= 0 ? at : at - by + 1) / by;
}

/// Unjittered places in the unit square: one in each of side * side parts of each of nx * ny regions, no two
/// with the same x or y.
class SpreadSquare {
  public:
    SpreadSquare(int nx, int ny, int side, uint32_t seed)
        : nx_(nx),
          side_(side),
          seed_(seed),
          columns_(hashed_permutation(static_cast<size_t>(nx) * side, hash(seed, 0))),
          rows_(hashed_permutation(static_cast<size_t>(ny) * side, hash(seed, 1))) {}

    /// Groups take turns in the parts of a region.
    V2f at(uint32_t region, uint32_t group) const {
        const auto nx = static_cast<uint32_t>(nx_), side = static_cast<uint32_t>(side_);
        // A permutation for each region: group g takes its g-th part, so that together groups fill all parts.
        const uint32_t part = hashed_permutation(size_t{side} * side, hash(seed_, 2, region))[group];
        const uint32_t column = region % nx * side + part % side, row = region / nx * side + part / side;
        return {place(column, middle(rows_, row), static_cast<int>(columns_.size())),
                place(row, middle(columns_, column), static_cast<int>(rows_.size()))};
    }

  private:
    static float middle(const std::vector<uint32_t>& order, uint32_t index) {
        return (static_cast<float>(order[index]) + 0.5f) / static_cast<float>(order.size());
    }

    int nx_, side_;
    uint32_t seed_;
    std::vector<uint32_t> columns_, rows_;
};

/// Subpixel region -> region of another domain, differing from group to group. Rows and columns are shuffled
/// whole, which keeps what the base has by rows and by columns.
std::vector<uint32_t> pairing(const std::vector<uint32_t>& base, int nx, int ny, uint32_t seed) {
    const std::vector<uint32_t> columns = hashed_permutation(static_cast<size_t>(nx), hash(seed, 0));
    const std::vector<uint32_t> rows = hashed_permutation(static_cast<size_t>(ny), hash(seed, 1));
    std::vector<uint32_t> to(base.size());
    for (size_t i = 0; i < to.size(); ++i)
        to[i] = base[rows[i / columns.size()] * columns.size() + columns[i % columns.size()]];
    return to;
}

}  // namespace

InterleavedPattern::InterleavedPattern(const RenderContext& context, int side)
    : SamplePattern(context), side_(side) {
    make_tuples();
}

/// For each group a tuple of each region of the pixel. Lens and time regions go with them by the magic square
/// with rows and columns shuffled in another way for each group, so that groups do not repeat one
/// correlation.
void InterleavedPattern::make_tuples() {
    const auto samples = static_cast<uint32_t>(sample_count()), groups = static_cast<uint32_t>(group_count());
    const SpreadSquare subpixels(nx_, ny_, side_, hash(seed_, kSubpixel)),
        lens(nx_, ny_, side_, hash(seed_, kLens));
    // Rows and columns of a magic square may be shuffled: their sums stay.
    const std::vector<uint32_t> base =
        nx_ == ny_ && nx_ >= 3 ? magic_square(nx_) : hashed_permutation(samples, hash(seed_, kPairing));
    for (uint32_t group = 0; group < groups; ++group) {
        const auto lens_of = pairing(base, nx_, ny_, hash(seed_, kPairing, kLens, group));
        const auto time_of = pairing(base, nx_, ny_, hash(seed_, kPairing, kTime, group));
        for (uint32_t s = 0; s < samples; ++s) {
            SampleTuple tuple{};
            const V2f in_pixel = subpixels.at(s, group);
            tuple.x = in_pixel.x, tuple.y = in_pixel.y;
            if (camera_.has_lens()) {
                const V2f in_square = lens.at(lens_of[s], group);
                const V2f on_lens = lens_.from_square(in_square.x, in_square.y);
                tuple.lens_u = on_lens.x, tuple.lens_v = on_lens.y;
            }
            if (motion_) {
                const uint32_t part = hashed_permutation(groups, hash(seed_, kTime, time_of[s]))[group];
                tuple.time = place(time_of[s] * groups + part, 0.5f, tuple_count());
            }
            tuples_.push_back(tuple);
        }
    }
}

/// A shuffle of the groups over the pixels of a block, from the block's place alone: the same whichever tile
/// of the picture asks, and other blocks look unrelated. The product's upper half scales a hash to the range
/// without a division.
InterleavedPattern::Groups InterleavedPattern::groups_of_tile(int tx, int ty) const {
    Groups groups;
    const auto count = static_cast<uint32_t>(group_count());
    for (uint32_t i = 0; i < count; ++i) groups[i] = static_cast<uint8_t>(i);
    const uint32_t tile_hash =
        hash(hash(seed_, kAssignment), static_cast<uint32_t>(tx), static_cast<uint32_t>(ty));
    for (uint32_t left = count; left > 1; --left) {  // [Fisher, Yates]
        const uint64_t bits = hash(tile_hash + left);
        std::swap(groups[left - 1], groups[bits * left >> 32]);
    }
    return groups;
}

float InterleavedPattern::coordinate(int pixel, float fraction) {
    return within_pixel(pixel, fraction);
}

/// Blocks start at multiples of their side, not at the tile's corner, so they are cut where tiles end.
void InterleavedPattern::make_tile(const PixelRect& pixels, SampleTile& tile) const {
    begin_tile(pixels, tile);
    for (int ty = floor_divided(pixels.y0, side_); ty * side_ < pixels.y1; ++ty)
        for (int tx = floor_divided(pixels.x0, side_); tx * side_ < pixels.x1; ++tx) {
            const Groups groups = groups_of_tile(tx, ty);
            for (int i = 0; i < group_count(); ++i) {
                const int px = tx * side_ + i % side_, py = ty * side_ + i / side_;
                if (px < pixels.x0 || px >= pixels.x1 || py < pixels.y0 || py >= pixels.y1) continue;
                make_pixel(px, py, groups[static_cast<size_t>(i)], tile);
            }
        }
}

/// Sample s of the pixel is tuple s of its group: no random number is drawn for a pixel.
void InterleavedPattern::make_pixel(int px, int py, int group, SampleTile& tile) const {
    size_t at = tile.first_of_pixel(px, py);
    for (int s = 0; s < sample_count(); ++s, ++at) {
        const SampleTuple& t = tuple(group * sample_count() + s);
        tile.x[at] = coordinate(px, t.x), tile.y[at] = coordinate(py, t.y);
        tile.lens_u[at] = t.lens_u, tile.lens_v[at] = t.lens_v;
        tile.time[at] = t.time;
        tile.rays[at] = camera_.ray(tile.x[at], tile.y[at], t.lens_u, t.lens_v, t.time);
    }
}

}  // namespace trapeze
