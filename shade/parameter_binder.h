/// Reads a shader's parameters out of its instance, with the shader's own defaults. A value of another type
/// than the shader declares is reported, and the default holds.
#pragma once

#include "core/diagnostics.h"
#include "core/scene.h"
#include "shade/shader.h"

namespace trapeze {

class ParameterBinder {
  public:
    /// diagnostics may be null.
    ParameterBinder(const ShaderInstance& instance, Diagnostics* diagnostics)
        : instance_(instance), diagnostics_(diagnostics) {}

    FloatParameter number(std::string name, float fallback) const;
    ColorParameter color(std::string name, const V3f& fallback) const;
    StringParameter string(std::string name, std::string fallback) const;
    /// Camera space; the instance's value and the fallback are in shader space.
    V3f point(std::string_view name, const V3f& fallback) const;

    const ShaderInstance& instance() const { return instance_; }

  private:
    const Parameter* find(std::string_view name, std::string_view expected,
                          std::initializer_list<ValueType> types) const;

    const ShaderInstance& instance_;
    Diagnostics* diagnostics_;
};

}  // namespace trapeze
