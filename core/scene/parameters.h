/// Typed, named values as RIB's parameter lists carry them: primitive variables, shader parameters, options.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trapeze {

/// How often a primitive variable occurs on a primitive (RISpec 5.1).
enum class StorageClass : uint8_t { Constant, Uniform, Varying, Vertex, FaceVarying, FaceVertex };

/// What one value of a parameter is.
enum class ValueType : uint8_t { Float, Integer, String, Color, Point, Vector, Normal, HPoint, Matrix };

/// Floats (or integers, or strings) that make one element of the type.
constexpr int component_count(ValueType type) {
    switch (type) {
        case ValueType::Float:
        case ValueType::Integer:
        case ValueType::String:
            return 1;
        case ValueType::Color:
        case ValueType::Point:
        case ValueType::Vector:
        case ValueType::Normal:
            return 3;
        case ValueType::HPoint:
            return 4;
        case ValueType::Matrix:
            return 16;
    }
    return 1;
}

/// The shaders that run where a ray hits: a value may be sent to one kind of them.
enum class HitShader : uint8_t { Surface, Displacement, Volume };

/// What a value is: its class, type and array length ("varying float[2]").
struct Declaration {
    StorageClass storage = StorageClass::Uniform;
    ValueType type = ValueType::Float;
    int array_length = 1;

    int floats_per_item() const { return component_count(type) * array_length; }
    bool operator==(const Declaration&) const = default;
};

/// One value of a parameter list. Strings are in `strings`, everything else (integers too) in `floats`.
struct Parameter {
    std::string name;
    Declaration declaration;
    std::vector<float> floats;
    std::vector<std::string> strings;

    bool is_string() const { return declaration.type == ValueType::String; }
};

/// The first number or string of a parameter, or the fallback where there is none, or it is empty.
inline float first_number(const Parameter* parameter, float fallback) {
    return parameter && !parameter->floats.empty() ? parameter->floats[0] : fallback;
}
inline std::string first_string(const Parameter* parameter, std::string fallback) {
    return parameter && !parameter->strings.empty() ? parameter->strings[0] : fallback;
}

/// A parameter list in the order of the file; when a name occurs twice the last one counts.
struct ParameterList {
    std::vector<Parameter> values;

    const Parameter* find(std::string_view name) const {
        for (size_t i = values.size(); i-- > 0;)
            if (values[i].name == name) return &values[i];
        return nullptr;
    }
    Parameter* find(std::string_view name) {
        return const_cast<Parameter*>(static_cast<const ParameterList*>(this)->find(name));
    }
    float float_or(std::string_view name, float fallback) const { return first_number(find(name), fallback); }
    std::string string_or(std::string_view name, std::string fallback) const {
        return first_string(find(name), std::move(fallback));
    }
    /// Replaces the value of the same name, or appends.
    void set(Parameter value) {
        if (Parameter* old = find(value.name))
            *old = std::move(value);
        else
            values.push_back(std::move(value));
    }
};

}  // namespace trapeze
