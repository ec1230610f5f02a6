#include "tessellate/face_estimates.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "tessellate/measure/lattice_measure.h"
#include "tessellate/split.h"

namespace trapeze {
namespace {

/// Segments of a line that is not split; 0: it is, or wants to be looked at in pieces that are not there.
uint8_t segments_of(const RateEstimate& estimate, const EdgeRate& rate) {
    if (estimate.wants_split(rate.pixels_per_segment)) return 0;
    return static_cast<uint8_t>(estimate.clamped_segments(rate));
}

/// As EdgeCutter measures a whole edge.
uint8_t segments_of_side(const LatticeLine& four, const LatticeLine* eight, int face, const EdgeRate& rate) {
    const RateEstimate coarse = four.of(face);
    if (!(coarse.segments(rate.pixels_per_segment) > kCoarseEdgePieces)) return segments_of(coarse, rate);
    return eight ? segments_of(eight->of(face), rate) : 0;
}

/// The most segments that any of several lines wants; 0 where one is to be split.
uint8_t most_segments(std::span<const LatticeLine> lines, int face, const EdgeRate& rate) {
    uint8_t most = 0;
    for (const LatticeLine& line : lines) {
        const uint8_t segments = segments_of(line.of(face), rate);
        if (segments == 0) return 0;
        most = std::max(most, segments);
    }
    return most;
}

/// As FaceSplitter measures a whole face.
void set_interior(const LatticeLines& lines, int face, const EdgeRate& rate, FaceEstimate& estimate) {
    const auto set = [&](std::span<const LatticeLine> along_u, std::span<const LatticeLine> along_v) {
        estimate.nu = most_segments(along_u, face, rate);
        estimate.nv = most_segments(along_v, face, rate);
        if (estimate.nu == 0 || estimate.nv == 0) estimate.nu = estimate.nv = 0;
    };
    set(lines.two[0], lines.two[1]);
    if (estimate.nu == 0 || std::max(estimate.nu, estimate.nv) > kCoarseLatticePieces)
        set(lines.four[0], lines.four[1]);
}

/// Sides along v are looked at in eight pieces where four want it; those along u have four only, as the
/// lattice has no more points there.
FaceEstimate estimate_of(const LatticeLines& lines, int face, const EdgeRate& rate) {
    FaceEstimate estimate;
    estimate.sides[kBottom] = segments_of_side(lines.four[0][0], nullptr, face, rate);
    estimate.sides[kTop] = segments_of_side(lines.four[0][4], nullptr, face, rate);
    estimate.sides[kLeft] = segments_of_side(lines.four[1][0], &lines.eight[0], face, rate);
    estimate.sides[kRight] = segments_of_side(lines.four[1][4], &lines.eight[1], face, rate);
    set_interior(lines, face, rate, estimate);
    return estimate;
}

}  // namespace

/// In blocks of as many faces as there are lanes; faces that are not wholly in view keep estimates of 0 and
/// are looked at one by one later.
std::vector<FaceEstimate> estimate_faces(const PlacedSurface& surface, const LineMeasure& measure,
                                         const EdgeRate& rate) {
    const int faces = surface.surface().face_count();
    if (!surface.surface().has_lattices() || !measure.measures_lattices()) return {};
    std::vector<FaceEstimate> estimates(static_cast<size_t>(faces));
    constexpr int kBlocksPerTask = 8;
    const int blocks = (faces + FaceLattices::kFaces - 1) / FaceLattices::kFaces;
    tbb::parallel_for(tbb::blocked_range<int>(0, blocks, kBlocksPerTask), [&](const auto& range) {
        FaceLattices lattices;
        LatticeLines lines;
        for (int block = range.begin(); block < range.end(); ++block) {
            const int first = block * FaceLattices::kFaces,
                      count = std::min(faces - first, FaceLattices::kFaces);
            surface.surface().lattices(first, count, lattices);
            measure.of(lattices, surface.camera_from_object(0), lines);
            for (int i = 0; i < count; ++i)
                if (lines.measured >> i & 1) estimates[first + i] = estimate_of(lines, i, rate);
        }
    });
    return estimates;
}

/// Exact comparisons: lines of whole faces run along their sides bit for bit or not at all.
int side_along(const EdgeLine& line) {
    static constexpr float kEnds[4][4] = {{0, 0, 1, 0}, {1, 0, 1, 1}, {0, 1, 1, 1}, {0, 0, 0, 1}};
    for (int side = 0; side < 4; ++side)
        if (line.from == V2f(kEnds[side][0], kEnds[side][1]) &&
            line.to == V2f(kEnds[side][2], kEnds[side][3]))
            return side;
    return -1;
}

}  // namespace trapeze
