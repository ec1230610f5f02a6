/// The one place that knows all kinds of surfaces.
#include "tessellate/topology/surface.h"

namespace trapeze {

namespace {

struct ByTopology {
    const Primitive& primitive;
    Diagnostics& diagnostics;
    const SurfaceView& view;

    std::unique_ptr<Surface> operator()(const PolygonMesh&) const {
        return make_polygon_surface(primitive, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const SubdivisionMesh&) const {
        return make_subdivision_surface(primitive, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const Quadric&) const {
        return make_quadric_surface(primitive, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const PatchMesh&) const {
        return make_patch_surface(primitive, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const NuPatch&) const {
        return make_nu_patch_surface(primitive, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const Curves&) const {
        return make_curves_surface(primitive, view.camera, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const Points&) const {
        return make_points_surface(primitive, view.camera, diagnostics);
    }
    std::unique_ptr<Surface> operator()(const Blobby&) const {
        return make_blobby_surface(primitive, view, diagnostics);
    }
};

}  // namespace

/// A new kind of primitive is a new alternative of Topology, which does not compile until it has a line
/// above.
std::unique_ptr<Surface> make_surface(const Primitive& primitive, Diagnostics& diagnostics,
                                      const SurfaceView& view) {
    return std::visit(ByTopology{primitive, diagnostics, view}, primitive.shape().topology);
}

}  // namespace trapeze
