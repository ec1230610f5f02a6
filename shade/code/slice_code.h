/// The part of a program that leads to one variable: what rays that want opacity alone ask for.
#pragma once

#include <string_view>

#include "shade/code/program.h"

namespace trapeze::rsl {

/// A program that sets a predefined variable as the whole one does, and does besides what others can see:
/// text, baked points. Parameters and other variables may be left as they were, and are no longer named where
/// nothing uses them. Storage is that of the whole program, inferred or not.
Program slice(const Program& program, std::string_view variable);

}  // namespace trapeze::rsl
