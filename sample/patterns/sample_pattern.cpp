#include "sample/patterns/sample_pattern.h"

#include "sample/patterns/interleaved_pattern.h"
#include "sample/patterns/interval_pattern.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

template <class Pattern>
std::unique_ptr<SamplePattern> make(const RenderContext& context, const MethodSpec&) {
    return std::make_unique<Pattern>(context);
}

std::unique_ptr<SamplePattern> make_interleaved(const RenderContext& context, const MethodSpec& spec) {
    return std::make_unique<InterleavedPattern>(context, spec.number("k"));
}

}  // namespace

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

std::unique_ptr<SamplePattern> make_sample_pattern(const RenderContext& context, const MethodSpec& spec) {
    return find_named(sample_patterns(), spec.name)->make(context, spec);
}

}  // namespace trapeze
