#include "sample/visibility.h"

#include <algorithm>
#include <cctype>

#include "sample/cut_hits.h"
#include "sample/level_of_detail.h"
#include "sample/load_plugin.h"

namespace trapeze {

namespace {

/// The rows of visibility_methods.def, and those that plugins have added. Made at the first call, so that it
/// is there however early a plugin asks.
std::vector<VisibilityMethod>& method_table() {
    static std::vector<VisibilityMethod> methods = {
#define TRAPEZE_METHOD(row) row(),
#include "sample/visibility_methods.def"
#undef TRAPEZE_METHOD
#ifdef TRAPEZE_HAVE_EMBREE
        embree_method(),
#endif
    };
    return methods;
}

}  // namespace

const std::vector<VisibilityMethod>& visibility_methods() {
    return method_table();
}

/// Names are letters and digits because a spec's punctuation (":", ",", "=") and lists of methods (" ", ";")
/// take the rest.
bool add_visibility_method(const VisibilityMethod& method, std::string* error) {
    const auto is_part_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    if (method.name.empty() || !std::ranges::all_of(method.name, is_part_of_name))
        *error = "the name of its method, \"" + std::string(method.name) + "\", is not of letters and digits";
    else if (find_named(method_table(), method.name))
        *error = "there is a visibility method \"" + std::string(method.name) + "\" already";
    else if (!method.natural_pattern || !method.honours || !method.prepare)
        *error = "its method \"" + std::string(method.name) + "\" lacks a function";
    else
        return method_table().push_back(method), true;
    return false;
}

/// Every method, a plugin's too, is wrapped alike. A wrapper that has nothing to do returns the method
/// itself, so that scenes without solids or levels of detail pay nothing.
std::unique_ptr<Visibility> Sampler::prepare(const RenderContext& context, const Grids& grids) const {
    const VisibilityMethod& row = *find_named(visibility_methods(), method.name);
    auto visibility = row.prepare({context, grids, method});
    return with_cuts(with_levels_of_detail(std::move(visibility), context, grids), context, grids);
}

BuildMemory Sampler::build_memory() const {
    const VisibilityMethod& row = *find_named(visibility_methods(), method.name);
    return row.build_memory ? row.build_memory(method) : BuildMemory();
}

/// Levels are the stratified pattern's alone, and come as lists of pixels.
bool Sampler::takes_levels() const {
    return find_named(visibility_methods(), method.name)->takes_lists && pattern.name == "stratified";
}

std::string Sampler::name() const {
    return spec_text(method, find_named(visibility_methods(), method.name)->options);
}

/// Whoever gets a Sampler may rely on it: name, options and pattern exist, and the method's libraries are
/// there (VisibilityMethod::check). All later look-ups by name succeed.
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
