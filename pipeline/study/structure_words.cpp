#include "pipeline/study/structure_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

constexpr std::string_view kOwnTree = "wide";

using Cost = double (*)(const StructureCosts&);

/// What trees are compared by.
struct Criterion {
    const char* what;
    Cost cost;
};

constexpr Criterion kCriteria[] = {
    {"Least for building and rays together", [](const StructureCosts& c) { return c.total(); }},
    {"Least for rays, once it is built", [](const StructureCosts& c) { return c.trace; }},
    {"Built in the least time", [](const StructureCosts& c) { return c.build; }},
    {"Fewest bytes", [](const StructureCosts& c) { return c.bytes; }},
    {"Fewest micropolygons tested", [](const StructureCosts& c) { return c.tests; }},
};

const StructureCosts* find_tree(const StructureRun& run, std::string_view tree) {
    const auto found = std::ranges::find(run.trees, tree, &StructureCosts::tree);
    return found == run.trees.end() ? nullptr : &*found;
}

/// "Fewest bytes: wide in 15 of 18, paper in 3."
std::string words_on_winners(const std::vector<StructureRun>& runs, const Criterion& criterion) {
    std::map<std::string, size_t> wins;
    size_t count = 0;
    for (const StructureRun& run : runs) {
        if (run.trees.empty()) continue;
        ++count;
        ++wins[std::ranges::min_element(run.trees, {}, criterion.cost)->tree];
    }
    std::vector<std::pair<std::string, size_t>> winners(wins.begin(), wins.end());
    std::ranges::stable_sort(winners, std::ranges::greater{}, &std::pair<std::string, size_t>::second);
    std::string text;
    for (const auto& [tree, times] : winners)
        text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", tree, times);
    return fmt::format("{}: {} (of {}).", criterion.what, text, count);
}

/// "1.2 to 3.4", or one figure where all are the same to three digits.
std::string range_text(const std::vector<double>& ratios) {
    const auto [least, most] = std::ranges::minmax(ratios);
    const std::string low = number_text(least), high = number_text(most);
    return low == high ? low : low + " to " + high;
}

/// "with fewer than .2 to 3 rays a micropolygon in 4 of 18, never in 14".
std::string words_on_worth(const std::vector<Worth>& worth) {
    std::string text;
    const auto add = [&](Worth::When when, const char* words, const char* unit) {
        std::vector<double> rays;
        for (const Worth& of_run : worth)
            if (of_run.when == when) rays.push_back(of_run.rays);
        if (rays.empty()) return;
        text += fmt::format("{}{}{}{} in {}", text.empty() ? "" : ", ", words,
                            *unit ? " " + range_text(rays) : "", unit, rays.size());
        if (text.find(" of ") == text.npos) text += fmt::format(" of {}", worth.size());
    };
    constexpr const char* kUnit = " rays a micropolygon";
    add(Worth::When::Always, "always", "");
    add(Worth::When::Fewer, "with fewer than", kUnit);
    add(Worth::When::More, "with more than", kUnit);
    add(Worth::When::Never, "never", "");
    return text;
}

/// How a tree stands to the program's own.
std::string words_on_tree(const std::vector<StructureRun>& runs, const std::string& tree) {
    std::vector<double> build, trace, bytes;
    std::vector<Worth> worth;
    for (const StructureRun& run : runs) {
        const StructureCosts *one = find_tree(run, tree), *own = find_tree(run, kOwnTree);
        if (!one || !own) continue;
        build.push_back(one->build / own->build), trace.push_back(one->trace / own->trace);
        bytes.push_back(one->bytes / own->bytes);
        worth.push_back(worth_of(run, *one, *own));
    }
    if (build.empty()) return {};
    return fmt::format(
        "{} beside {}: built in {} times the time, rays take {} times, bytes {} times; it pays {}.", tree,
        kOwnTree, range_text(build), range_text(trace), range_text(bytes), words_on_worth(worth));
}

}  // namespace

Worth worth_of(const StructureRun& run, const StructureCosts& tree, const StructureCosts& other) {
    const double build_saves = other.build - tree.build, rays_cost = tree.trace - other.trace;
    if (build_saves >= 0 && rays_cost <= 0 && build_saves - rays_cost > 0) return {Worth::When::Always};
    if (build_saves <= 0 && rays_cost >= 0) return {Worth::When::Never};
    return {build_saves > 0 ? Worth::When::Fewer : Worth::When::More,
            run.rays_per_micropolygon * build_saves / rays_cost};
}

std::vector<std::string> words_on_structures(const std::vector<StructureRun>& runs) {
    std::vector<std::string> words;
    for (const Criterion& criterion : kCriteria) words.push_back(words_on_winners(runs, criterion));
    std::vector<std::string> trees;
    for (const StructureRun& run : runs)
        for (const StructureCosts& costs : run.trees)
            if (costs.tree != kOwnTree && std::ranges::find(trees, costs.tree) == trees.end())
                trees.push_back(costs.tree);
    for (const std::string& tree : trees)
        if (std::string of_tree = words_on_tree(runs, tree); !of_tree.empty())
            words.push_back(std::move(of_tree));
    return words;
}

}  // namespace trapeze
