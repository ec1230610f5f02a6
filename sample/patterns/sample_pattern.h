/// Where, when and through which point of the lens samples look. The pattern is chosen apart from the
/// visibility method; every method has a natural one, and a method may honour only some.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/samples.h"
#include "core/scene/render_context.h"
#include "sample/names/method_spec.h"

namespace trapeze {

class SamplePattern {
  public:
    virtual ~SamplePattern() = default;

    /// All samples of a rectangle of pixels. What a pixel gets depends on the pixel alone.
    virtual void make_tile(const PixelRect& pixels, SampleTile& tile) const = 0;
};

/// A row of the table of patterns.
struct PatternKind {
    std::string_view name;
    std::vector<SpecOption> options;
    std::unique_ptr<SamplePattern> (*make)(const RenderContext& context, const MethodSpec& spec);
};

const std::vector<PatternKind>& sample_patterns();

/// Reads the name of a pattern, as "stratified", against the table. Empty with *error set when it is wrong.
std::optional<MethodSpec> parse_pattern(std::string_view text, std::string* error);

/// `spec` is parse_pattern's.
std::unique_ptr<SamplePattern> make_sample_pattern(const RenderContext& context, const MethodSpec& spec);

}  // namespace trapeze
