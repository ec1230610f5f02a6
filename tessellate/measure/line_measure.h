/// How long lines across a surface count when it is diced. A piece counts as long as it is on the picture:
/// foreshortened (Attribute "dice" "rasterorient" 1, PRMan's default), or as if it were seen square on (0)
/// [decision 0014].
///
/// Foreshortening is not trusted where what is seen edge-on now may be seen from its side as well. Pieces
/// that turn to the viewer while the shutter is open, or to other places of the lens, count as long as they
/// are seen there. Curved pieces are diced so finely that silhouettes are smooth. What both ask for is at
/// most a quarter of the length seen square on.
///
/// Displaced surfaces (they may go anywhere), curves, points, and what leads out of the view count at least a
/// quarter: long pieces that pass under the eye would be in the way of rays all over the picture.
#pragma once

#include <span>

#include "core/scene/camera.h"
#include "tessellate/measure/screen_metric.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// How finely edges are cut: pixels a segment, and bounds on absurd input. The same for all edges and faces
/// of a primitive, or neighbours would not agree.
struct EdgeRate {
    float pixels_per_segment = 1;
    int max_depth = 14;
    int max_intervals = 4096;  ///< then the rest is 16 segments for each interval
    bool binary = false;       ///< numbers of segments are powers of two (Attribute "dice" "binary")
};

/// Lengths of a line's pieces, in pixels and uniform in its parameter: how many segments they want, and
/// whether the line has to be split first, for they are too many, or too uneven to be uniform in the
/// parameter, or too deep.
struct RateEstimate {
    float sum = 0, longest = 0;
    int pieces = 0;
    bool deep =
        false;  ///< one end is so much farther from the eye that a box around it is seen far too large

    /// Takes in the next piece.
    void add(float length) {
        sum += length, ++pieces;
        if (length > longest) longest = length;
    }
    /// Segments that the whole line wants, not rounded.
    float segments(float pixels_per_segment) const { return sum / pixels_per_segment; }
    bool wants_split(float pixels_per_segment) const;
    int clamped_segments(const EdgeRate& rate) const;  ///< 1..16
};

/// Depths of a line's ends of which the ratio is above this make grids that are in the way of rays which
/// pass far from them: trees over grids have axis-aligned boxes.
inline constexpr float kDeepestLine = 1.25f;
/// Lines that are seen to cross the surface's others at less than this sine count less, but not less than so
/// much of their length.
inline constexpr float kSlantedSine = 0.5f, kLeastSlant = 0.3f;

struct PlacedLattices;
struct LatticeLines;

/// The measure of one primitive's lines under one camera. Immutable: threads share it.
class LineMeasure {
  public:
    /// The most pieces of a line, and the most keys at which foreshortening is trusted.
    static constexpr int kMostPieces = 8, kMostKeys = 3;
    static constexpr size_t kMostLengths = 32;

    /// `displaced`: the surface will not lie where it is measured. The surface's attributes say whether
    /// foreshortening counts, unless it is seen `from_all_sides`.
    LineMeasure(const ScreenMetric& metric, const Camera& camera, const PlacedSurface& surface,
                bool displaced, float pixels_per_segment, bool from_all_sides = false);

    /// The estimate from a line's points at the first key, at most kMostPieces pieces: no piece counts less
    /// than it may at the least, so that foreshortened() never wants more.
    RateEstimate of(std::span<const V3f> P) const;

    /// What pieces count of which nothing else is known, from[i] to to[i], at most kMostLengths.
    void lengths(std::span<const V3f> from, std::span<const V3f> to, std::span<float> counted) const;

    /// Whether of(lattices) has the same for many faces as of(P) and foreshortened(P).
    bool measures_lattices() const { return metric_.is_perspective(); }
    /// Lines of many faces at once, where measures_lattices(): from their lattices at the first key, or where
    /// keys() > 0 at those.
    void of(std::span<const PlacedLattices> keys, LatticeLines& lines) const;

    /// Whether a line of this estimate may want fewer segments: by foreshortened().
    bool may_want_less(const RateEstimate& estimate) const {
        return keys_ > 0 && (estimate.segments(rate_) > 1 || estimate.wants_split(rate_));
    }
    /// The number of keys at which foreshortened() wants the points, from the first on.
    int keys() const { return keys_; }
    /// The estimate that trusts foreshortening, from P[key * points + i]; at least four pieces, so that no
    /// bend of a cubic curve is missed. `beside`: points of the surface beside them, across the line, as
    /// many.
    RateEstimate foreshortened(std::span<const V3f> P, std::span<const V3f> beside) const;

  private:
    float lens_angle(const V3f& p) const;
    float slant(const V3f& p, const V3f& along, const V3f& across) const;

    const ScreenMetric& metric_;
    float least_;     ///< of a piece's length seen square on
    int keys_;        ///< 0: never less than that
    float flatness_;  ///< pixels by which a curve may pass its segment
    float rate_;
    float lens_radius_;  ///< perspective: of the lens; orthographic: of that over the distance in focus
    bool perspective_;
};

}  // namespace trapeze
