/// The limit surface over one face of a subdivision mesh: of its vertices' values, or of a face-varying
/// channel's. Regular faces of quad schemes are evaluated here as B-splines, linear ones as bilinear squares,
/// all others by OpenSubdiv's Bfr.
#pragma once

#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/surfaceFactory.h>

#include <array>
#include <span>
#include <vector>

#include "tessellate/surfaces/face_evaluation.h"

namespace trapeze {

/// Which points shape one face and how they are combined; not the points themselves, so that one patch serves
/// all shape keys and all variables of class vertex.
class LimitPatch {
  public:
    using Factory = OpenSubdiv::Bfr::SurfaceFactory;

    /// `corners`: the values (vertices of the mesh, or values of the channel) at the face's corners. Where
    /// the face has no limit surface (holes, boundaries that are not interpolated) it is the mesh face
    /// itself.
    void set_vertex(const Factory& factory, int mesh_face, std::span<const int> corners);
    void set_face_varying(const Factory& factory, int mesh_face, int channel, std::span<const int> corners);

    /// Makes the patch linear between the values at its corners, for faces without a limit surface.
    void set_linear(std::span<const int> corners);

    bool is_bspline() const { return form_ == Form::Bspline; }
    bool is_linear() const { return form_ == Form::Linear; }

    /// The points that evaluation wants, out of the mesh's or channel's values of `size` floats each.
    void gather(const float* values, int size, std::vector<float>& points) const;

    /// Evaluates gathered points of `size` floats each; uv, and what derivatives are by, are of the piece's
    /// unit square.
    void evaluate(const std::vector<float>& points, int size, const FacePiece& piece, std::span<const V2f> uv,
                  ValueSink value, ValueSink du, ValueSink dv) const;

  private:
    /// How it is evaluated. Bspline and Linear give the same bits for any batch and need no library call.
    enum class Form { Linear, Bspline, Library };

    /// Chooses the form from what the library has set up.
    void classify(std::span<const int> corners);
    /// Evaluates at most kMostFloats floats a point, `stride` floats from point to point.
    void evaluate_library(const float* points, int size, int stride, const FacePiece& piece,
                          std::span<const V2f> uv, ValueSink value, ValueSink du, ValueSink dv) const;

    Form form_ = Form::Linear;
    OpenSubdiv::Bfr::Surface<float> surface_;
    std::vector<int> corners_;        ///< Linear
    std::array<int, 16> controls_{};  ///< Bspline; those beyond a boundary are not used
    bool boundary_[4] = {};           ///< Bspline: v = 0, u = 1, v = 1, u = 0 is a boundary
};

}  // namespace trapeze
