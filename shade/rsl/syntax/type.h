/// The shading language's types (RISpec 3.2, section 11).
#pragma once

#include <cstdint>

namespace trapeze::rsl {

/// Bool is what comparisons give; the language has no name for it.
enum class Base : uint8_t { Void, Bool, Float, Color, Point, Vector, Normal, Matrix, String };

/// How often a variable has a value: once, or at each vertex.
/// Unspecified is what the source leaves open: a shader's parameter is uniform then, a local varying, and a
/// function's parameter what its arguments are (propagate_varying.h).
enum class Storage : uint8_t { Unspecified, Uniform, Varying };

/// The kinds of RISpec 3.2 but for transformation shaders, which no renderer ever had. The order is relied on
/// by tables of names.
enum class ShaderKind : uint8_t { Surface, Displacement, Light, Volume, Imager };

/// A base type and, for arrays, a length. Storage is no part of it: it belongs to variables. Types are equal
/// when both fields are, so an array of any length is equal to none of a known length. Arrays have one
/// dimension, as in the language.
struct Type {
    /// `float a[]`: an array whose length is known only in a run: one that may be resized, or a function's
    /// parameter.
    static constexpr int kUnsized = -1;

    Base base = Base::Void;
    int length = 0;  ///< elements of an array; 0: not an array

    /// Arrays of a length that is not known yet are arrays too.
    bool is_array() const { return length != 0; }
    bool is_unsized() const { return length == kUnsized; }
    bool is_triple() const {
        return base == Base::Color || base == Base::Point || base == Base::Vector || base == Base::Normal;
    }
    /// A point, vector or normal.
    bool is_geometric() const { return is_triple() && base != Base::Color; }
    bool operator==(const Type&) const = default;
};

/// Floats in one element: 1, 3 or 16; strings and void have none, a Bool has a lane mask in one.
constexpr int width_of(Base base) {
    switch (base) {
        case Base::Void:
        case Base::String:
            return 0;
        case Base::Bool:
        case Base::Float:
            return 1;
        case Base::Matrix:
            return 16;
        default:
            return 3;
    }
}

}  // namespace trapeze::rsl
