/// Colour spaces of the shading language: "rgb", "hsv", "hsl", "xyz" (also "XYZ"), "xyY", "YIQ" (also "yiq").
///
/// rgb is linear with the primaries and white of Rec. 709; hsv and hsl are the hexagonal models with hues of
/// 0..1, of whatever range the rgb values have; YIQ is NTSC's.
#pragma once

#include <string_view>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// The kernel with operands out, in (triples) that converts between spaces; null for an unknown name. Black
/// has hue 0, saturation 0, and chromaticity 0.
Kernel find_color_conversion(std::string_view from, std::string_view to);

}  // namespace trapeze::vm
