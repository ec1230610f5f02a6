/// Blobby (RISpec 5.6): its mesh, as polygons with normals. Leaves' variables are blended by the leaves'
/// fields. The mesh is made at the first key; at others its points go along with the leaves and back onto the
/// surface.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "tessellate/surfaces/blobby/blobby_mesh.h"
#include "tessellate/surfaces/camera_facing.h"
#include "tessellate/topology/placed_surface.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// Sides of the mesh's quads, in micropolygons.
constexpr float kMicropolygonsPerCell = 3;
/// Cells along the Blobby's diagonal, where no camera says how large it is seen.
constexpr float kCellsWithoutCamera = 64;
/// What is nearer to the eye than this part of the Blobby's diagonal is made as if it were that far away.
constexpr float kNearest = 0.01f;

/// The mesh as a polygon surface, with the primitive that it is made for: polygons refer to it. All that
/// Surface asks is handed on to the polygons.
class BlobbySurface : public TopologySurface<BlobbySurface> {
  public:
    BlobbySurface(Primitive mesh, Diagnostics& diagnostics)
        : mesh_(std::move(mesh)), polygons_(make_bilinear_surface(mesh_, diagnostics)) {}

    bool is_valid() const { return polygons_ != nullptr; }

    const Surface& topology() const { return *polygons_; }
    bool is_hole(int face) const override { return polygons_->is_hole(face); }
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

/// In object space, three micropolygons as the screen has them where a box is nearest to the camera: at the
/// least depth of what of it may be in the picture, which is a part of its distance. What is out of the
/// picture may have cells of any size.
class ScreenCells {
  public:
    ScreenCells(const Primitive& primitive, const Camera& camera, float diagonal)
        : camera_(camera),
          camera_from_object_(primitive.camera_from_object),
          scale_(CameraFacing(camera_from_object_.front(), &camera).scale()),
          nearest_(kNearest * diagonal * scale_),
          side_(kMicropolygonsPerCell * std::sqrt(std::max(primitive.attributes->shading_rate, 1e-4f))) {
        // The picture's farther side, in the image plane, and half as much to spare, for displacement and the
        // lens.
        const auto reach = [](float scale, float offset, int pixels) {
            return 1.5f * std::max(std::abs(offset), std::abs(scale * static_cast<float>(pixels) + offset));
        };
        across_ = {reach(camera.plane_scale_x, camera.plane_offset_x, camera.width),
                   reach(camera.plane_scale_y, camera.plane_offset_y, camera.height)};
        depth_of_distance_ = 1 / std::sqrt(1 + across_.dot(across_));
    }

    float operator()(const Box3f& where) const {
        Box3f seen;
        for (const M44f& m : camera_from_object_)
            for (int corner = 0; corner < 8; ++corner) {
                const V3f p(corner & 1 ? where.max.x : where.min.x, corner & 2 ? where.max.y : where.min.y,
                            corner & 4 ? where.max.z : where.min.z);
                seen.extendBy(transform_point(m, p));
            }
        if (camera_.perspective && is_out_of_view(seen)) return kInfinity;
        V3f closest;
        for (int k = 0; k < 3; ++k) closest[k] = std::clamp(0.0f, seen.min[k], seen.max[k]);
        const float depth = std::max({seen.min.z, closest.length() * depth_of_distance_, nearest_});
        const V2f pixels = camera_.pixels_per_length(depth);
        return side_ / (std::max(pixels.x, pixels.y) * scale_);
    }

  private:
    bool is_out_of_view(const Box3f& seen) const {
        if (seen.max.z < 0) return true;
        for (int k = 0; k < 2; ++k) {
            const float reach = across_[k] * seen.max.z;
            if (seen.min[k] > reach || seen.max[k] < -reach) return true;
        }
        return false;
    }

    const Camera& camera_;
    std::span<const M44f> camera_from_object_;
    float scale_, nearest_;
    float side_;  ///< pixels
    V2f across_;  ///< how far from the axis the picture reaches at depth 1
    float depth_of_distance_ = 1;
};

CellSizes cell_sizes(const BlobbyField& field, const Primitive& primitive, const Camera* camera) {
    Box3f all;
    for (const BlobbyLeaf& leaf : field.leaves)
        if (const Box3f support = leaf.support(); !support.isEmpty()) all.extendBy(support);
    const float diagonal = all.isEmpty() ? 1 : all.size().length();
    if (!camera) return [cell = diagonal / kCellsWithoutCamera](const Box3f&) { return cell; };
    return ScreenCells(primitive, *camera, diagonal);
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

/// A variable of class vertex, as if the file had given it.
Parameter triples(const char* name, ValueType type, const std::vector<V3f>& values) {
    Parameter parameter{name, {StorageClass::Vertex, type, 1}, {}, {}};
    parameter.floats.reserve(values.size() * 3);
    for (const V3f& v : values) parameter.floats.insert(parameter.floats.end(), {v.x, v.y, v.z});
    return parameter;
}

/// The most floats that a variable may have at all points; larger arrays are left out.
constexpr size_t kMostValues = size_t{1} << 27;

/// The mesh's variables: P, N, and the primitive's own, those of leaves as averages weighted by the leaves'
/// fields.
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
            if (mesh.points.size() > kMostValues / std::max<size_t>(item, 1)) continue;
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

/// Many times what the picture needs: round the eye, or for leaves that stretch far beyond what is seen of
/// them, a surface wants more than anyone sees.
double most_operations(const Primitive& primitive, const Camera* camera) {
    constexpr double kOfAMicropolygon = 1000, kAtLeast = 2e7;
    if (!camera) return kMostBlobbyOperations;
    const double rate = std::max(static_cast<double>(primitive.attributes->shading_rate), 1e-4);
    const double micropolygons = static_cast<double>(camera->width) * camera->height / rate;
    return std::clamp(kOfAMicropolygon * micropolygons, kAtLeast, kMostBlobbyOperations);
}

/// The mesh's points at a later shape key: carried along by their leaves, then moved back onto the surface
/// there.
std::vector<V3f> moved_points(const BlobbyField& field, const BlobbyMesh& mesh, const BlobbyField& later) {
    std::vector<V3f> points(mesh.points.size());
    // Where it takes too long, points stay where the leaves carry them.
    const bool settles =
        static_cast<double>(points.size()) *
            static_cast<double>(later.program.instructions.size() + later.program.operands.size()) <
        kMostBlobbyOperations / 10;
    for_each_point(field, mesh, [&](size_t p, std::span<const int> leaves, std::span<const float> w) {
        thread_local std::vector<FieldValue> scratch;
        V3f at(0, 0, 0);
        for (size_t i = 0; i < leaves.size(); ++i)
            at += field.leaves[leaves[i]].carried(mesh.points[p], later.leaves[leaves[i]]) * w[i];
        const float reach = 8 * mesh.list_cells[mesh.leaf_list_of_point[p]];
        points[p] = settles ? onto_surface(later, later.program, at, reach, scratch) : at;
    });
    return points;
}

/// The field at one of the shape's keys. Its grounds stand still in the world; a Blobby that moves over them
/// by its transformation alone keeps the shape that it has as the shutter opens.
BlobbyField field_at(const Primitive& primitive, size_t key, const FindDepthHeight* depth_heights) {
    const auto& blobby = std::get<Blobby>(primitive.shape_keys[key]->topology);
    if (!depth_heights) return blobby_field(blobby);
    const std::span<const M44f> places = primitive.camera_from_object;
    const size_t shapes = primitive.shape_keys.size();
    const size_t place = shapes > 1 ? key * (places.size() - 1) / (shapes - 1) : 0;
    return blobby_field(blobby, [&](const std::string& name) -> GroundHeight {
        const DepthHeight height = (*depth_heights)(name, primitive.location);
        if (!height) return {};
        return [height, m = places[place]](const V3f& p) { return height(transform_point(m, p)); };
    });
}

/// One loop a polygon: the mesh has no holes.
PolygonMesh polygons_of(const BlobbyMesh& mesh) {
    PolygonMesh polygons;
    polygons.loops_per_polygon.assign(mesh.sizes.size(), 1);
    polygons.vertices_per_loop = mesh.sizes;
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

/// The mesh is made for the camera, and for this primitive alone (depends_on_view()).
std::unique_ptr<Surface> make_blobby_surface(const Primitive& primitive, const SurfaceView& view,
                                             Diagnostics& diagnostics) {
    const BlobbyField field = field_at(primitive, 0, view.depth_heights);
    BlobbyMesh mesh = blobby_mesh(field, cell_sizes(field, primitive, view.camera),
                                  most_operations(primitive, view.camera));
    if (shows_inside(primitive))
        for (V3f& normal : mesh.normals) normal = -normal;
    if (mesh.vertices.empty()) {
        diagnostics.warning(primitive.location, "Blobby: its field has no surface", "blobby-empty");
        return nullptr;
    }
    if (mesh.coarser > 2)
        diagnostics.warning(primitive.location, "Blobby: too large for its size on the screen; made coarsely",
                            "blobby-coarse");
    std::vector<std::shared_ptr<const Shape>> keys;
    const PolygonMesh topology = polygons_of(mesh);
    keys.push_back(std::make_shared<const Shape>(
        Shape{topology, mesh_variables(field, mesh, primitive.shape().variables)}));
    for (size_t key = 1; key < primitive.shape_keys.size(); ++key) {
        const BlobbyField later = field_at(primitive, key, view.depth_heights);
        ParameterList list;
        list.set(triples("P", ValueType::Point, moved_points(field, mesh, later)));
        keys.push_back(std::make_shared<const Shape>(Shape{topology, std::move(list)}));
    }
    Primitive polygons = primitive;
    polygons.shape_keys = keys;
    auto surface = std::make_unique<BlobbySurface>(std::move(polygons), diagnostics);
    return surface->is_valid() ? std::move(surface) : nullptr;
}

}  // namespace trapeze
