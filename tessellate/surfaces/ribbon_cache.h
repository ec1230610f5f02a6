/// What a thread has made of ribbons of late. Edges along both sides of a ribbon, its interior and its bounds
/// ask for the same rows.
#pragma once

#include <array>

#include "tessellate/surfaces/ribbon_rows.h"
#include "tessellate/topology/surface.h"

namespace trapeze {

/// All that shapes one segment of a ribbon at one motion key.
struct RibbonSegment {
    CurvePiece P, width, N;
    V3f start{0, 0, 0}, end{0, 0, 0};  ///< of a line: what the ribbon spans at its joints
};

/// A few segments and rows, each in the one place where it may be. Direct-mapped: a new row takes the place
/// of what was there. Keys are compared whole, so that a row held for another surface's face cannot be taken:
/// a scratch belongs to one surface.
class RibbonCache final : public SurfaceScratch {
  public:
    /// A row is told by its face, motion key, and the face's v in [0, 1].
    struct Row {
        int face = -1, key = 0;
        float v = 0;
        RibbonRow row;

        bool is(int of_face, int at_key, float at_v) const {
            return face == of_face && key == at_key && v == at_v;
        }
    };
    /// A segment, by its face, motion key and number within the face.
    struct Segment {
        int face = -1, key = 0, number = 0;
        RibbonSegment segment;

        bool is(int of_face, int at_key, int at_number) const {
            return face == of_face && key == at_key && number == at_number;
        }
    };

    /// The most rows that are made together; those of a grid are fewer.
    static constexpr size_t kMostRows = 32;
    /// A row on the way: where it is along its segment, and which of the rows asked for it is.
    struct WantedRow {
        float t = 0;
        size_t number = 0;
    };
    /// Rows asked for, and those of them that were not held.
    std::array<float, kMostRows> v;
    std::array<RibbonRow, kMostRows> rows;
    std::array<WantedRow, kMostRows> wanted;

    /// Multiples of 1/32 have places of their own.
    Row& row_at(float at) { return rows_[static_cast<size_t>(at * 32.99f)]; }
    Segment& segment_at(int key, int number) { return segments_[static_cast<size_t>(number + 4 * key) % 8]; }

  private:
    std::array<Row, 33> rows_;
    std::array<Segment, 8> segments_;
};

}  // namespace trapeze
