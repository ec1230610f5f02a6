/// What a vertex stands for when something is filtered: the micropolygon around it, and more where that is
/// seen thinner than a pixel.
#pragma once

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// Planes of a batch's lanes. An ellipse around each vertex with two conjugate axes, a and b, in the
/// surface's parameters; a is mainly along u and b along v.
struct Footprint {
    Operand u, v;  ///< the parameters, as the dicer set them
    const float *u_of_a = nullptr, *v_of_a = nullptr, *u_of_b = nullptr, *v_of_b = nullptr;
    const float *du = nullptr, *dv = nullptr;  ///< how far u and v change over it: RISpec's
    /// How many times the micropolygon's area a rectangle of du and dv has.
    const float* widening = nullptr;
    /// What its axes are of the micropolygon's steps to the next vertices: a is uu u + uv v, and b uv u + vv
    /// v.
    const float *uu = nullptr, *uv = nullptr, *vv = nullptr;
};

/// The footprints of a batch, computed when the first operation asks for them: most shaders never do. Planes
/// of the answer belong to the object, and are the same whenever it is asked.
class Footprints {
  public:
    virtual ~Footprints() = default;
    /// Computes them at the first call.
    virtual const Footprint& get() = 0;
};

}  // namespace trapeze::vm
