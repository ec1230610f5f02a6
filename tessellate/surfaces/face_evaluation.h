/// Batches of points on bilinear and bicubic faces. The arithmetic for a point does not depend on the batch
/// it comes in: blocks are padded, so that every lane runs the same code.
#pragma once

#include <cstddef>
#include <span>

#include "core/math.h"
#include "tessellate/surfaces/bezier.h"
#include "tessellate/topology/mesh_topology.h"

namespace trapeze {

/// Where component k of point i goes: data[i * point_stride + k * component_stride]. No data: not wanted.
struct ValueSink {
    float* data = nullptr;
    size_t point_stride = 1, component_stride = 1;

    explicit operator bool() const { return data != nullptr; }
    float& at(size_t point, size_t component) const {
        return data[point * point_stride + component * component_stride];
    }
};

/// Packed points. An empty span is not wanted.
inline ValueSink sink_of(std::span<V3f> values) {
    return {values.empty() ? nullptr : &values.front().x, 3, 1};
}

/// The four corner values of a unit square, in the order of its corners, from those of the mesh face, which
/// is linear in between: `values` has `size` floats for each corner of the mesh face.
void piece_corners(const FacePiece& piece, const float* values, int size, float* corners);

/// Evaluates a face that is bilinear in four corners, going round, of `size` floats each. Both derivatives or
/// none.
void evaluate_bilinear(const float* corners, int size, std::span<const V2f> uv, ValueSink value, ValueSink du,
                       ValueSink dv);

/// Evaluates a piece of a mesh face, linear between the values at the face's corners.
void evaluate_linear_piece(const FacePiece& piece, const float* values, int size, std::span<const V2f> uv,
                           ValueSink value, ValueSink du, ValueSink dv);

/// Evaluates a variable on a piece of a mesh face, of one value for each of the face's corners, by the
/// arithmetic of between.h: equal corners give equal values.
void values_on_piece(const FacePiece& piece, const float* corners, std::span<const V2f> uv,
                     std::span<float> values);

/// Evaluates a uniform bicubic B-spline patch with control points j * 4 + i, of `size` floats each.
void evaluate_bspline(const float* controls, int size, std::span<const V2f> uv, ValueSink value, ValueSink du,
                      ValueSink dv);

/// Evaluates x, y and z of a patch that is not rational: BezierPatch::at() of each point, the same bits. Both
/// derivatives or none.
void evaluate_bezier(const BezierPatch& patch, std::span<const V2f> uv, ValueSink value, ValueSink du,
                     ValueSink dv);

/// Boxes of rectangles of such faces (size 3), that hold every evaluated point: grown by its rounding.
Box3f bilinear_bound(const float* corners, V2f lo, V2f hi);
Box3f bspline_bound(const float* controls, V2f lo, V2f hi);

/// Grows a box by the rounding of sums of at most a hundred terms of its size (4e-6 of the largest coordinate
/// along each axis). An empty box stays empty.
Box3f grown_by_rounding(Box3f box);

}  // namespace trapeze
