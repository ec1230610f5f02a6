#include "sample/patterns/sample_levels.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/random.h"
#include "sample/patterns/strata.h"

namespace trapeze {
namespace {

/// Exchanges that are tried for each cell's samples, fewer where there are many cells.
constexpr uint32_t kMostSweeps = 400, kMostExchanges = 1u << 20;
/// What an exchange may cost at first, in the measure of Quarters; falls to nothing.
constexpr float kFirstTemperature = 12;

/// Parts some samples, one in each square of `side` regions of the pixel, into four quarters with one in each
/// square of twice the side. Which of a square's four goes where is found by exchanging two of them at a time
/// [Kirkpatrick83], so that a quarter's samples spread over the lens, over the shutter, and, in each quadrant
/// of the pixel or the lens, over the others: filters weigh the quadrants of a pixel unlike.
class Quarters {
  public:
    Quarters(const PixelStrata& strata, int side, const std::vector<uint32_t>& members, uint32_t seed)
        : strata_(strata),
          side_(2 * side),
          columns_(static_cast<uint32_t>(strata.nx / side_)),
          rows_(static_cast<uint32_t>(strata.ny / side_)),
          cells_(columns_ * rows_),
          of_cell_(cells_),
          places_(static_cast<size_t>(strata.nx) * static_cast<size_t>(strata.ny)) {
        std::vector<uint32_t> filled(cells_, 0);
        for (const uint32_t sample : members) {
            const uint32_t cell = square_of(sample);
            of_cell_[cell][filled[cell]++] = sample;
            places_[sample] = places_of(sample);
        }
        for (auto& counts : counts_) counts.assign(kSpreads * size_t{cells_}, 0);
        for (auto& four : of_cell_)
            for (size_t q = 0; q < 4; ++q) count(q, four[q], 1);
        anneal(seed);
    }

    /// A quarter's samples, ascending.
    std::vector<uint32_t> operator[](size_t quarter) const {
        std::vector<uint32_t> samples;
        for (const auto& four : of_cell_) samples.push_back(four[quarter]);
        std::ranges::sort(samples);
        return samples;
    }

  private:
    /// What samples are spread over: cells of the lens, parts of the shutter; quadrants of the pixel with
    /// cells of the lens four times as large and with parts of the shutter four times as long, quadrants of
    /// the lens with such parts; columns and rows of half the width of cells, of the pixel and of the lens,
    /// since edges run along them.
    static constexpr size_t kSpreads = 9;
    static constexpr std::array<int, kSpreads> kWeights{4, 6, 2, 2, 1, 3, 3, 2, 2};
    using Places = std::array<uint32_t, kSpreads>;

    uint32_t square_of(uint32_t region) const {
        const auto nx = static_cast<uint32_t>(strata_.nx), side = static_cast<uint32_t>(side_);
        return region / nx / side * columns_ + region % nx / side;
    }
    uint32_t quadrant_of(uint32_t square) const {
        return (2 * (square / columns_) >= rows_ ? 2u : 0u) + (2 * (square % columns_) >= columns_ ? 1u : 0u);
    }
    /// Squares of twice the side.
    uint32_t larger_square_of(uint32_t square) const {
        return square / columns_ / 2 * ((columns_ + 1) / 2) + square % columns_ / 2;
    }
    Places places_of(uint32_t sample) const {
        const uint32_t pixel = square_of(sample), lens = square_of(strata_.lens_of[sample]),
                       time = strata_.time_of[sample] / static_cast<uint32_t>(side_ * side_);
        // Where sides are odd the last places are shared.
        const uint32_t quarter = std::max(1u, cells_ / 4);
        const auto joint = [&](uint32_t quadrant, uint32_t place) {
            return std::min(quadrant * quarter + place, cells_ - 1);
        };
        const auto columns = static_cast<uint32_t>(strata_.nx), half = static_cast<uint32_t>(side_ / 2);
        const auto column_of = [&](uint32_t region) { return std::min(region % columns / half, cells_ - 1); };
        const auto row_of = [&](uint32_t region) { return std::min(region / columns / half, cells_ - 1); };
        return {lens,
                time,
                joint(quadrant_of(pixel), larger_square_of(lens)),
                joint(quadrant_of(pixel), time / 4),
                joint(quadrant_of(lens), time / 4),
                column_of(sample),
                row_of(sample),
                column_of(strata_.lens_of[sample]),
                row_of(strata_.lens_of[sample])};
    }

    /// Adds a sample to what its quarter has in each of its places, or takes it away (`by` -1).
    void count(size_t quarter, uint32_t sample, int by) {
        for (size_t i = 0; i < kSpreads; ++i) counts_[quarter][kSpreads * places_[sample][i] + i] += by;
    }
    /// How many others a quarter has where a sample is.
    int crowd(size_t quarter, uint32_t sample) const {
        int sum = 0;
        for (size_t i = 0; i < kSpreads; ++i)
            sum += kWeights[i] * counts_[quarter][kSpreads * places_[sample][i] + i];
        return sum;
    }

    /// Simulated annealing with a temperature that falls evenly to 0. All exchanges of a sweep are tried in a
    /// fixed order by hashed numbers: the result depends on the seed alone.
    void anneal(uint32_t seed) {
        const uint32_t sweeps = std::clamp(kMostExchanges / (6 * cells_), 1u, kMostSweeps);
        uint32_t random = seed;
        for (uint32_t sweep = 0; sweep < sweeps; ++sweep) {
            const float temperature =
                kFirstTemperature * (1 - static_cast<float>(sweep + 1) / static_cast<float>(sweeps));
            for (auto& four : of_cell_)
                for (size_t p = 0; p < 4; ++p)
                    for (size_t q = p + 1; q < 4; ++q)
                        exchange(p, q, temperature * unit_float(random = hash(random)), four);
        }
    }
    /// Exchanges a cell's samples of two quarters unless they then lie among more than `most` others more.
    void exchange(size_t p, size_t q, float most, std::array<uint32_t, 4>& four) {
        const uint32_t a = four[p], b = four[q];
        count(p, a, -1), count(q, b, -1);
        const int stay = crowd(p, a) + crowd(q, b), go = crowd(p, b) + crowd(q, a);
        if (static_cast<float>(go - stay) <= most) std::swap(four[p], four[q]);
        count(p, four[p], 1), count(q, four[q], 1);
    }

    const PixelStrata& strata_;
    int side_;
    uint32_t columns_, rows_, cells_;
    std::vector<std::array<uint32_t, 4>> of_cell_;  ///< cell of the pixel -> quarter -> sample
    std::vector<Places> places_;                    ///< by sample
    std::array<std::vector<int>, 4> counts_;        ///< by quarter; by place, then spread
};

/// For each sample the one nearest on the lens' square, each pair once. Quadratic in the samples of a pixel,
/// and done once for a pattern.
std::vector<SamplePair> lens_neighbours(const PixelStrata& strata, const std::vector<uint32_t>& samples) {
    const auto nx = static_cast<uint32_t>(strata.nx);
    const auto place = [&](uint32_t sample, int& x, int& y) {
        const uint32_t region = strata.lens_of[sample];
        x = static_cast<int>(region % nx), y = static_cast<int>(region / nx);
    };
    std::vector<size_t> nearest(samples.size());
    for (size_t a = 0; a < samples.size(); ++a) {
        int ax, ay, least = std::numeric_limits<int>::max();
        place(samples[a], ax, ay);
        for (size_t b = 0; b < samples.size(); ++b) {
            int bx, by;
            place(samples[b], bx, by);
            const int distance = (ax - bx) * (ax - bx) + (ay - by) * (ay - by);
            if (b != a && distance < least) least = distance, nearest[a] = b;
        }
    }
    std::vector<SamplePair> pairs;
    for (size_t a = 0; a < samples.size(); ++a)
        if (nearest[nearest[a]] != a || a < nearest[a])
            pairs.push_back({static_cast<uint16_t>(a), static_cast<uint16_t>(nearest[a])});
    return pairs;
}

/// Each sample and the next in time. Pixels move times round by a shift of their own, so the last and the
/// first may be neighbours, too, and whoever asks looks at the times.
std::vector<SamplePair> time_neighbours(const PixelStrata& strata, const std::vector<uint32_t>& samples) {
    std::vector<uint16_t> order(samples.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<uint16_t>(i);
    std::ranges::sort(order, {}, [&](uint16_t i) { return strata.time_of[samples[i]]; });
    std::vector<SamplePair> pairs;
    for (size_t i = 0; i < order.size(); ++i) pairs.push_back({order[i], order[(i + 1) % order.size()]});
    return pairs;
}

/// The samples of cells side by side and one above the other, of squares of `side` regions. Samples are
/// subpixel regions here: a region's number is its place, row by row.
std::vector<SamplePair> pixel_neighbours(const PixelStrata& strata, int side,
                                         const std::vector<uint32_t>& samples) {
    const auto nx = static_cast<uint32_t>(strata.nx), step = static_cast<uint32_t>(side);
    std::vector<SamplePair> pairs;
    for (size_t a = 0; a < samples.size(); ++a)
        for (size_t b = a + 1; b < samples.size(); ++b) {
            const int dx =
                          static_cast<int>(samples[a] % nx / step) - static_cast<int>(samples[b] % nx / step),
                      dy =
                          static_cast<int>(samples[a] / nx / step) - static_cast<int>(samples[b] / nx / step);
            if (dx * dx + dy * dy == 1) pairs.push_back({static_cast<uint16_t>(a), static_cast<uint16_t>(b)});
        }
    return pairs;
}

/// The samples of each level, of a variant: the first digits of its number, to the base 4, choose the
/// quarters.
class LevelSets {
  public:
    LevelSets(const PixelStrata& strata, int levels, uint32_t seed) : sets_(static_cast<size_t>(levels)) {
        std::vector<uint32_t> whole(static_cast<size_t>(strata.nx) * static_cast<size_t>(strata.ny));
        std::iota(whole.begin(), whole.end(), 0u);
        sets_.back().push_back(std::move(whole));
        for (int side = 1; --levels > 0; side *= 2) {
            const auto level = static_cast<size_t>(levels);
            for (const auto& set : sets_[level]) {
                auto& below = sets_[level - 1];
                const auto number = static_cast<uint32_t>(below.size());
                const Quarters quarters(strata, side, set, hash(seed, static_cast<uint32_t>(levels), number));
                for (size_t q = 0; q < 4; ++q) below.push_back(quarters[q]);
            }
        }
    }
    const std::vector<uint32_t>& of(size_t variant, int level) const {
        return sets_[static_cast<size_t>(level)][variant >> 2 * level];
    }
    /// Without those of the level below.
    std::vector<uint32_t> added(size_t variant, int level) const {
        if (level == 0) return of(variant, 0);
        std::vector<uint32_t> more;
        std::ranges::set_difference(of(variant, level), of(variant, level - 1), std::back_inserter(more));
        return more;
    }

  private:
    std::vector<std::vector<std::vector<uint32_t>>> sets_;  ///< by level, then first digits of the variant
};

}  // namespace

/// Made once for a pattern, before any pixel: from the whole pattern downwards, each set parted into
/// quarters, until single levels are left.
SampleLevels::SampleLevels(const PixelStrata& strata, int levels, uint32_t seed)
    : levels_(levels), all_(static_cast<size_t>(strata.nx) * static_cast<size_t>(strata.ny)) {
    const LevelSets sets(strata, levels, seed);
    for (size_t variant = 0; variant < variants(); ++variant) {
        for (int level = 0; level < levels; ++level) added_.push_back(sets.added(variant, level));
        const std::vector<uint32_t>& first = sets.of(variant, 0);
        neighbours_.push_back({pixel_neighbours(strata, 1 << top(), first), lens_neighbours(strata, first),
                               time_neighbours(strata, first)});
    }
}

}  // namespace trapeze
