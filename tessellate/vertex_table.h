/// Where a surface's vertices are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// Positions of a surface's vertices at all keys, in camera space, each made once.
class VertexTable {
  public:
    VertexTable() = default;
    /// Evaluates all vertices, in parallel.
    explicit VertexTable(const PlacedSurface& surface);

    /// A vertex's key_count positions.
    std::span<const V3f> keys_of(uint32_t vertex) const {
        return {positions_.data() + static_cast<size_t>(vertex) * key_count_, key_count_};
    }
    /// The largest coordinate, by its amount; infinite if one is no number.
    float reach() const;
    size_t bytes() const { return positions_.capacity() * sizeof(V3f); }

  private:
    friend class VertexTableMaker;

    size_t key_count_ = 1;
    std::vector<V3f> positions_;
};

/// Makes a table, in part of lattices that have been made for something else.
class VertexTableMaker {
  public:
    /// The surface outlives the maker.
    explicit VertexTableMaker(const PlacedSurface& surface);

    /// Takes the vertices that are evaluated at corners of faces `first_face` and on, of those that are
    /// there: lattices of the shape at all keys, where it is one (PlacedSurface::is_rigid()). Threads may
    /// take different faces at once.
    void take(int first_face, const FaceLattices& lattices);
    /// Evaluates all others, in parallel, and gives the table away.
    VertexTable finish();

  private:
    const PlacedSurface& surface_;
    std::vector<SurfacePoint> points_;  ///< by vertex
    std::vector<uint32_t> order_;       ///< vertices by face
    std::vector<uint32_t> first_;       ///< place in `order_` by face, and the end
    std::vector<uint8_t> known_;        ///< by place in `order_`
    VertexTable table_;
};

}  // namespace trapeze
