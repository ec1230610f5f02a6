#include "sample/visibility.h"

#include "sample/cut_hits.h"
#include "sample/level_of_detail.h"

namespace trapeze {

const std::vector<VisibilityMethod>& visibility_methods() {
    static const std::vector<VisibilityMethod> methods = {
#define TRAPEZE_METHOD(row) row(),
#include "sample/visibility_methods.def"
#undef TRAPEZE_METHOD
#ifdef TRAPEZE_HAVE_EMBREE
        embree_method(),
#endif
    };
    return methods;
}

std::unique_ptr<Visibility> Sampler::prepare(const RenderContext& context, const Grids& grids) const {
    const VisibilityMethod& row = *find_named(visibility_methods(), method.name);
    auto visibility = row.prepare({context, grids, method});
    return with_cuts(with_levels_of_detail(std::move(visibility), context, grids), context, grids);
}

bool Sampler::takes_levels() const {
    return find_named(visibility_methods(), method.name)->takes_lists && pattern.name == "stratified";
}

std::string Sampler::name() const {
    return spec_text(method, find_named(visibility_methods(), method.name)->options);
}

std::optional<Sampler> choose_sampler(std::string_view method, std::string_view pattern, std::string* error) {
    const auto method_spec = parse_spec_of(visibility_methods(), "visibility method", method, error);
    if (!method_spec) return {};
    const VisibilityMethod& row = *find_named(visibility_methods(), method_spec->name);
    if (const std::string wrong = row.check ? row.check(*method_spec) : ""; !wrong.empty()) {
        *error = "\"" + std::string(method) + "\": " + wrong;
        return {};
    }
    const auto pattern_spec =
        parse_pattern(pattern.empty() ? row.natural_pattern(*method_spec) : std::string(pattern), error);
    if (!pattern_spec) return {};
    if (!row.honours(*method_spec, *pattern_spec)) {
        *error = "\"" + std::string(method) + "\" cannot resolve samples of the pattern \"" +
                 std::string(pattern) + "\"; its own is \"" + row.natural_pattern(*method_spec) + "\"";
        return {};
    }
    return Sampler{*method_spec, *pattern_spec};
}

}  // namespace trapeze
