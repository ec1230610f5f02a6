/// Patch and PatchMesh (RISpec 5.2): a face for each patch, evaluated in Bezier form.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "tessellate/surfaces/between.h"
#include "tessellate/surfaces/face_evaluation.h"
#include "tessellate/surfaces/net_lattices.h"
#include "tessellate/surfaces/surface_variables.h"
#include "tessellate/topology/face_grid.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// Control points of one shape key: P, or Pw with weights.
struct PatchPoints {
    const float* values = nullptr;
    bool rational = false;
};

/// What a thread keeps of the faces that it evaluated last: a grid's borders lie on its neighbours, too.
struct PatchScratch : SurfaceScratch {
    struct Face {
        int face = -1, shape_key = 0;
        BezierPatch patch;
    };
    std::array<Face, 32> faces;  ///< at face % 32
};

/// A patch mesh; threads share it. Control points stay in the primitive's arrays and are taken to Bezier form
/// when a face is asked for.
class PatchSurface : public TopologySurface<PatchSurface> {
  public:
    PatchSurface(const Primitive& primitive, std::vector<PatchPoints> points);

    const FaceGrid& topology() const { return faces_; }
    V2f faces_per_unit(int) const override {
        return {static_cast<float>(faces_.columns), static_cast<float>(faces_.rows)};
    }

    bool has_straight_lines() const override { return !mesh_.bicubic; }

    std::unique_ptr<SurfaceScratch> make_scratch() const override { return std::make_unique<PatchScratch>(); }
    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override;
    bool has_lattices() const override { return !points_.front().rational; }
    void lattices(int first, int count, int shape_key, bool beside, FaceLattices& lattices) const override;

    /// One to four floats of each control point, starting at values, `stride` floats apart.
    BezierPatch net(int face, const float* values, int count, size_t stride) const;
    /// One component of a variable at a face's control points, for BezierPatch::number_at().
    BezierPatch numbers(int face, const float* values, size_t stride) const;
    /// Control points in the mesh's own basis; indices wrap where the mesh does.
    BezierPatch controls(int face, const float* values, int count, size_t stride) const;
    const PatchMesh& mesh() const { return mesh_; }

  private:
    /// A face's control points in Bezier form; w is the fourth component of rational ones.
    BezierPatch positions(int face, int shape_key) const;
    /// The same; valid until another face takes its place.
    const BezierPatch& cached_positions(int face, int shape_key, PatchScratch& scratch) const;
    bool meets(int face, int next, bool along_u) const;
    void find_tears(bool along_u);

    const Primitive& primitive_;
    const PatchMesh& mesh_;
    std::vector<PatchPoints> points_;  ///< by shape key
    FaceGrid faces_;
    M44f u_bezier_, v_bezier_;
};

/// Bilinear patches keep identity matrices: their nets need no conversion.
PatchSurface::PatchSurface(const Primitive& primitive, std::vector<PatchPoints> points)
    : primitive_(primitive),
      mesh_(std::get<PatchMesh>(primitive.shape().topology)),
      points_(std::move(points)) {
    faces_.columns = mesh_.patches_u(), faces_.rows = mesh_.patches_v();
    faces_.u_wraps = mesh_.u_wraps, faces_.v_wraps = mesh_.v_wraps;
    if (!mesh_.bicubic) return;
    // Bilinear patches always share their borders; bicubic ones may not, by basis and step.
    u_bezier_ = bezier_from_basis(mesh_.u_basis);
    v_bezier_ = bezier_from_basis(mesh_.v_basis);
    find_tears(true);
    find_tears(false);
}

/// Whether two patches have the same curve where they are neighbours, to the last places of the numbers.
bool PatchSurface::meets(int face, int next, bool along_u) const {
    constexpr float kSame = 1e-5f;
    for (size_t key = 0; key < points_.size(); ++key) {
        const BezierPatch a = positions(face, static_cast<int>(key)),
                          b = positions(next, static_cast<int>(key));
        // Compared to the size of the numbers, by all components: rational patches by w, too.
        float size = 0, apart = 0;
        for (int i = 0; i < 4; ++i) {
            const Control &p = a.p[along_u ? i * 4 + 3 : 12 + i], &q = b.p[along_u ? i * 4 : i];
            for (int k = 0; k < 4; ++k)
                size = std::max(size, std::abs(p[k])), apart = std::max(apart, std::abs(p[k] - q[k]));
        }
        if (!(apart <= kSame * size)) return false;
    }
    return true;
}

/// Bases whose steps are not theirs, and those of coefficients, make patches that may lie apart.
void PatchSurface::find_tears(bool along_u) {
    if (pieces_join(along_u ? u_bezier_ : v_bezier_, along_u ? mesh_.u_step : mesh_.v_step)) return;
    const bool wraps = along_u ? faces_.u_wraps : faces_.v_wraps;
    const int count = along_u ? faces_.columns : faces_.rows, lines = along_u ? faces_.rows : faces_.columns;
    std::vector<bool> torn(count);
    for (int i = 0; i < count; ++i)
        for (int line = 0; line < lines && (i + 1 < count || wraps); ++line) {
            const auto face = [&](int at) {
                return along_u ? line * faces_.columns + at : at * faces_.columns + line;
            };
            if (!meets(face(i), face((i + 1) % count), along_u)) torn[i] = true;
        }
    (along_u ? faces_.u_lines : faces_.v_lines).tear(torn, wraps);
}

BezierPatch PatchSurface::net(int face, const float* values, int count, size_t stride) const {
    BezierPatch patch = controls(face, values, count, stride);
    if (mesh_.bicubic) to_bezier(u_bezier_, v_bezier_, patch);
    return patch;
}

BezierPatch PatchSurface::numbers(int face, const float* values, size_t stride) const {
    BezierPatch patch = controls(face, values, 1, stride);
    if (mesh_.bicubic) numbers_to_bezier(u_bezier_, v_bezier_, patch);
    return patch;
}

/// Indices wrap for periodic meshes; for the others they never reach the end. Rows of P go along u (RISpec
/// 5.2).
BezierPatch PatchSurface::controls(int face, const float* values, int count, size_t stride) const {
    BezierPatch patch;
    patch.degree = mesh_.bicubic ? 3 : 1;
    // Patches begin a step apart; they share control points where the step is less than 4.
    const int first_i = faces_.column_of(face) * (mesh_.bicubic ? mesh_.u_step : 1);
    const int first_j = faces_.row_of(face) * (mesh_.bicubic ? mesh_.v_step : 1);
    int columns[4];
    for (int i = 0; i <= patch.degree; ++i) columns[i] = (first_i + i) % mesh_.nu;
    for (int j = 0; j <= patch.degree; ++j) {
        const size_t row = static_cast<size_t>((first_j + j) % mesh_.nv) * mesh_.nu;
        for (int i = 0; i <= patch.degree; ++i) {
            const float* const from = values + (row + columns[i]) * stride;
            float* const to = patch.p[j * 4 + i].data();
            for (int k = 0; k < count; ++k) to[k] = from[k];
        }
    }
    return patch;
}

BezierPatch PatchSurface::positions(int face, int shape_key) const {
    const int floats = points_[shape_key].rational ? 4 : 3;
    return net(face, points_[shape_key].values, floats, floats);
}

/// Direct-mapped by the face's number.
const BezierPatch& PatchSurface::cached_positions(int face, int shape_key, PatchScratch& scratch) const {
    PatchScratch::Face& held = scratch.faces[static_cast<size_t>(face) % scratch.faces.size()];
    if (held.face != face || held.shape_key != shape_key)
        held = {face, shape_key, positions(face, shape_key)};
    return held.patch;
}

/// Rational patches are evaluated with their weights and divided last (RISpec 5.2, "Pw").
void PatchSurface::evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch,
                            std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    BezierPatch own;
    if (!scratch) own = positions(face, shape_key);
    const BezierPatch& patch =
        scratch ? cached_positions(face, shape_key, static_cast<PatchScratch&>(*scratch)) : own;
    if (!points_[shape_key].rational)
        return evaluate_bezier(patch, uv, sink_of(P), sink_of(dPdu), sink_of(dPdv));
    for (size_t i = 0; i < uv.size(); ++i) {
        Control value, by_u{}, by_v{};
        if (dPdu.empty() && dPdv.empty())
            value = patch.at(uv[i]);
        else
            patch.at(uv[i], &value, &by_u, &by_v);
        const float scale = 1 / value[3];
        P[i] = xyz(value) * scale;
        // By the quotient rule.
        if (!dPdu.empty()) dPdu[i] = (xyz(by_u) - P[i] * by_u[3]) * scale;
        if (!dPdv.empty()) dPdv[i] = (xyz(by_v) - P[i] * by_v[3]) * scale;
    }
}

/// All faces but rational ones, whose sums are divided.
void PatchSurface::lattices(int first, int count, int shape_key, bool beside, FaceLattices& lattices) const {
    lattices.runs = FaceRuns::Upwards;
    lattices.there = 0;
    if (points_[shape_key].rational) return;
    NetLanes nets;
    for (int i = 0; i < FaceLattices::kFaces; ++i) {
        // Lanes without a face are as the last.
        const BezierPatch patch = positions(first + std::min(i, count - 1), shape_key);
        for (int p = 0; p < 16; ++p) nets.set(p, i, patch.p[p].data());
    }
    net_lattices(nets, mesh_.bicubic ? NetForm::Bezier : NetForm::BezierLines, beside, lattices);
    lattices.there = (1u << count) - 1;
}

/// Values of variables on one face of a mesh.
class PatchValues : public VariableSource {
  public:
    PatchValues(const PatchSurface& surface, int face, std::span<const V2f> uv)
        : surface_(surface), face_(face), uv_(uv) {}

    void component(const Parameter& parameter, int component, std::span<float> values) const override {
        const size_t stride = parameter.declaration.floats_per_item();
        const float* const first = parameter.floats.data() + component;
        if (parameter.declaration.storage == StorageClass::Vertex) {
            const BezierPatch patch = surface_.numbers(face_, first, stride);
            for (size_t i = 0; i < values.size(); ++i) values[i] = patch.number_at(uv_[i]);
            return;
        }
        // Linear between the values at the face's corners, for all other classes.
        float c[4];
        for (int corner = 0; corner < 4; ++corner)
            c[corner] = first[corner_index(parameter.declaration.storage, corner) * stride];
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = between_corners(c[0], c[1], c[2], c[3], uv_[i].x, uv_[i].y);
    }
    size_t uniform_index(const Parameter& parameter) const override {
        return parameter.declaration.storage == StorageClass::Constant ? 0 : face_;
    }

  private:
    /// Corners 00, 10, 01, 11.
    size_t corner_index(StorageClass storage, int corner) const {
        if (storage != StorageClass::Varying) return static_cast<size_t>(face_) * 4 + corner;
        const PatchMesh& mesh = surface_.mesh();
        const int i = (surface_.topology().column_of(face_) + (corner & 1)) % mesh.varying_u();
        const int j = (surface_.topology().row_of(face_) + (corner >> 1)) % mesh.varying_v();
        return static_cast<size_t>(j) * mesh.varying_u() + i;
    }

    const PatchSurface& surface_;
    int face_;
    std::span<const V2f> uv_;
};

/// u and v run over the whole mesh, not over a patch (RISpec 5.2).
bool PatchSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch*,
                                      ShadingGrid& grid) const {
    for (size_t i = 0; i < uv.size(); ++i) {
        const V2f at = faces_.surface_uv(face, uv[i]);
        grid.u[i] = at.x, grid.v[i] = at.y;
    }
    set_texture_coordinates(*primitive_.attributes, grid);
    return set_variables(primitive_.shape().variables, PatchValues(*this, face, uv), grid);
}

/// The hull of the rectangle's own control points; rational ones too, as long as all weights are positive.
Box3f PatchSurface::bound(int face, V2f lo, V2f hi, int shape_key) const {
    const BezierPatch part = positions(face, shape_key).restricted(lo, hi);
    const bool rational = points_[shape_key].rational;
    Box3f box;
    for (int j = 0; j <= part.degree; ++j)
        for (int i = 0; i <= part.degree; ++i) {
            const Control& p = part.p[j * 4 + i];
            if (rational && !(p[3] > 0)) return {};  // outside its hull
            box.extendBy(rational ? xyz(p) / p[3] : xyz(p));
        }
    return box;
}

}  // namespace

/// Arrays have been checked when the RIB file was read; what is missing here came from elsewhere.
std::unique_ptr<Surface> make_patch_surface(const Primitive& primitive, Diagnostics& diagnostics) {
    std::vector<PatchPoints> points;
    for (const auto& shape : primitive.shape_keys) {
        const Parameter* P = shape->variables.find("P");
        const Parameter* Pw = shape->variables.find("Pw");
        const PatchMesh& mesh = std::get<PatchMesh>(shape->topology);
        const size_t controls = static_cast<size_t>(mesh.nu) * mesh.nv;
        if (P && P->floats.size() >= 3 * controls)
            points.push_back({P->floats.data(), false});
        else if (Pw && Pw->floats.size() >= 4 * controls)
            points.push_back({Pw->floats.data(), true});
        else {
            diagnostics.error(primitive.location, "PatchMesh: has no control points; skipped",
                              "patch-points");
            return nullptr;
        }
    }
    return std::make_unique<PatchSurface>(primitive, std::move(points));
}

}  // namespace trapeze
