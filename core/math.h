/// The vector and matrix types of the whole program: Imath's. Row vectors, as RISpec writes them: p' = p * M,
/// and a matrix named camera_from_object takes object-space points to camera space.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace trapeze {

using V2i = Imath::V2i;
using V2f = Imath::V2f;
using V3f = Imath::V3f;
using V3d = Imath::V3d;
using M44f = Imath::M44f;
using M44d = Imath::M44d;
using Box2i = Imath::Box2i;  ///< inclusive on both ends, as OpenEXR's windows
using Box2f = Imath::Box2f;
using Box3f = Imath::Box3f;

}  // namespace trapeze
