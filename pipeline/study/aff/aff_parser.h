/// Reads AFF files: those of BART, A Benchmark for Animated Ray Tracing (Lext, Assarsson, Moller, IEEE
/// Computer Graphics and Applications 21, 2, 2001), which are NFF files with animations. What files may say
/// is read as BART's own parse.c reads it, but for the limits, and that includes are relative to the file
/// that has them.
///
/// statement                              what becomes of it
/// v, a, d, i, k, x, xs                   the view, the times, the level of detail, includes, keyframes,
/// transforms p, pp, tt, ttp, m, s, c                triangles: polygons are fans about their first corner
/// tpa                                    a triangle with keys
/// l, la, b, f, fm, am; normals, textures nothing: they are read over
#pragma once

#include <string>

#include "pipeline/study/aff/aff_contents.h"

namespace trapeze {

/// False, with *problem = "file:line: error: what", where a file is not as it should be. A file that is not
/// there or too large is a problem of the line that includes it, and of line 1 where that is `path` itself.
bool read_aff(const std::string& path, AffContents* contents, std::string* problem);

}  // namespace trapeze
