/// Points of several faces at once, by which they are measured. Lanes are faces.
#pragma once

#include <cstdint>

#include "core/math.h"

namespace trapeze {

/// How an edge runs along the side of the face that it is evaluated on.
enum class SideRun : uint8_t {
    Up,    ///< with growing u or v
    Down,  ///< against it
    Over,  ///< up, and as far again over the face's border
};

/// How edges run along all sides of a face.
enum class FaceRuns : uint8_t {
    Upwards,  ///< along all of them
    Round,    ///< of faces of meshes: down at v = 1 and u = 0
    Piece,    ///< of mesh faces that are cut: over the border at v = 0 (mesh_topology.h)
};
inline constexpr int kFaceRuns = 3;

/// `side` by SideName.
constexpr SideRun run_of(FaceRuns runs, int side) {
    if (runs == FaceRuns::Round && side >= 2) return SideRun::Down;
    return runs == FaceRuns::Piece && side == 0 ? SideRun::Over : SideRun::Up;
}

/// Points in object space at one shape key: those of lines along both axes, of the edges along the sides, and
/// of lines a little inside of these.
struct FaceLattices {
    /// Faces at once; lines along either axis; points of a side's edge.
    static constexpr int kFaces = 16, kLines = 5, kSidePoints = 9;
    /// From an edge to the points beside it, in the face's parameters.
    static constexpr float kBeside = 1.0f / 16384;
    static constexpr int kFirstSide = kLines * kLines, kFirstBeside = kFirstSide + 4 * kSidePoints,
                         kPoints = kFirstBeside + 4 * kSidePoints;

    /// One point of each face, coordinate by coordinate.
    using Point = float[3][kFaces];

    alignas(64) Point points[kPoints];
    Point low, high;  ///< corners of Surface::bound() of the whole face, where `bounded`
    bool bounded = false;
    FaceRuns runs = FaceRuns::Upwards;  ///< of all the faces
    uint32_t there = 0;                 ///< the faces that have points, a bit each

    /// Numbers of points: at v = row / 4 and u = column / 4; point i of an edge, `side` by SideName; the one
    /// beside that, which is there only where it was asked for.
    static constexpr int inner(int row, int column) { return row * kLines + column; }
    static constexpr int side(int side, int i) { return kFirstSide + side * kSidePoints + i; }
    static constexpr int beside(int side, int i) { return kFirstBeside + side * kSidePoints + i; }

    static V2f inner_uv(int row, int column) {
        return {static_cast<float>(column) / (kLines - 1), static_cast<float>(row) / (kLines - 1)};
    }
    static V2f side_uv(FaceRuns runs, int side, int i) { return on_side(runs, side, i, 0); }
    static V2f beside_uv(FaceRuns runs, int side, int i) { return on_side(runs, side, i, kBeside); }

    /// The parameters of a point by its number.
    static V2f uv(FaceRuns runs, int number) {
        if (number < kFirstSide) return inner_uv(number / kLines, number % kLines);
        const bool is_beside = number >= kFirstBeside;
        const int of_side = number - (is_beside ? kFirstBeside : kFirstSide);
        return on_side(runs, of_side / kSidePoints, of_side % kSidePoints, is_beside ? kBeside : 0.0f);
    }

  private:
    static V2f on_side(FaceRuns runs, int side, int i, float inside) {
        const float step = static_cast<float>(i) / (kSidePoints - 1);
        const SideRun run = run_of(runs, side);
        const float along = run == SideRun::Up ? step : run == SideRun::Down ? 1 - step : 2 * step;
        switch (side) {
            case 0:
                return {along, inside};
            case 1:
                return {1 - inside, along};
            case 2:
                return {along, 1 - inside};
            default:
                return {inside, along};
        }
    }
};

}  // namespace trapeze
