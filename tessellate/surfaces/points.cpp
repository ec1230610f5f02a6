/// Points (RISpec 5.5): disks parallel to the picture, of a diameter in object space; a face each. Where a
/// disk is about as small as a micropolygon it is a square of the same area, and few-sided disks are as large
/// as the circles they stand for. The "type" that RenderMans added makes them spheres to shading, or pictures
/// (rectangles) that face the camera.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "core/portable_math.h"
#include "tessellate/surfaces/camera_facing.h"
#include "tessellate/surfaces/surface_variables.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {
namespace {

constexpr float kHalfTurn = std::numbers::pi_v<float>;
/// Half the side of the square that is as large as a circle of radius 1.
const float kSquare = std::sqrt(kHalfTurn) / 2;

/// A point of the disk of radius 1, with its derivatives by u and v.
struct DiskPoint {
    V2f at, by_u, by_v;
};

/// The unit square onto the disk: squares about its middle become circles, and areas keep their proportions
/// [Shirley97].
DiskPoint disk_point(V2f uv) {
    const float a = 2 * uv.x - 1, b = 2 * uv.y - 1;
    constexpr float kQuarter = kHalfTurn / 4;
    // Four sectors about the axes: r, along the sector's axis, is how far out; the other coordinate turns.
    const bool sideways = std::abs(a) >= std::abs(b);
    const float r = sideways ? a : b, other = sideways ? b : a;
    const float angle = r != 0 ? kQuarter * other / r : 0.0f;
    const auto [s, c] = portable::sine_and_cosine(angle);
    // In the sector about the u axis; the one about the v axis has u and v exchanged.
    const V2f at(r * c, r * s), by_r = V2f(c + angle * s, s - angle * c) * 2.0f;
    const V2f by_other = V2f(-s, c) * (2 * kQuarter);
    const auto exchanged = [](V2f v) { return V2f(v.y, v.x); };
    if (sideways) return {at, by_r, by_other};
    return {exchanged(at), exchanged(by_other), exchanged(by_r)};
}

/// What a thread keeps of the unit disk: grids of as many vertices ask for the same places again and again.
class DiskScratch : public SurfaceScratch {
  public:
    /// disk_point() of each; valid until the next call.
    std::span<const DiskPoint> points(std::span<const V2f> uv) {
        Batch& batch = batches_[uv.size() % batches_.size()];
        if (!std::ranges::equal(batch.uv, uv)) {
            batch.uv.assign(uv.begin(), uv.end());
            batch.points.clear();
            for (const V2f& at : uv) batch.points.push_back(disk_point(at));
        }
        return batch.points;
    }

  private:
    struct Batch {
        std::vector<V2f> uv;
        std::vector<DiskPoint> points;
    };
    std::array<Batch, 32> batches_;
};

/// The parameters of a lattice's points that are not beside others, and disk_point() of them.
struct DiskLattice {
    V2f uv[FaceLattices::kFirstBeside], at[FaceLattices::kFirstBeside];

    DiskLattice() {
        for (int i = 0; i < FaceLattices::kFirstBeside; ++i) {
            uv[i] = FaceLattices::uv(FaceRuns::Upwards, i);
            at[i] = disk_point(uv[i]).at;
        }
    }
};

/// How much larger than its circle a polygon's circle is, when both are to have the same area.
float polygon_factor(int corners) {
    const float turn = 2 * kHalfTurn / static_cast<float>(corners);
    return std::sqrt(turn / portable::sin(turn));
}

/// A float for each point or one for all.
class PointFloats {
  public:
    PointFloats() = default;
    PointFloats(const Parameter* parameter, float otherwise) : otherwise_(otherwise) {
        if (!parameter) return;
        values_ = parameter->floats.data();
        one_ = parameter->declaration.storage == StorageClass::Constant ||
               parameter->declaration.storage == StorageClass::Uniform;
    }
    float operator[](int point) const { return values_ ? values_[one_ ? 0 : point] : otherwise_; }

  private:
    const float* values_ = nullptr;
    bool one_ = false;
    float otherwise_ = 0;
};

/// Values that each point has at one shape key.
struct PointValues {
    const float* P = nullptr;
    PointFloats width;
    PointFloats angle, aspect;  ///< of pictures: degrees, counterclockwise; width / height

    V3f place(int point) const { return {P[3 * point], P[3 * point + 1], P[3 * point + 2]}; }
};

/// What "type" asks for; a Sphere is a Disk whose normals are a sphere's.
enum class PointType { Disk, Sphere, Picture };

/// Faces that share nothing: each has edges 4 f + side and vertices 4 f + corner of its own. Asked at motion
/// keys, for disks face the camera at each by themselves.
class PointsSurface : public Surface {
  public:
    PointsSurface(const Primitive& primitive, const Camera* camera, PointType type,
                  std::vector<PointValues> keys);

    int face_count() const override { return static_cast<int>(factors_.size()); }
    uint32_t edge_count() const override { return 4 * static_cast<uint32_t>(factors_.size()); }
    uint32_t vertex_count() const override { return 4 * static_cast<uint32_t>(factors_.size()); }
    std::array<SurfaceSide, 4> sides(int face) const override {
        const uint32_t first = 4 * static_cast<uint32_t>(face);
        return {SurfaceSide{first}, SurfaceSide{first + 1}, SurfaceSide{first + 2}, SurfaceSide{first + 3}};
    }
    EdgeLine edge(uint32_t edge) const override;
    SurfacePoint vertex(uint32_t vertex) const override {
        return {static_cast<int>(vertex / 4), kCorners[vertex % 4]};
    }
    bool stands_alone(int) const override { return true; }
    bool has_motion_keys() const override { return true; }
    std::unique_ptr<SurfaceScratch> make_scratch() const override { return std::make_unique<DiskScratch>(); }
    bool is_hole(int face) const override;

    void evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int key) const override;
    bool has_lattices() const override { return true; }
    void lattices(int first, int count, int key, bool beside, FaceLattices& lattices) const override;

  private:
    static constexpr V2f kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    /// A point's disk or rectangle at one motion key, in object space.
    struct Disk {
        V3f centre{0, 0, 0};
        V3f x{0, 0, 0}, y{0, 0, 0};  ///< to the corners of what is drawn; of a rectangle, to its sides
        bool rectangle = false;

        V2f at(V2f uv) const { return rectangle ? on_rectangle(uv) : disk_point(uv).at; }
        static V2f on_rectangle(V2f uv) { return uv * 2.0f - V2f(1, 1); }
    };
    Disk disk(int point, int key) const;
    void set_sphere_normals(const Disk& disk, std::span<const V2f> uv, ShadingGrid& grid) const;
    float factor(int point, const Camera* camera) const;

    const Primitive& primitive_;
    PointType type_;
    const std::vector<PointValues> keys_;  ///< by shape key
    std::vector<CameraFacing> facing_;     ///< by motion key
    std::vector<float> factors_;           ///< drawn radius / radius; 0: a square
};

/// How disks are drawn is decided once, at the first key: a disk must not change its corners while the
/// shutter is open.
PointsSurface::PointsSurface(const Primitive& primitive, const Camera* camera, PointType type,
                             std::vector<PointValues> keys)
    : primitive_(primitive), type_(type), keys_(std::move(keys)) {
    for (const M44f& m : matrices_at_keys(primitive, primitive.key_count())) facing_.emplace_back(m, camera);
    factors_.resize(std::get<Points>(primitive.shape().topology).count);
    for (size_t i = 0; i < factors_.size(); ++i) factors_[i] = factor(static_cast<int>(i), camera);
}

/// How much larger than its circle a point's disk is drawn, from the size on the screen at the first key, in
/// micropolygons; 0: as a square. 1 where the size is not known.
float PointsSurface::factor(int point, const Camera* camera) const {
    if (!camera || type_ == PointType::Picture) return 1;
    // Behind the eye there is no size on the screen.
    const float z = transform_point(facing_[0].camera_from_object(), keys_[0].place(point)).z;
    if (camera->perspective && !(z > 0)) return 1;
    const V2f scale = camera->pixels_per_length(z);
    const float pixels = keys_[0].width[point] * facing_[0].scale() * std::max(scale.x, scale.y);
    const float size = std::abs(pixels) / std::sqrt(std::max(primitive_.attributes->shading_rate, 1e-4f));
    // At most a micropolygon wide: nobody sees corners.
    if (size * kSquare <= 1) return 0;
    // A side of the disk is diced by the length of four chords; its number of segments and the area must fit.
    const float chords = size * 4 * portable::sin(kHalfTurn / 16);
    constexpr int kMostSides = 8;
    constexpr float kFits = 0.012f;
    // Beyond eight segments a side the polygon is as good as its circle.
    if (chords > kMostSides) return 1;
    float best = 0, best_error = kFits;  // else a square of more than one micropolygon
    // For each number of segments a side, the polygon of 4 * side corners that has the area of the circle, as
    // far as it is diced into that number.
    for (int side = 1; side <= kMostSides; ++side) {
        // Clamped to what is diced into `side` segments: more than side - 1 and at most side of them.
        const float wanted = polygon_factor(4 * side), sides = static_cast<float>(side);
        const float factor = std::clamp(wanted, 1.002f * (sides - 1) / chords, 0.998f * sides / chords);
        const float error = std::abs(factor / wanted - 1);
        if (error < best_error) best = factor, best_error = error;
    }
    return best;
}

/// Nothing is shared: each edge has vertices of its own face, and lies on it.
EdgeLine PointsSurface::edge(uint32_t edge) const {
    constexpr uint32_t kFrom[4] = {0, 1, 3, 0}, kTo[4] = {1, 2, 2, 3};
    const uint32_t side = edge % 4, first = edge - side;
    EdgeLine line;
    line.face = static_cast<int>(edge / 4);
    line.from = kCorners[kFrom[side]], line.to = kCorners[kTo[side]];
    line.start = {false, first + kFrom[side], 0}, line.finish = {false, first + kTo[side], 0};
    return line;
}

/// Disks in the eye's own plane or behind it are not seen; nothing else would end their splitting.
bool PointsSurface::is_hole(int face) const {
    constexpr float kRounding = 1e-6f;
    if (primitive_.attributes->displacement_bound > 0) return false;
    for (size_t key = 0; key < facing_.size(); ++key) {
        const Disk d = disk(face, static_cast<int>(key));
        const V3f at = transform_point(facing_[key].camera_from_object(), d.centre);
        if (at.z > kRounding * (at.length() + (d.x + d.y).length() * facing_[key].scale())) return false;
    }
    return true;
}

/// Centre and diameter go linearly between shape keys; the axes are those of the motion key's camera.
PointsSurface::Disk PointsSurface::disk(int point, int key) const {
    const ShapeMix mix = shape_mix(primitive_, key, primitive_.key_count());
    Disk disk;
    disk.centre = keys_[mix.first].place(point);
    float diameter = keys_[mix.first].width[point];
    if (mix.to_next != 0) {
        const PointValues& next = keys_[mix.first + 1];
        disk.centre += (next.place(point) - disk.centre) * mix.to_next;
        diameter += (next.width[point] - diameter) * mix.to_next;
    }
    const V3f u = facing_[key].u_axis() * (diameter / 2), v = facing_[key].v_axis() * (diameter / 2);
    if (type_ == PointType::Picture) {
        const float angle = keys_[mix.first].angle[point] * kHalfTurn / 180,
                    aspect = keys_[mix.first].aspect[point];
        // v runs down, as a texture's t does.
        disk.x = u * portable::cos(angle) - v * portable::sin(angle);
        disk.y = (v * portable::cos(angle) + u * portable::sin(angle)) * (aspect > 0 ? 1 / aspect : 0.0f);
        disk.rectangle = true;
        return disk;
    }
    disk.rectangle = factors_[point] == 0;
    const float factor = disk.rectangle ? kSquare : factors_[point];
    disk.x = u * factor, disk.y = v * factor;
    return disk;
}

void PointsSurface::evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch* scratch,
                             std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const Disk d = disk(face, key);
    std::unique_ptr<SurfaceScratch> own;
    if (!scratch) own = make_scratch(), scratch = own.get();
    std::span<const DiskPoint> on_disk;
    if (!d.rectangle) on_disk = static_cast<DiskScratch&>(*scratch).points(uv);
    for (size_t i = 0; i < uv.size(); ++i) {
        const DiskPoint p = d.rectangle ? DiskPoint{d.at(uv[i]), {2, 0}, {0, 2}} : on_disk[i];
        P[i] = d.centre + d.x * p.at.x + d.y * p.at.y;
        if (!dPdu.empty()) dPdu[i] = d.x * p.by_u.x + d.y * p.by_u.y;
        if (!dPdv.empty()) dPdv[i] = d.x * p.by_v.x + d.y * p.by_v.y;
    }
}

/// The points of the unit disk are the same for all faces, and made once. Foreshortening is not looked at.
void PointsSurface::lattices(int first, int count, int key, bool, FaceLattices& lattices) const {
    constexpr int kFaces = FaceLattices::kFaces;
    std::array<float, kFaces> centre[3], x[3], y[3];
    std::array<bool, kFaces> rectangle;
    for (int i = 0; i < kFaces; ++i) {
        const Disk d = disk(first + std::min(i, count - 1), key);
        for (int k = 0; k < 3; ++k) centre[k][i] = d.centre[k], x[k][i] = d.x[k], y[k][i] = d.y[k];
        rectangle[i] = d.rectangle;
    }
    static const DiskLattice disks;
    for (int p = 0; p < FaceLattices::kFirstBeside; ++p) {
        const V2f on_disk = disks.at[p], on_rectangle = Disk::on_rectangle(disks.uv[p]);
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < kFaces; ++i) {
                const V2f& at = rectangle[i] ? on_rectangle : on_disk;
                lattices.points[p][k][i] = centre[k][i] + x[k][i] * at.x + y[k][i] * at.y;
            }
    }
    lattices.runs = FaceRuns::Upwards, lattices.bounded = false;
    lattices.there = (1u << count) - 1;
}

/// One value for each point, whatever the class.
class ValuesOfPoint : public VariableSource {
  public:
    explicit ValuesOfPoint(int point) : point_(point) {}
    void component(const Parameter& parameter, int component, std::span<float> values) const override {
        const size_t stride = parameter.declaration.floats_per_item();
        std::fill(values.begin(), values.end(), parameter.floats[point_ * stride + component]);
    }
    size_t uniform_index(const Parameter&) const override { return 0; }

  private:
    int point_;
};

/// u and v are those of the disk's own square, from 0 to 1 on each point.
bool PointsSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch*,
                                       ShadingGrid& grid) const {
    for (size_t i = 0; i < uv.size(); ++i) grid.u[i] = uv[i].x, grid.v[i] = uv[i].y;
    set_texture_coordinates(*primitive_.attributes, grid);
    if (set_variables(primitive_.shape().variables, ValuesOfPoint(face), grid)) return true;
    if (type_ != PointType::Sphere) return false;
    set_sphere_normals(disk(face, 0), uv, grid);
    return true;
}

/// Sets the normals that the half of a sphere has which faces the camera.
void PointsSurface::set_sphere_normals(const Disk& disk, std::span<const V2f> uv, ShadingGrid& grid) const {
    // x and y lie in the picture's plane, z towards the eye.
    const V3f x = facing_[0].u_axis().normalized(), y = facing_[0].v_axis().normalized(), z = x.cross(y);
    for (size_t i = 0; i < uv.size(); ++i) {
        const V2f at = disk.at(uv[i]);
        const V3f N = x * at.x + y * at.y + z * std::sqrt(std::max(1 - at.dot(at), 0.0f));
        grid.N.set(i, N);
    }
}

/// The same for all parts of a face: points are small, and their parts have little to gain.
Box3f PointsSurface::bound(int face, V2f, V2f, int key) const {
    const Disk d = disk(face, key);
    // A box about the rectangle of x and y, in which the disk lies too.
    V3f half;
    for (int k = 0; k < 3; ++k) half[k] = std::abs(d.x[k]) + std::abs(d.y[k]);
    return {d.centre - half, d.centre + half};
}

/// The type that a primitive names, by PRMan's names and other renderers'; an unknown one is a warning and a
/// disk.
PointType type_of_points(const Primitive& primitive, Diagnostics& diagnostics) {
    const Parameter* type = primitive.shape().variables.find("type");
    if (!type || type->strings.empty()) return PointType::Disk;
    const std::string& name = type->strings[0];
    if (name == "patch" || name == "sprite") return PointType::Picture;
    if (name == "blobby" || name == "sphere") return PointType::Sphere;
    if (name != "particle" && name != "disk" && name != "point")
        diagnostics.warning(primitive.location,
                            "Points: type \"" + name +
                                "\" is not known; disks (known: particle, disk, blobby, sphere, patch)",
                            "points-type");
    return PointType::Disk;
}

}  // namespace

/// Points without a width are 1 in diameter (RISpec 5.5).
std::unique_ptr<Surface> make_points_surface(const Primitive& primitive, const Camera* camera,
                                             Diagnostics& diagnostics) {
    std::vector<PointValues> keys;
    for (const auto& shape : primitive.shape_keys) {
        const ParameterList& list = shape->variables;
        const Parameter* width = list.find("width");
        if (!width) width = list.find("constantwidth");
        keys.push_back({list.find("P")->floats.data(), PointFloats(width, 1),
                        PointFloats(list.find("patchangle"), 0),
                        PointFloats(list.find("patchaspectratio"), 1)});
    }
    return std::make_unique<PointsSurface>(primitive, camera, type_of_points(primitive, diagnostics),
                                           std::move(keys));
}

}  // namespace trapeze
