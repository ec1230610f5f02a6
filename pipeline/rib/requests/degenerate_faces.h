/// Faces that are none: exporters write edges and points among the faces of a mesh.
#pragma once

#include "core/scene/shapes.h"
#include "pipeline/rib/reader/request_report.h"

namespace trapeze::rib {

/// Leaves out faces and holes of fewer than three vertices, with a warning, and those that name vertices
/// beyond the mesh's points, with an error, and what the shape's variables have for them (class uniform a
/// value for each face, facevarying one for each corner). Variables have been checked (checked_variables).
/// Throws RequestError where no face is left.
void leave_out_degenerate_faces(RequestReport& report, Shape& shape);

}  // namespace trapeze::rib
