/// Blobby (RISpec 5.6): its mesh, as polygons with normals. Leaves' variables are blended by the leaves'
/// fields. The mesh is made at the first key; at others its points go along with the leaves and back onto the
/// surface.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "tessellate/blobby_mesh.h"
#include "tessellate/camera_facing.h"
#include "tessellate/placed_surface.h"
#include "tessellate/surface.h"

namespace trapeze {
namespace {

/// Sides of the mesh's quads, in micropolygons.
constexpr float kMicropolygonsPerCell = 2;
/// Without a camera: cells along the diagonal.
constexpr float kCellsWithoutCamera = 64;

class BlobbySurface : public Surface {
  public:
    BlobbySurface(Primitive mesh, Diagnostics& diagnostics)
        : mesh_(std::move(mesh)), polygons_(make_polygon_surface(mesh_, diagnostics)) {}

    bool is_valid() const { return polygons_ != nullptr; }

    int face_count() const override { return polygons_->face_count(); }
    uint32_t edge_count() const override { return polygons_->edge_count(); }
    uint32_t vertex_count() const override { return polygons_->vertex_count(); }
    bool is_hole(int face) const override { return polygons_->is_hole(face); }
    std::array<SurfaceSide, 4> sides(int face) const override { return polygons_->sides(face); }
    EdgeLine edge(uint32_t edge) const override { return polygons_->edge(edge); }
    SurfacePoint vertex(uint32_t vertex) const override { return polygons_->vertex(vertex); }
    std::unique_ptr<SurfaceScratch> make_scratch() const override { return polygons_->make_scratch(); }
    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override {
        polygons_->evaluate(face, uv, shape_key, scratch, P, dPdu, dPdv);
    }
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override {
        return polygons_->evaluate_variables(face, uv, scratch, grid);
    }
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override {
        return polygons_->bound(face, lo, hi, shape_key);
    }
    bool is_faceted() const override { return polygons_->is_faceted(); }

  private:
    const Primitive mesh_;
    const std::unique_ptr<Surface> polygons_;
};

/// In object space, from the size that a micropolygon has where the leaves are nearest to the camera.
float cell_size(const BlobbyField& field, const Primitive& primitive, const Camera* camera) {
    Box3f box;
    float finest = kInfinity;
    for (const BlobbyLeaf& leaf : field.leaves) {
        const Box3f support = leaf.support();
        if (support.isEmpty()) continue;
        box.extendBy(support);
        const V3f size = support.size();
        finest = std::min({finest, size.x, size.y, size.z});
    }
    if (box.isEmpty()) return 1;
    const float diagonal = box.size().length();
    float cell = diagonal / kCellsWithoutCamera;
    if (camera) {
        const CameraFacing facing(primitive.camera_from_object.front(), camera);
        const float radius = diagonal / 2 * facing.scale();
        const float z = transform_point(facing.camera_from_object(), box.center()).z - radius;
        const V2f pixels = camera->pixels_per_length(std::max(z, 0.02f * radius));
        const float rate = std::sqrt(std::max(primitive.attributes->shading_rate, 1e-4f));
        cell = kMicropolygonsPerCell * rate / (std::max(pixels.x, pixels.y) * facing.scale());
    }
    // Small leaves far away keep their shape roughly: four cells across what is drawn of them.
    cell = std::min(cell, finest / 8);
    return std::isfinite(cell) ? std::clamp(cell, diagonal * 1e-4f, diagonal) : diagonal;
}

/// The leaves' shares in a point of the mesh, which add up to 1.
void leaf_weights(const BlobbyField& field, std::span<const int> leaves, const V3f& p,
                  std::vector<float>& weights) {
    weights.assign(leaves.size(), 0.0f);
    float sum = 0;
    for (size_t i = 0; i < leaves.size(); ++i)
        sum += weights[i] = std::max(field.leaves[leaves[i]].at(p).value, 0.0f);
    for (float& w : weights) w = sum > 0 ? w / sum : 1 / static_cast<float>(leaves.size());
}

/// Calls `point(p, leaves, weights)` for each point of the mesh, in parallel.
template <class Point>
void for_each_point(const BlobbyField& field, const BlobbyMesh& mesh, Point&& point) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.points.size(), 1024), [&](const auto& range) {
        std::vector<float> weights;
        for (size_t p = range.begin(); p < range.end(); ++p) {
            const std::vector<int>& leaves = mesh.leaf_lists[mesh.leaf_list_of_point[p]];
            leaf_weights(field, leaves, mesh.points[p], weights);
            point(p, std::span<const int>(leaves), std::span<const float>(weights));
        }
    });
}

Parameter triples(const char* name, ValueType type, const std::vector<V3f>& values) {
    Parameter parameter{name, {StorageClass::Vertex, type, 1}, {}, {}};
    parameter.floats.reserve(values.size() * 3);
    for (const V3f& v : values) parameter.floats.insert(parameter.floats.end(), {v.x, v.y, v.z});
    return parameter;
}

ParameterList mesh_variables(const BlobbyField& field, const BlobbyMesh& mesh, const ParameterList& given) {
    ParameterList list;
    for (const Parameter& variable : given.values) {
        const StorageClass storage = variable.declaration.storage;
        const bool constant = storage == StorageClass::Constant || storage == StorageClass::Uniform;
        if (!constant && variable.is_string()) continue;
        Parameter value = variable;
        value.declaration.storage = constant ? StorageClass::Constant : StorageClass::Vertex;
        if (!constant) {
            const size_t item = variable.declaration.floats_per_item();
            value.floats.assign(mesh.points.size() * item, 0.0f);
            for_each_point(field, mesh, [&](size_t p, std::span<const int> leaves, std::span<const float> w) {
                for (size_t i = 0; i < leaves.size(); ++i)
                    for (size_t k = 0; k < item; ++k)
                        value.floats[p * item + k] += w[i] * variable.floats[leaves[i] * item + k];
            });
        }
        list.set(std::move(value));
    }
    list.set(triples("P", ValueType::Point, mesh.points));
    list.set(triples("N", ValueType::Normal, mesh.normals));
    return list;
}

std::vector<V3f> moved_points(const BlobbyField& field, const BlobbyMesh& mesh, const BlobbyField& later) {
    std::vector<V3f> points(mesh.points.size());
    for_each_point(field, mesh, [&](size_t p, std::span<const int> leaves, std::span<const float> w) {
        thread_local std::vector<FieldValue> scratch;
        V3f at(0, 0, 0);
        for (size_t i = 0; i < leaves.size(); ++i)
            at += field.leaves[leaves[i]].carried(mesh.points[p], later.leaves[leaves[i]]) * w[i];
        points[p] = onto_surface(later, later.program, at, 8 * mesh.cell, scratch);
    });
    return points;
}

PolygonMesh quads(const BlobbyMesh& mesh) {
    PolygonMesh polygons;
    polygons.loops_per_polygon.assign(mesh.vertices.size() / 4, 1);
    polygons.vertices_per_loop.assign(mesh.vertices.size() / 4, 4);
    polygons.vertices = mesh.vertices;
    polygons.vertex_count = static_cast<int>(mesh.points.size());
    return polygons;
}

/// Orientation "inside" turns the normals, a mirrored space does not.
bool shows_inside(const Primitive& primitive) {
    const bool mirrored = primitive.camera_from_object.front().determinant() < 0;
    return primitive.attributes->reverse_orientation != mirrored;
}

}  // namespace

std::unique_ptr<Surface> make_blobby_surface(const Primitive& primitive, const Camera* camera,
                                             Diagnostics& diagnostics) {
    const BlobbyField field = blobby_field(std::get<Blobby>(primitive.shape().topology));
    if (field.has_planes)
        diagnostics.warning(primitive.location, "Blobby: repelling planes are not supported; left out",
                            "blobby-planes");
    const float cell = cell_size(field, primitive, camera);
    BlobbyMesh mesh = blobby_mesh(field, cell);
    if (shows_inside(primitive))
        for (V3f& normal : mesh.normals) normal = -normal;
    if (mesh.vertices.empty()) {
        diagnostics.warning(primitive.location, "Blobby: its field has no surface", "blobby-empty");
        return nullptr;
    }
    if (mesh.cell > 2 * cell)
        diagnostics.warning(primitive.location, "Blobby: too large for its size on the screen; made coarsely",
                            "blobby-coarse");
    Primitive polygons = primitive;
    polygons.shape_keys.clear();
    const PolygonMesh topology = quads(mesh);
    polygons.shape_keys.push_back(std::make_shared<const Shape>(
        Shape{topology, mesh_variables(field, mesh, primitive.shape().variables)}));
    for (size_t key = 1; key < primitive.shape_keys.size(); ++key) {
        const BlobbyField later = blobby_field(std::get<Blobby>(primitive.shape_keys[key]->topology));
        ParameterList list;
        list.set(triples("P", ValueType::Point, moved_points(field, mesh, later)));
        polygons.shape_keys.push_back(std::make_shared<const Shape>(Shape{topology, std::move(list)}));
    }
    auto surface = std::make_unique<BlobbySurface>(std::move(polygons), diagnostics);
    return surface->is_valid() ? std::move(surface) : nullptr;
}

}  // namespace trapeze
