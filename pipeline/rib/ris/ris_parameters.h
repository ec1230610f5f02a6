/// Parameters of the path tracer's shaders (RIS), which are taken as they stand: nothing declares them, and
/// what is not known or odd among them is no error of the scene's.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "core/scene/scene.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

/// One, as the request has it; nothing has looked at whether its shader knows it.
struct RisParameter {
    std::string name;
    std::string type;           ///< the word before the name, such as "color" or "float[4]"; may be empty
    bool is_reference = false;  ///< `strings` name the outputs of other shaders
    std::vector<float> numbers;
    std::vector<std::string> strings;

    bool is_color() const;
};

/// In the order of the request, repeated names included; the last of a name counts, unlike in lists of
/// RISpec.
class RisParameters {
  public:
    /// Name and value pairs to the end of the request. Throws a RequestError for a name without a value.
    static RisParameters read(ArgumentCursor& cursor);

    const std::vector<RisParameter>& all() const { return values_; }
    /// Null when it is not there.
    const RisParameter* find(std::string_view name) const;
    /// A finite number, not a reference.
    float number_or(std::string_view name, float otherwise) const;
    std::optional<V3f> color(std::string_view name) const;  ///< one number is a grey
    std::string text(std::string_view name) const;          ///< empty when there is none

  private:
    std::vector<RisParameter> values_;
};

/// Uniform parameters of a shader that stands in for one of RIS.
void set_number(ShaderInstance& shader, const char* name, float value);
void set_triple(ShaderInstance& shader, const char* name, ValueType type, const V3f& value);
V3f triple_or(const ShaderInstance& shader, const char* name, const V3f& fallback);
void set_text(ShaderInstance& shader, const char* name, std::string value);

}  // namespace trapeze::rib
