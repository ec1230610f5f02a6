#include "tessellate/surfaces/subdivision/subdivision_surface.h"

#include <algorithm>

#include "tessellate/surfaces/net_lattices.h"

namespace trapeze {
namespace {

/// Near an extraordinary vertex the library refines to this level, then approximates. The error against level
/// 10 on a cube's faces, in face sizes: 0.01 (normals: 0.5 degrees) at level 2, 2e-3 at 4, below 3e-4 at 6.
constexpr int kApproximationLevel = 6;

OpenSubdiv::Bfr::SurfaceFactory::Options factory_options() {
    OpenSubdiv::Bfr::SurfaceFactory::Options options;
    return options.SetApproxLevelSmooth(kApproximationLevel).SetApproxLevelSharp(kApproximationLevel);
}

}  // namespace

SubdivisionSurface::SubdivisionSurface(const Primitive& primitive,
                                       std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner,
                                       std::vector<FaceVaryingChannel> channels)
    : primitive_(primitive),
      scheme_(std::get<SubdivisionMesh>(primitive.shape().topology).scheme),
      refiner_(std::move(refiner)),
      factory_(*refiner_, factory_options()),
      channels_(std::move(channels)) {
    for (const auto& shape : primitive.shape_keys)
        positions_.push_back(shape->variables.find("P")->floats.data());
    const SubdivisionMesh& mesh = std::get<SubdivisionMesh>(primitive.shape().topology);
    // Shared edges and vertices are evaluated on faces that have a limit surface.
    std::vector<uint8_t> has_limit;
    for (int face = 0; face < static_cast<int>(mesh.vertices_per_face.size()); ++face) {
        kinds_.push_back(kind_of(face));
        has_limit.push_back(kinds_.back() == FaceKind::Limit);
    }
    // Triangles of Loop's scheme are all cut into three squares; of the others only quads stay whole.
    const int whole_size = scheme_ == SubdivisionMesh::Scheme::Loop ? 0 : 4;
    topology_ = std::make_unique<MeshTopology>(mesh.vertices_per_face, mesh.vertices, mesh.vertex_count,
                                               whole_size, has_limit);
}

/// Holes of the mesh have no limit surface; faces that the library cannot be trusted with are drawn as they
/// stand.
SubdivisionSurface::FaceKind SubdivisionSurface::kind_of(int mesh_face) const {
    if (!factory_.FaceHasLimitSurface(mesh_face)) return FaceKind::Hole;
    // OpenSubdiv 3.5.0 writes past its arrays for some faces that have both a vertex of a non-manifold fan
    // and an inner vertex of only two faces.
    const OpenSubdiv::Far::TopologyLevel& level = refiner_->GetLevel(0);
    bool non_manifold = false, doubled = false;
    for (int vertex : level.GetFaceVertices(mesh_face)) {
        if (level.IsVertexNonManifold(vertex))
            non_manifold = true;
        else if (!level.IsVertexBoundary(vertex) && level.GetVertexFaces(vertex).size() == 2)
            doubled = true;
    }
    return non_manifold && doubled ? FaceKind::Flat : FaceKind::Limit;
}

void SubdivisionSurface::set_vertex_patch(int mesh_face, LimitPatch& patch) const {
    const std::span<const int> corners = topology_->face_vertices(mesh_face);
    if (kinds_[mesh_face] == FaceKind::Limit)
        patch.set_vertex(factory_, mesh_face, corners);
    else
        patch.set_linear(corners);
}

std::unique_ptr<SurfaceScratch> SubdivisionSurface::make_scratch() const {
    return std::make_unique<SubdivisionScratch>();
}

/// Direct-mapped by the face's number: neighbouring faces have neighbouring numbers in most meshes.
SubdivisionScratch::Face& SubdivisionSurface::cached_face(SubdivisionScratch& scratch, int mesh_face) const {
    SubdivisionScratch::Face& cached =
        scratch.faces[static_cast<size_t>(mesh_face) % SubdivisionScratch::kFaces];
    if (cached.mesh_face == mesh_face) return cached;
    cached.mesh_face = mesh_face;
    set_vertex_patch(mesh_face, cached.patch);
    cached.positions.resize(positions_.size());
    // The memory stays: 32 faces are replaced again and again.
    for (auto& points : cached.positions) points.clear();
    cached.channels.resize(channels_.size());
    for (auto& channel : cached.channels) channel.is_set = false;
    return cached;
}

/// Made when it is first asked for: shaders may look at none of the channels.
const LimitPatch& SubdivisionSurface::cached_channel(SubdivisionScratch::Face& cached, int channel) const {
    SubdivisionScratch::Face::Channel& entry = cached.channels[channel];
    if (entry.is_set) return entry.patch;
    const std::span<const int> values(channels_[channel].topology.values);
    const std::span<const int> corners = values.subspan(topology_->first_corner(cached.mesh_face),
                                                        topology_->face_vertices(cached.mesh_face).size());
    if (kinds_[cached.mesh_face] == FaceKind::Limit)
        entry.patch.set_face_varying(factory_, cached.mesh_face, channel, corners);
    else
        entry.patch.set_linear(corners);
    entry.is_set = true;
    return entry.patch;
}

void SubdivisionSurface::evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch,
                                  std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const FacePiece piece = topology_->piece(face);
    SubdivisionScratch::Face& cached =
        cached_face(static_cast<SubdivisionScratch&>(*scratch), piece.mesh_face);
    std::vector<float>& points = cached.positions[shape_key];
    // Once a face and shape key, however many batches of its points are wanted.
    if (points.empty()) cached.patch.gather(positions_[shape_key], 3, points);
    cached.patch.evaluate(points, 3, piece, uv, sink_of(P), sink_of(dPdu), sink_of(dPdv));
}

/// Whether a face has as many neighbours as a regular quad: what the library is not asked for in vain.
bool SubdivisionSurface::may_be_regular(int mesh_face) const {
    if (scheme_ == SubdivisionMesh::Scheme::Bilinear || kinds_[mesh_face] == FaceKind::Flat) return true;
    const std::span<const int> corners = topology_->face_vertices(mesh_face);
    const OpenSubdiv::Far::TopologyLevel& level = refiner_->GetLevel(0);
    return corners.size() == 4 && std::ranges::all_of(corners, [&](int vertex) {
               const int faces = level.GetVertexFaces(vertex).size();
               return level.IsVertexBoundary(vertex) ? faces <= 2 : faces == 4;
           });
}

/// Faces that are B-splines, or linear ones that are cut or not, as the first one of the block that is
/// either.
void SubdivisionSurface::lattices(int first, int count, int shape_key, bool beside,
                                  FaceLattices& lattices) const {
    lattices.there = 0;
    NetLanes nets;
    LimitPatch patch;
    std::vector<float> points;
    float corners[12];
    bool bspline = false;
    for (int i = 0; i < count; ++i) {
        const FacePiece piece = topology_->piece(first + i);
        if (kinds_[piece.mesh_face] == FaceKind::Hole || !may_be_regular(piece.mesh_face)) continue;
        set_vertex_patch(piece.mesh_face, patch);
        if (!patch.is_bspline() && !patch.is_linear()) continue;
        const FaceRuns runs = piece.cut ? FaceRuns::Piece : FaceRuns::Round;
        const bool is_first = lattices.there == 0;
        if (!is_first && (patch.is_bspline() != bspline || runs != lattices.runs)) continue;
        bspline = patch.is_bspline(), lattices.runs = runs;
        patch.gather(positions_[shape_key], 3, points);
        if (!bspline) piece_corners(piece, points.data(), 3, corners);
        const float* const controls = bspline ? points.data() : corners;
        // Lanes without a face are as the first.
        const int from = is_first ? 0 : i, to = is_first ? FaceLattices::kFaces : i + 1;
        for (int p = 0; p < (bspline ? 16 : 4); ++p)
            for (int lane = from; lane < to; ++lane) nets.set(p, lane, controls + 3 * p);
        lattices.there |= 1u << i;
    }
    if (lattices.there == 0) return;
    net_lattices(nets, bspline ? NetForm::Bspline : NetForm::Corners, beside, lattices);
}

/// The limit surface is an average of the vertices of all faces that touch the face.
Box3f SubdivisionSurface::ring_box(int mesh_face, int shape_key) const {
    const OpenSubdiv::Far::TopologyLevel& level = refiner_->GetLevel(0);
    Box3f box;
    for (int vertex : topology_->face_vertices(mesh_face))
        for (int around : level.GetVertexFaces(vertex))
            for (int corner : topology_->face_vertices(around)) {
                const float* p = positions_[shape_key] + 3 * static_cast<size_t>(corner);
                box.extendBy(V3f(p[0], p[1], p[2]));
            }
    return grown_by_rounding(box);
}

Box3f SubdivisionSurface::bound(int face, V2f lo, V2f hi, int shape_key) const {
    const FacePiece piece = topology_->piece(face);
    LimitPatch patch;
    set_vertex_patch(piece.mesh_face, patch);
    // The library's patches have no cheap hull; the ring is large but sure.
    if (!patch.is_bspline() && !patch.is_linear()) return ring_box(piece.mesh_face, shape_key);
    std::vector<float> points;
    patch.gather(positions_[shape_key], 3, points);
    if (patch.is_bspline()) return bspline_bound(points.data(), lo, hi);
    float corners[12];
    piece_corners(piece, points.data(), 3, corners);
    return bilinear_bound(corners, lo, hi);
}

std::unique_ptr<Surface> make_subdivision_surface(const Primitive& primitive, Diagnostics& diagnostics) {
    const SubdivisionMesh& mesh = std::get<SubdivisionMesh>(primitive.shape().topology);
    for (const auto& shape : primitive.shape_keys) {
        const Parameter* P = shape->variables.find("P");
        if (P && P->floats.size() >= 3 * static_cast<size_t>(mesh.vertex_count)) continue;
        diagnostics.error(primitive.location, "SubdivisionMesh: has no vertex positions P; mesh skipped",
                          "subdivision-points");
        return nullptr;
    }
    // Tags and channels are part of the refiner's topology.
    const SubdivisionTags tags = read_tags(mesh, primitive.location, diagnostics);
    std::vector<FaceVaryingChannel> channels =
        make_channels(mesh, primitive.shape().variables, tags.linear_face_varying);
    std::vector<FaceVaryingTopology> topologies;
    for (const FaceVaryingChannel& channel : channels) topologies.push_back(channel.topology);
    auto refiner = make_refiner(mesh, tags, topologies, primitive.location, diagnostics);
    if (!refiner) return nullptr;
    return std::make_unique<SubdivisionSurface>(primitive, std::move(refiner), std::move(channels));
}

}  // namespace trapeze
