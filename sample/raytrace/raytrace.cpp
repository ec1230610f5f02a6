/// The row "raytrace": rays through a tree of grids, the fast one or the paper's.
#include "accel/wide/wide_tree.h"
#include "sample/raytrace/paper_raytrace.h"
#include "sample/raytrace/wide_raytrace.h"

namespace trapeze {
namespace {

const std::vector<SpecOption>& raytrace_options() {
    static const std::vector<SpecOption> options = {
        {"tree", {"wide", "paper"}},           {"bundle", {"on", "off"}},
        {"bounds", {"obb", "aabb", "aabb4d"}}, {"split", {"parametric", "sah"}},
        {"orient_split", {"on", "off"}},       {"orient_propagation", {"on", "off"}},
        {"ray_sort", {"on", "off"}},           {"leaf", {"8", "4", "16", "32"}},
    };
    return options;
}

/// All options but "tree" choose what the paper's tree is like.
std::string check_raytrace(const MethodSpec& spec) {
    if (spec["tree"] == "paper") return {};
    for (const SpecOption& option : raytrace_options())
        if (option.name != "tree" && spec[option.name] != option.values.front())
            return "option \"" + std::string(option.name) + "\" is for tree=paper";
    return {};
}

}  // namespace

VisibilityMethod raytrace_method() {
    return {"raytrace",
            MethodKind::RayTracer,
            raytrace_options(),
            stratified_pattern,
            any_pattern,
            [](const VisibilityInput& input) {
                // The wide tree's ids are of 32 bits; the hits are the same.
                const bool fits = input.grids.grids.size() <= WideTree::kMaxGrids;
                return input.spec["tree"] == "wide" && fits ? prepare_wide_raytrace(input)
                                                            : prepare_paper_raytrace(input);
            },
            check_raytrace,
            true,
            true};
}

}  // namespace trapeze
