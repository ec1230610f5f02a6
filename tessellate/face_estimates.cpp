#include "tessellate/face_estimates.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "tessellate/measure/lattice_measure.h"
#include "tessellate/split.h"

namespace trapeze {
namespace {

/// Segments of a line that is not split; 0: it is.
uint8_t segments_of(const RateEstimate& estimate, const EdgeRate& rate) {
    if (estimate.wants_split(rate.pixels_per_segment)) return 0;
    return static_cast<uint8_t>(estimate.clamped_segments(rate));
}

/// What the lines of a block's faces say of one of them.
class FaceEstimator {
  public:
    FaceEstimator(const LineMeasure& measure, const EdgeRate& rate, const LatticeLines& lines)
        : measure_(measure), rate_(rate), lines_(lines) {}

    FaceEstimate of(int face) const {
        FaceEstimate estimate;
        for (int side = 0; side < 4; ++side) estimate.sides[side] = segments_of_side(side, face);
        set_interior(face, estimate);
        return estimate;
    }

  private:
    /// As EdgeCutter measures a whole edge.
    uint8_t segments_of_side(int side, int face) const {
        const LatticeLengths &lengths = lines_.lengths, &seen = lines_.seen;
        const RateEstimate four = lengths.side_four[side].of(face);
        const bool fine = four.segments(rate_.pixels_per_segment) > kCoarseEdgePieces;
        const RateEstimate estimate = fine ? lengths.side_eight[side].of(face) : four;
        if (!measure_.may_want_less(estimate)) return segments_of(estimate, rate_);
        return segments_of((fine ? seen.side_eight : seen.side_four)[side].of(face), rate_);
    }

    /// The segments that the lines along an axis want.
    struct Want {
        bool split = false, less = false;
        uint8_t segments = 1;
    };
    Want most(std::span<const LatticeLine> lines, int face) const {
        Want want;
        for (const LatticeLine& line : lines) {
            const RateEstimate estimate = line.of(face);
            const uint8_t segments = segments_of(estimate, rate_);
            want.split |= segments == 0;
            want.less |= measure_.may_want_less(estimate);
            want.segments = std::max(want.segments, segments);
        }
        return want;
    }

    /// As FaceSplitter measures a whole face.
    void set_interior(int face, FaceEstimate& estimate) const {
        Want u = most(lines_.two[0], face), v = most(lines_.two[1], face);
        if (std::max(u.segments, v.segments) > kCoarseLatticePieces || u.split || v.split)
            u = most(lines_.lengths.four[0], face), v = most(lines_.lengths.four[1], face);
        if (u.less || v.less) u = most(lines_.seen.four[0], face), v = most(lines_.seen.four[1], face);
        if (u.split || v.split) return;
        estimate.nu = u.segments, estimate.nv = v.segments;
    }

    const LineMeasure& measure_;
    const EdgeRate& rate_;
    const LatticeLines& lines_;
};

/// The motion keys at which lines are measured, where each is a shape key of its own; else none.
std::vector<int> shape_keys_of(const PlacedSurface& surface, int keys) {
    std::vector<int> shape_keys;
    for (int key = 0; key < keys; ++key) {
        const ShapeMix mix = surface.mix_of(key);
        if (mix.to_next != 0) return {};
        shape_keys.push_back(mix.first);
    }
    return shape_keys;
}

/// Of fewer faces most lanes would be empty.
constexpr int kFewestFaces = 4;

/// A task's memory, on its stack: lattices of a block of faces at all keys, and their lines.
struct LatticeBlock {
    std::array<FaceLattices, LineMeasure::kMostKeys> lattices;
    LatticeLines lines;
};

}  // namespace

/// Exact comparisons: lines of whole faces run along their sides bit for bit or not at all.
uint8_t FaceEstimate::segments_of(const EdgeLine& line) const {
    constexpr int kLast = FaceLattices::kSidePoints - 1;
    for (int side = 0; side < 4; ++side)
        if (line.from == FaceLattices::side_uv(runs, side, 0) &&
            line.to == FaceLattices::side_uv(runs, side, kLast))
            return sides[side];
    return 0;
}

/// In blocks of as many faces as there are lanes; faces that are not measured keep estimates of 0 and are
/// looked at one by one later.
std::vector<FaceEstimate> estimate_faces(const PlacedSurface& surface, const LineMeasure& measure,
                                         const EdgeRate& rate, VertexTableMaker& vertices) {
    const int faces = surface.surface().face_count();
    if (faces < kFewestFaces || !surface.surface().has_lattices() || !measure.measures_lattices()) return {};
    const std::vector<int> shape_keys = shape_keys_of(surface, std::max(measure.keys(), 1));
    if (shape_keys.empty()) return {};
    std::vector<FaceEstimate> estimates(static_cast<size_t>(faces));
    const bool rigid = surface.is_rigid();
    constexpr int kBlocksPerTask = 8;
    const int blocks = (faces + FaceLattices::kFaces - 1) / FaceLattices::kFaces;
    tbb::parallel_for(tbb::blocked_range<int>(0, blocks, kBlocksPerTask), [&](const auto& range) {
        LatticeBlock memory;
        LatticeLines& lines = memory.lines;
        std::array<PlacedLattices, LineMeasure::kMostKeys> keys;
        const std::span<PlacedLattices> placed(keys.data(), shape_keys.size());
        for (int block = range.begin(); block < range.end(); ++block) {
            const int first = block * FaceLattices::kFaces,
                      count = std::min(faces - first, FaceLattices::kFaces);
            for (size_t key = 0; key < placed.size(); ++key) {
                placed[key].camera_from_object = surface.camera_from_object(static_cast<int>(key));
                // A shape that only moves is evaluated once.
                const bool again = key > 0 && shape_keys[key] == shape_keys[key - 1];
                placed[key].lattices = again ? placed[key - 1].lattices : &memory.lattices[key];
                if (!again)
                    surface.surface().lattices(first, count, shape_keys[key], measure.keys() > 0,
                                               memory.lattices[key]);
            }
            const FaceLattices& lattices = *placed[0].lattices;
            // Where a block has no face of this kind at all, nothing has been set.
            if (!std::ranges::all_of(placed, [](const PlacedLattices& p) { return p.lattices->there != 0; }))
                continue;
            measure.of(placed, lines);
            if (rigid) vertices.take(first, lattices);
            const FaceEstimator estimator(measure, rate, lines);
            for (int i = 0; i < count; ++i) {
                if (!(lines.measured >> i & 1)) continue;
                FaceEstimate& estimate = estimates[first + i] = estimator.of(i);
                estimate.runs = lattices.runs;
                estimate.bounded = lattices.bounded && rigid;
                for (int k = 0; k < 3 && estimate.bounded; ++k)
                    estimate.bound.min[k] = lattices.low[k][i], estimate.bound.max[k] = lattices.high[k][i];
            }
        }
    });
    return estimates;
}

void cut_estimates(const PlacedSurface& surface, const FlatCuts& cuts, std::span<FaceEstimate> estimates) {
    constexpr size_t kFacesAtOnce = 1024;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, estimates.size(), kFacesAtOnce), [&](const auto& range) {
        EvaluationScratch scratch;
        for (size_t i = range.begin(); i < range.end(); ++i) {
            FaceEstimate& estimate = estimates[i];
            const int face = static_cast<int>(i);
            if (estimate.nu == 0 || !cuts.may_cut(surface.surface(), face)) continue;
            std::array<V3f, 4> corners;
            surface.positions(face, kFaceCorners, 1, scratch, corners);
            const std::array<int, 2> wanted = cuts.segments(corners, {estimate.nu, estimate.nv});
            if (wanted[0] > estimate.nu || wanted[1] > estimate.nv) estimate.nu = estimate.nv = 0;
        }
    });
}

}  // namespace trapeze
