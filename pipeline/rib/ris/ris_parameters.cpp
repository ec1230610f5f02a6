/// RIS writes its parameters with their types ("color diffuseColor", "reference float gain"), so nothing is
/// looked up in declarations, and an odd one is kept as it is.
#include "pipeline/rib/ris/ris_parameters.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace trapeze::rib {
namespace {

/// Odd numbers are passed over: other renderers draw such scenes too.
bool all_finite(const std::vector<float>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

/// Older files leave the type out; then the name tells.
bool RisParameter::is_color() const {
    return type.starts_with("color") || (type.empty() && name.find("olor") != std::string::npos);
}

/// The last word of a token is the name, the one before it the type. What stands before the type (a class,
/// "reference") is passed over, but for the reference.
RisParameters RisParameters::read(ArgumentCursor& c) {
    RisParameters result;
    while (!c.done()) {
        const std::string token = c.string("a parameter's name");
        if (c.done()) throw RequestError{in_quotes(token) + " has no value", {}};
        RisParameter parameter;
        std::istringstream words(token);
        for (std::string word; words >> word;) {
            parameter.is_reference |= word == "reference";
            parameter.type = std::exchange(parameter.name, word);
        }
        Argument& value = c.take_here();
        parameter.strings = value.strings;
        const bool is_number = value.kind == Argument::Kind::Number;
        parameter.numbers = value.take_numbers();
        while (is_number && c.next_is_number() && !c.next_is_array())
            parameter.numbers.push_back(c.number("a value"));
        result.values_.push_back(std::move(parameter));
    }
    return result;
}

/// The last one of a name counts.
const RisParameter* RisParameters::find(std::string_view name) const {
    for (size_t i = values_.size(); i-- > 0;)
        if (values_[i].name == name) return &values_[i];
    return nullptr;
}

float RisParameters::number_or(std::string_view name, float otherwise) const {
    const RisParameter* found = find(name);
    if (!found || found->numbers.size() != 1 || !all_finite(found->numbers)) return otherwise;
    return found->numbers[0];
}

/// A reference has a name for its value and no numbers, and is no colour here: patterns are followed by
/// look_of_bxdf().
std::optional<V3f> RisParameters::color(std::string_view name) const {
    const RisParameter* found = find(name);
    if (!found || !all_finite(found->numbers)) return {};
    const auto& v = found->numbers;
    if (v.size() == 1) return V3f(v[0], v[0], v[0]);
    return v.size() == 3 ? std::optional(V3f(v[0], v[1], v[2])) : std::nullopt;
}

std::string RisParameters::text(std::string_view name) const {
    const RisParameter* found = find(name);
    return found && !found->is_reference && !found->strings.empty() ? found->strings[0] : std::string();
}

/// Declared like a parameter that RSL passes by name: uniform.
void set_number(ShaderInstance& shader, const char* name, float value) {
    shader.parameters.set({name, {StorageClass::Uniform, ValueType::Float, 1}, {value}, {}});
}

/// Replaces what the shader has of that name.
void set_triple(ShaderInstance& shader, const char* name, ValueType type, const V3f& value) {
    shader.parameters.set({name, {StorageClass::Uniform, type, 1}, {value.x, value.y, value.z}, {}});
}

V3f triple_or(const ShaderInstance& shader, const char* name, const V3f& fallback) {
    const Parameter* given = shader.parameters.find(name);
    return given && given->floats.size() == 3 ? V3f(given->floats[0], given->floats[1], given->floats[2])
                                              : fallback;
}

void set_text(ShaderInstance& shader, const char* name, std::string value) {
    shader.parameters.set({name, {StorageClass::Uniform, ValueType::String, 1}, {}, {std::move(value)}});
}

}  // namespace trapeze::rib
