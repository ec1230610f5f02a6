/// A surface where the scene puts it: camera-space positions at the primitive's motion keys. All positions of
/// grids, edges and vertices come from here, so that what is shared has the same bits whoever asks.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "tessellate/topology/surface.h"

namespace trapeze {

/// A thread's memory for one surface at a time; a few surfaces' scratches are kept.
class EvaluationScratch {
  public:
    /// The scratch for a surface; made where it is not among the last four.
    SurfaceScratch* of(const Surface& surface);
    std::span<V3f> points(size_t slot, size_t count);  ///< reused memory, 0 <= slot < kSlots

    /// Slots of points(), one for each use that may overlap another: 0 and 1 shape keys, 2 borders, 3 and 4
    /// splitting.
    static constexpr size_t kSlots = 5;

  private:
    /// The oldest is replaced; the surface's address tells whose scratch it is.
    struct Entry {
        const Surface* surface = nullptr;
        std::unique_ptr<SurfaceScratch> scratch;
    };
    std::array<Entry, 4> entries_;
    size_t next_ = 0;
    std::array<std::vector<V3f>, kSlots> points_;
};

/// The shape keys between which a motion key lies.
struct ShapeMix {
    int first = 0;
    float to_next = 0;  ///< 0: the first alone
};
/// The shape keys of motion key `key` of `key_count`, which is 1 or the primitive's number of keys.
ShapeMix shape_mix(const Primitive& primitive, int key, int key_count);
/// The primitive's transform, camera space from object space, at each of so many motion keys.
std::vector<M44f> matrices_at_keys(const Primitive& primitive, int key_count);

/// One primitive's surface in camera space. Refers to both, which outlive it; threads share it. `moves` false
/// takes all motion out, as a frame without motion blur is made.
class PlacedSurface {
  public:
    /// `moves`: whether the frame has more than one key at all.
    PlacedSurface(const Surface& surface, const Primitive& primitive, bool moves);

    const Surface& surface() const { return *surface_; }
    const Primitive& primitive() const { return *primitive_; }
    int key_count() const { return static_cast<int>(camera_from_object_.size()); }
    const M44f& camera_from_object(int key) const { return camera_from_object_[key]; }

    /// Positions at the first `keys` keys: P[key * uv.size() + i].
    void positions(int face, std::span<const V2f> uv, int keys, EvaluationScratch& scratch,
                   std::span<V3f> P) const;

    /// Positions, and derivatives by the face's u and v at key 0 (camera space too; empty: not wanted).
    void positions_and_derivatives(int face, std::span<const V2f> uv, int keys, EvaluationScratch& scratch,
                                   std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const;

    /// Camera-space box of a rectangle of a face at a key, or an empty one when the surface knows none.
    Box3f bound(int face, V2f lo, V2f hi, int key) const;
    /// The same from an object-space box at that key.
    Box3f bound(const Box3f& object_box, int key) const;
    /// Whether all motion keys have one shape.
    bool is_rigid() const;

    /// The shape keys that the surface is asked for at a motion key; the motion key itself where
    /// has_motion_keys().
    ShapeMix mix_of(int key) const;

  private:
    const Surface* surface_;
    const Primitive* primitive_;
    std::vector<M44f> camera_from_object_;
};

/// Transforms a point, as a row vector: no division, the matrix is affine. In one order of operations, which
/// all share.
V3f transform_point(const M44f& m, const V3f& p);
/// Transforms a direction: without the matrix' translation.
V3f transform_vector(const M44f& m, const V3f& v);

/// The matrix that takes normals along with `m`: the cofactors of the upper 3x3 with the determinant's sign,
/// that is the inverse transpose but for a positive factor; exists for singular matrices too.
M44f normal_matrix(const M44f& m);

}  // namespace trapeze
