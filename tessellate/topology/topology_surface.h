/// A surface whose faces, edges and vertices something else knows: a topology, or another surface.
#pragma once

#include "tessellate/topology/surface.h"

namespace trapeze {

/// Derived has topology(), which has face_count(), edge_count(), vertex_count(), sides(), edge() and
/// vertex(). The calls are resolved when it is compiled: no second virtual call for each edge.
template <class Derived>
class TopologySurface : public Surface {
  public:
    int face_count() const final { return topology().face_count(); }
    uint32_t edge_count() const final { return topology().edge_count(); }
    uint32_t vertex_count() const final { return topology().vertex_count(); }
    std::array<SurfaceSide, 4> sides(int face) const final { return topology().sides(face); }
    EdgeLine edge(uint32_t edge) const final { return topology().edge(edge); }
    SurfacePoint vertex(uint32_t vertex) const final { return topology().vertex(vertex); }

  private:
    const auto& topology() const { return static_cast<const Derived&>(*this).topology(); }
};

}  // namespace trapeze
