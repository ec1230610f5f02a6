/// The language's reserved words.
#include <algorithm>
#include <array>

#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {
namespace {

constexpr struct {
    std::string_view name;
    Base base;
} kBases[] = {{"float", Base::Float},   {"color", Base::Color},   {"point", Base::Point},
              {"vector", Base::Vector}, {"normal", Base::Normal}, {"matrix", Base::Matrix},
              {"string", Base::String}, {"void", Base::Void}};

// Words that cannot name variables or functions (RISpec 3.2, appendix B). Kinds of shaders are not among
// them: "light" and "surface" are names in many shaders.
constexpr std::string_view kReserved[] = {
    "break", "color",       "continue",   "else",    "extern", "float",  "for",   "gather",
    "if",    "illuminance", "illuminate", "matrix",  "normal", "output", "point", "return",
    "solar", "string",      "uniform",    "varying", "vector", "void",   "while"};

}  // namespace

/// A linear search over eight words; the lexer's tokens carry no number for them.
Base base_named(std::string_view name) {
    for (const auto& row : kBases)
        if (row.name == name) return row.base;
    return Base::Void;
}

/// A Bool has no word in the language; messages call it so.
std::string_view name_of(Base base) {
    for (const auto& row : kBases)
        if (row.base == base) return row.name;
    return "bool";
}

std::string_view name_of(ShaderKind kind) {
    static constexpr std::string_view kNames[] = {"surface", "displacement", "light", "volume", "imager"};
    return kNames[static_cast<size_t>(kind)];
}

bool is_reserved(std::string_view name) {
    return std::find(std::begin(kReserved), std::end(kReserved), name) != std::end(kReserved);
}

}  // namespace trapeze::rsl
