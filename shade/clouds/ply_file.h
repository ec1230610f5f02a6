/// Point clouds as PLY (Greg Turk's polygon file format, of which points are the vertices).
///
/// What is written: "element vertex" with float properties x y z nx ny nz radius, then the channels: a float
/// under its name, a colour as NAME_r NAME_g NAME_b, other triples as NAME_x NAME_y NAME_z; a comment for
/// each channel says its type: "comment channel color _name". What is read: these; further, in other
/// programs' files, properties of any numeric type and order, without normals or radii, colours red green
/// blue (of whole numbers: divided by the largest), which become "Cs"; elements behind the vertices are
/// passed over.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shade/clouds/point_cloud.h"
#include "shade/clouds/ptc_file.h"

namespace trapeze {

/// Channels of matrices are left out.
bool write_ply(const PointCloud& cloud, bool ascii, const CloudSink& sink);

/// Reads ASCII and both binary forms. Nothing, and why, where the bytes are no such file; memory follows from
/// their number alone.
std::optional<PointCloud> read_ply(std::string_view bytes, std::string* problem);

/// Whether a file begins as one.
bool is_ply(std::string_view bytes);

}  // namespace trapeze
