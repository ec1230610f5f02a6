/// Subdivision meshes [Catmull78]: the limit surface itself, evaluated by the library where it is wanted; no
/// refined mesh is made.
#pragma once

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "tessellate/surfaces/subdivision/subdivision_patch.h"
#include "tessellate/surfaces/subdivision/subdivision_refiner.h"
#include "tessellate/topology/mesh_topology.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {

/// Variables of the classes facevarying and facevertex that share their seams: s and t together, each other
/// one alone. Values are welded: one for each value that differs at a vertex.
struct FaceVaryingChannel {
    /// A variable, and where in the channel's values its own floats begin.
    struct Member {
        const Parameter* parameter = nullptr;
        int first = 0;  ///< float of the channel's values
    };
    std::vector<Member> members;
    int size = 0;  ///< floats of a value
    FaceVaryingTopology topology;
    std::vector<float> values;
};

/// What a thread keeps of the faces that it evaluated last: a grid's borders lie on its neighbours, too.
struct SubdivisionScratch : SurfaceScratch {
    /// All that has been set up for one mesh face; -1: nothing yet.
    struct Face {
        int mesh_face = -1;
        LimitPatch patch;
        std::vector<std::vector<float>> positions;  ///< by shape key: points to evaluate; empty: not gathered
        struct Channel {
            bool is_set = false;
            LimitPatch patch;
        };
        std::vector<Channel> channels;
    };
    /// Faces kept by a thread.
    static constexpr size_t kFaces = 32;
    std::array<Face, kFaces> faces;  ///< at mesh_face % kFaces
};

/// One mesh at all of its shape keys; threads share it, and the library's cache behind it is locked.
class SubdivisionSurface : public TopologySurface<SubdivisionSurface> {
  public:
    /// The primitive outlives the surface; its shape keys have positions for all vertices.
    SubdivisionSurface(const Primitive& primitive,
                       std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner,
                       std::vector<FaceVaryingChannel> channels);

    bool is_hole(int face) const override {
        return kinds_[topology_->piece(face).mesh_face] == FaceKind::Hole;
    }
    std::unique_ptr<SurfaceScratch> make_scratch() const override;
    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override;
    bool has_lattices() const override { return scheme_ != SubdivisionMesh::Scheme::Loop; }
    void lattices(int first, int count, int shape_key, bool beside, FaceLattices& lattices) const override;

    const MeshTopology& topology() const { return *topology_; }
    /// What variables are evaluated with besides.
    const std::vector<FaceVaryingChannel>& channels() const { return channels_; }
    /// The thread's patch of a mesh face, set up when it is not among the last ones; valid until another face
    /// takes its place. call.
    SubdivisionScratch::Face& cached_face(SubdivisionScratch& scratch, int mesh_face) const;
    /// A cached face's patch for one channel of face-varying values.
    const LimitPatch& cached_channel(SubdivisionScratch::Face& cached, int channel) const;

  private:
    /// What becomes of a mesh face.
    enum class FaceKind : uint8_t {
        Hole,   ///< or at a boundary that is not interpolated: not drawn
        Limit,  ///< has a limit surface
        Flat,   ///< is drawn as it is, because the library cannot take it
    };

    /// The kind of a mesh face, by the library's own answer and by what it cannot take.
    FaceKind kind_of(int mesh_face) const;
    void set_vertex_patch(int mesh_face, LimitPatch& patch) const;
    bool may_be_regular(int mesh_face) const;
    Box3f ring_box(int mesh_face, int shape_key) const;

    using Factory = OpenSubdiv::Bfr::RefinerSurfaceFactory<OpenSubdiv::Bfr::SurfaceFactoryCacheThreaded<
        std::shared_mutex, std::shared_lock<std::shared_mutex>, std::unique_lock<std::shared_mutex>>>;

    const Primitive& primitive_;
    const SubdivisionMesh::Scheme scheme_;
    std::vector<const float*> positions_;  ///< by shape key
    std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner_;
    Factory factory_;
    std::vector<FaceVaryingChannel> channels_;
    std::vector<FaceKind> kinds_;  ///< by mesh face
    std::unique_ptr<MeshTopology> topology_;
};

/// The channels of a mesh's variables of classes facevarying (unless those are linear) and facevertex.
std::vector<FaceVaryingChannel> make_channels(const SubdivisionMesh& mesh, const ParameterList& variables,
                                              bool linear_face_varying);

}  // namespace trapeze
