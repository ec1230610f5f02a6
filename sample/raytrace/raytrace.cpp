/// The row "raytrace": rays through a tree of grids, the fast one or the paper's.
#include <algorithm>
#include <array>
#include <utility>

#include "accel/wide/wide_tree.h"
#include "sample/raytrace/binary_raytrace.h"
#include "sample/raytrace/wide_raytrace.h"

namespace trapeze {
namespace {

/// All trees' options in one list, since a method has one row; check_raytrace() says which go with which
/// tree. First values are the defaults.
const std::vector<SpecOption>& raytrace_options() {
    static const std::vector<SpecOption> options = {
        {"tree",
         {"wide", "paper", "interpolated", "msbvh", "lbvh", "refit", "mbkd", "gs", "dynamic", "loose",
          "twolevel", "slabs"}},
        {"bundle", {"on", "off"}},
        {"bounds", {"obb", "aabb", "aabb4d"}},
        {"split", {"parametric", "sah"}},
        {"orient_split", {"on", "off"}},
        {"orient_propagation", {"on", "off"}},
        {"bounds_from", {"contents", "children"}},
        {"ray_frames", {"turned", "cached"}},
        {"ray_sort", {"on", "off"}},
        {"leaf", {"8", "4", "16", "32"}},
        {"keys", {"grids", "1", "2", "3", "5", "9", "17"}},
        {"clip", {"polygon", "box", "naive"}},
        {"refit", {"off", "on"}},
        {"budget", {"2", "1", "4", "8"}},
        {"duplicates", {"16", "2", "4", "8", "64"}},
        {"plane", {".5", "0", "1"}},
        {"weight", {"time", "whole"}},
        {"guests", {"silent", "return"}},
        {"mailbox", {"on", "off"}},
        {"thinning", {"off", "1.1", "1.2", "1.5", "2"}},
        {"order", {"shuffled", "given"}},
        {"reinsert", {"ancestor", "root", "rebuilt"}},
        {"levels", {"18", "9", "12", "15", "21"}},
        {"place", {"size", "lowest"}},
        {"skip", {"on", "off"}},
        {"planes", {"moving", "spacetime"}},
    };
    return options;
}

/// The trees that an option but "tree" is for: names in the order of its values, separated by |.
std::string_view trees_with(std::string_view option) {
    struct Row {
        std::string_view option, trees;
    };
    static constexpr std::array<Row, 19> kRows{{
        {"bundle", "paper|interpolated|msbvh|lbvh|refit"},
        {"ray_sort", "paper|interpolated|msbvh|lbvh|refit|mbkd|gs|dynamic|loose|twolevel|slabs"},
        {"leaf", "paper|interpolated|msbvh|lbvh|refit|mbkd|slabs"},
        {"keys", "interpolated|msbvh|lbvh|refit"},
        {"clip", "msbvh"},
        {"refit", "msbvh|lbvh"},
        {"budget", "msbvh"},
        {"duplicates", "mbkd"},
        {"plane", "mbkd"},
        {"weight", "mbkd"},
        {"guests", "mbkd"},
        {"mailbox", "mbkd"},
        {"thinning", "dynamic"},
        {"order", "gs|dynamic"},
        {"reinsert", "dynamic"},
        {"levels", "loose"},
        {"place", "loose"},
        {"skip", "loose"},
        {"planes", "slabs"},
    }};
    for (const Row& row : kRows)
        if (row.option == option) return row.trees;
    return "paper";
}

/// Options at their default are let through whatever the tree, for they are filled in before the check. An
/// option without effect is an error: measurements that name it would say something else than was measured.
std::string check_raytrace(const MethodSpec& spec) {
    for (const SpecOption& option : raytrace_options()) {
        if (option.name == "tree" || spec[option.name] == option.values.front()) continue;
        const std::string trees(trees_with(option.name));
        if (("|" + trees + "|").find("|" + std::string(spec["tree"]) + "|") == std::string::npos)
            return "option \"" + std::string(option.name) + "\" is for tree=" + trees;
    }
    return {};
}

/// A little more than processes took in addition to one that builds nothing, on pictures of 150,000 to
/// 600,000 micropolygons, most of whose grids have one or many, with one to sixteen segments.
BuildMemory build_memory(const MethodSpec& spec) {
    struct Row {
        std::string_view tree;
        BuildMemory memory;
        bool swept_boxes;  ///< it is made of boxes of all micropolygons at the keys
    };
    static constexpr std::array<Row, 10> kRows{{
        {"paper", {0, 20, 700}, false},
        {"interpolated", {100, 100, 256}, true},
        {"refit", {100, 100, 256}, true},
        {"lbvh", {80, 60, 256}, true},
        {"msbvh", {120, 100, 256}, true},
        {"mbkd", {120, 0, 256}, true},
        {"gs", {190, 0, 8}, false},
        {"dynamic", {190, 0, 8}, false},
        {"twolevel", {190, 0, 8}, false},
        {"slabs", {160, 40, 64}, false},
    }};
    const std::string_view tree = spec["tree"];
    BuildMemory memory;
    bool swept_boxes = false;
    for (const Row& row : kRows)
        if (row.tree == tree) memory = row.memory, swept_boxes = row.swept_boxes;
    // Nodes have as many keys as any grid has, or as the spec says.
    if (swept_boxes && tree != "mbkd") {
        if (spec["keys"] == "grids")
            memory.per_most_segment = std::exchange(memory.per_segment, 0);
        else
            memory.per_micropolygon += std::exchange(memory.per_segment, 0) *
                                       static_cast<size_t>(std::max(1, spec.number("keys") - 1));
    }
    if (tree == "slabs")  // nodes have as many keys as any grid has, or one
        memory.per_most_segment = spec["planes"] == "moving" ? std::exchange(memory.per_segment, 0) : 0;
    // So many times may a micropolygon be in the tree.
    const size_t times = tree == "msbvh"  ? 1 + static_cast<size_t>(spec.number("budget"))
                         : tree == "mbkd" ? 1 + static_cast<size_t>(spec.number("duplicates"))
                                          : 1;
    memory.per_micropolygon *= times, memory.per_segment *= times, memory.per_most_segment *= times;
    if (swept_boxes)  // of which there is one more than segments
        memory.per_micropolygon += sizeof(MicropolygonId) + sizeof(Box3f),
            memory.per_segment += sizeof(Box3f);
    // Nodes, whether anything is in them or not.
    if (tree == "loose") memory = {60, 0, 8, size_t{48} << (spec.number("levels") + 1)};
    return memory;
}

}  // namespace

/// One name for all trees: the option "tree" chooses among them, as hits do not depend on it.
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
                                                            : prepare_binary_raytrace(input);
            },
            check_raytrace,
            true,
            true,
            "clip=naive",
            build_memory};
}

}  // namespace trapeze
