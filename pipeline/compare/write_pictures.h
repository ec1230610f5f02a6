/// The pictures and heat maps of a comparison as OpenEXR files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/compare/comparison.h"

namespace trapeze {

/// Writes into a folder: METHOD_8x8.exr, METHOD_8x8_tests.exr and METHOD_8x8_nodes.exr (per sample, in
/// floats; not of methods that do not say), reference_32x32.exr; each file whole or not at all. What goes
/// wrong is reported, and the others are still written; then it returns false. `frame` is the comparison's;
/// `on_file` is called with the name of each file that has been written.
bool write_pictures(const Comparison& comparison, const SharedFrame& frame, const std::string& folder,
                    const std::string& software, const std::function<void(const std::string&)>& on_file);

/// A method's name as part of a file name: what is no letter, digit or '.' becomes '-'.
std::string file_name_of(const std::string& method);

}  // namespace trapeze
