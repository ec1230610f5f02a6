/// What split-and-dice knows of a surface: quad faces with a unit square of parameters each, that share edges
/// and vertices. Every kind of primitive is such a surface; it says how faces join and where points lie, and
/// knows nothing of rates, grids or cameras.
///
/// Sharing is by identity: two faces that meet name the same edge, and all points of an edge are evaluated on
/// one face only (the edge's line), whoever asks. Hence neighbours get the same bits, although the limits
/// that a library computes from either side of an edge differ in the last place. Corners are shared in the
/// same way through vertices.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "core/depth_height.h"
#include "core/math.h"
#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"
#include "tessellate/topology/face_lattices.h"

namespace trapeze {

/// A point of a surface. (u, v) in the face's unit square.
struct SurfacePoint {
    int face = 0;
    V2f uv{0, 0};
};

/// A side of a face's unit square: the piece of an edge that it lies on. `begin` is the edge's parameter at
/// the side's low end (u = 0 or v = 0), `end` at its high end: (0, 1), (1, 0) when the edge runs the other
/// way, (0, 0.5) for half an edge.
struct SurfaceSide {
    uint32_t edge = 0;
    float begin = 0, end = 1;
};

enum SideName { kBottom = 0, kRight = 1, kTop = 2, kLeft = 3 };  ///< v = 0, u = 1, v = 1, u = 0

/// An end of an edge: a vertex, or a point within another edge (that edge then decides where the point is).
/// Edges that end within others come of cut faces and of splits: T-junctions, which are closed by taking the
/// other edge's vertex.
struct EdgeEnd {
    bool on_edge = false;
    uint32_t id = 0;      ///< of the vertex or edge
    float parameter = 0;  ///< on that edge
};

/// Where an edge is evaluated: on `face`, from `from` to `to`, linear in the edge's parameter. `to` may lie
/// beyond the unit square, where the surface says that it accepts that (mesh_topology.h).
struct EdgeLine {
    int face = 0;
    V2f from{0, 0}, to{1, 0};
    EdgeEnd start, finish;  ///< at parameters 0 and 1. Chains of on_edge end at a vertex: no cycles.
};

/// A thread's working memory for evaluation (e.g. the library's surface of the face evaluated last).
struct SurfaceScratch {
    virtual ~SurfaceScratch() = default;
};

/// A primitive's shape in object space. Immutable: threads share it, each with a scratch of its own.
class Surface {
  public:
    virtual ~Surface() = default;

    virtual int face_count() const = 0;
    virtual uint32_t edge_count() const = 0;
    virtual uint32_t vertex_count() const = 0;
    virtual bool is_hole(int /*face*/) const { return false; }  ///< has no geometry; its edges exist

    /// How faces join; numbers run from 0 to the counts above.
    virtual std::array<SurfaceSide, 4> sides(int face) const = 0;
    /// Where all of an edge's points are evaluated, whoever asks.
    virtual EdgeLine edge(uint32_t edge) const = 0;
    /// Whether nothing else has a face's edges and vertices, all four of which lie at its own sides and
    /// corners: then its border is where the face is.
    virtual bool stands_alone(int /*face*/) const { return false; }
    /// Where a vertex is evaluated: a corner of one face.
    virtual SurfacePoint vertex(uint32_t vertex) const = 0;

    /// Null when none is needed. Never shared between threads.
    virtual std::unique_ptr<SurfaceScratch> make_scratch() const { return nullptr; }

    /// True of surfaces that depend on where they are seen from: the keys that evaluate(), lattices() and
    /// bound() are asked for are the moving primitive's (Primitive::key_count), not those of its shape.
    virtual bool has_motion_keys() const { return false; }

    /// Object-space positions and derivatives by the face's u and v at points of one face, for one of the
    /// primitive's shape keys. dPdu and dPdv may be empty spans: not wanted. A pure function of its arguments
    /// for each point, whatever the batch: the same (face, uv, key) gives the same bits.
    virtual void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch,
                          std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const = 0;

    /// Sets grid.u, v, s, t, and where the primitive has them N (object space; leave untouched and return
    /// false when it has none), Cs, Os (already filled from the attributes) and the other variables (object
    /// space), at points of a face, in the order of the grid's vertices; shape key 0. The caller has sized
    /// all but `variables` to uv.size(), which is grid.vertex_count(). `variables` holds those of an earlier
    /// grid, of this surface or another: reuse their memory where they fit.
    virtual bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                                    ShadingGrid& grid) const = 0;

    /// Object-space box of a rectangle of a face over one shape key, not smaller than the surface there.
    /// Surfaces without a cheap sure bound return an empty box: the splitter then samples the rectangle and
    /// grows the result.
    virtual Box3f bound(int /*face*/, V2f /*lo*/, V2f /*hi*/, int /*shape_key*/) const { return {}; }

    /// Whether lattices() makes points of many faces for less than evaluate() does.
    virtual bool has_lattices() const { return false; }
    /// The points of faces first .. first + count - 1, at most FaceLattices::kFaces, at a shape key, the same
    /// bits as evaluate() has; of all or some of them, whose edges run alike. `beside`: those beside edges,
    /// too.
    virtual void lattices(int /*first*/, int /*count*/, int /*shape_key*/, bool /*beside*/,
                          FaceLattices& /*lattices*/) const {}

    /// How many times a face the unit of grid.u and grid.v spans: 1 unless they run over a whole mesh.
    /// Derivatives in the grid are by grid.u and grid.v, those of evaluate() by the face's.
    virtual V2f faces_per_unit(int /*face*/) const { return {1, 1}; }

    /// Whether lines along u and v on a face are straight, and even in its parameter.
    virtual bool has_straight_lines() const { return false; }
    /// Whether positions and variables of a face are linear in its plane, however its lines run: also beyond
    /// the unit square, up to u and v of 2, over which an edge may go on (EdgeLine).
    virtual bool is_linear(int /*face*/) const { return false; }
    /// Up to where the parameters of a face mean something.
    float last_parameter(int face) const { return is_linear(face) ? 2.0f : 1.0f; }

    /// A flat normal for each face (polygons): N is then dPdu x dPdv of the face without sharing across
    /// edges.
    virtual bool is_faceted() const { return false; }
};

/// One file for each kind of surface. The primitive outlives the surface. Null, with a diagnostic, when it
/// cannot be made.
std::unique_ptr<Surface> make_polygon_surface(const Primitive& primitive, Diagnostics& diagnostics);
/// Polygons of three and four corners that stand for a curved surface: quads are bilinear, flat or not.
std::unique_ptr<Surface> make_bilinear_surface(const Primitive& primitive, Diagnostics& diagnostics);
/// Limit surfaces of meshes, by Catmull and Clark's scheme [Catmull78], by Loop's, or bilinear.
std::unique_ptr<Surface> make_subdivision_surface(const Primitive& primitive, Diagnostics& diagnostics);
/// The seven quadrics; their faces are about a quarter turn wide.
std::unique_ptr<Surface> make_quadric_surface(const Primitive& primitive, Diagnostics& diagnostics);
/// Patch and PatchMesh, bilinear and bicubic.
std::unique_ptr<Surface> make_patch_surface(const Primitive& primitive, Diagnostics& diagnostics);
std::unique_ptr<Surface> make_nu_patch_surface(const Primitive& primitive, Diagnostics& diagnostics);
/// What surfaces see of the frame that they are for. Both may be null.
struct SurfaceView {
    const Camera* camera = nullptr;
    const FindDepthHeight* depth_heights = nullptr;
};
/// Surfaces whose shape depends on the view; without a camera the eye is at the origin, and pixels have no
/// size.
std::unique_ptr<Surface> make_curves_surface(const Primitive& primitive, const Camera* camera,
                                             Diagnostics& diagnostics);
std::unique_ptr<Surface> make_points_surface(const Primitive& primitive, const Camera* camera,
                                             Diagnostics& diagnostics);
std::unique_ptr<Surface> make_blobby_surface(const Primitive& primitive, const SurfaceView& view,
                                             Diagnostics& diagnostics);
/// The surface of a primitive, of the kind that its topology asks for.
std::unique_ptr<Surface> make_surface(const Primitive& primitive, Diagnostics& diagnostics,
                                      const SurfaceView& view = {});

}  // namespace trapeze
