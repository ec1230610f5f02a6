#include "sample/patterns/sample_pattern.h"

#include "sample/patterns/interleaved_pattern.h"
#include "sample/patterns/interval_pattern.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

/// For patterns without options.
template <class Pattern>
std::unique_ptr<SamplePattern> make(const RenderContext& context, const MethodSpec&) {
    return std::make_unique<Pattern>(context);
}

std::unique_ptr<SamplePattern> make_interleaved(const RenderContext& context, const MethodSpec& spec) {
    return std::make_unique<InterleavedPattern>(context, spec.number("k"));
}

}  // namespace

/// Made on first use and never changed after, so that all threads may read it. Which one is the default is a
/// method's to say.
const std::vector<PatternKind>& sample_patterns() {
    static const std::vector<PatternKind> kinds = {
        {"stratified", {}, make<StratifiedPattern>},
        {"interval", {}, make<IntervalPattern>},
        {"interleaved", {{"k", {"2", "1", "4"}}}, make_interleaved},
    };
    return kinds;
}

std::optional<MethodSpec> parse_pattern(std::string_view text, std::string* error) {
    return parse_spec_of(sample_patterns(), "sample pattern", text, error);
}

/// The name is in the table, or the spec would not have been parsed.
std::unique_ptr<SamplePattern> make_sample_pattern(const RenderContext& context, const MethodSpec& spec) {
    return find_named(sample_patterns(), spec.name)->make(context, spec);
}

}  // namespace trapeze
