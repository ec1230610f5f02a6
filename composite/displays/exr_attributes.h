/// The attributes of OpenEXR headers that Displays name: parameters "exrheader_NAME".
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <string>
#include <vector>

#include "core/scene/parameters.h"

namespace trapeze {

/// Why a header cannot have the attribute, whose name is without the prefix; empty when it can.
std::string problem_of_attribute(const Parameter& attribute);

/// Adds the attributes to the header, in place of attributes that it may have by these names: floats,
/// integers and strings, arrays of them, colours, points, vectors, normals and matrices, each as OpenEXR's
/// type. None of them may have a problem_of_attribute().
void add_attributes(Imf::Header& header, const std::vector<Parameter>& attributes);

}  // namespace trapeze
