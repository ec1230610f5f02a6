/// How numbers become a file's: as floats, halves, or whole numbers, encoded or not.
#pragma once

#include <string_view>

#include "composite/displays/display_plan.h"
#include "core/diagnostics.h"

namespace trapeze {

/// A Display's own "quantize": zero one min max; the dither is apart. Null where it has none that can be
/// used.
const Parameter* own_quantization(const Display& display);
/// The options' Quantize of a type or variable: one min max dither. Null where there is none.
const Parameter* given_quantization(const Options& options, std::string_view type);

/// Chooses the pixel type, the quantization and the encoding of a plan whose format and channels are there.
/// What the display says ("quantize", "dither", "type") comes before the options' Quantize of the variable,
/// and that before Quantize of "rgba" or "z". Variables that are no colours stay floats unless Quantize names
/// them or the display has its own. Values that mean nothing are told and have no effect.
void choose_pixel_type(const Display& display, const Options& options, Diagnostics& diagnostics,
                       DisplayPlan& plan);

}  // namespace trapeze
