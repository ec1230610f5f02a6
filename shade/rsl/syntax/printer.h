/// Trees and types as source text.
#pragma once

#include <string>

#include "shade/rsl/syntax/ast.h"

namespace trapeze::rsl {

/// Source text that parses to the same tree. Conversions that the source did not name are left out.
std::string print(const TranslationUnit& unit);
std::string print(const Expression& expression);
std::string print(const Struct& structure);
/// "uniform float[3]" and such; without storage where that is unspecified.
std::string print(const Type& type, Storage storage = Storage::Unspecified);

}  // namespace trapeze::rsl
