#include "sample/raytrace/binary_raytrace.h"

#include <algorithm>

#include "accel/dynamic/insertion_tree.h"
#include "accel/dynamic/loose_tree.h"
#include "accel/dynamic/two_level_tree.h"
#include "accel/moving/kd_tree.h"
#include "accel/moving/moving_tree.h"
#include "accel/moving/slab_tree.h"
#include "accel/paper/micropolygon_tree.h"
#include "accel/paper/paper_tree.h"
#include "accel/paper/top_level.h"
#include "sample/hit_lists.h"
#include "sample/raytrace/ray_order.h"

namespace trapeze {
namespace {

/// Rays of a beam. 64 to 512 are within 10 % of each other in tests/bench/trace_bench.cpp.
constexpr size_t kGroupSize = 128;

/// From words to a tree's options, in this and the next five; the words have been checked against the table
/// (complete_spec), and first values are the defaults.
PaperTreeOptions paper_options(const MethodSpec& spec) {
    using Bounds = PaperTreeOptions::Bounds;
    PaperTreeOptions options;
    if (spec["bounds"] == "aabb") options.bounds = Bounds::AxisAligned;
    if (spec["bounds"] == "aabb4d") options.bounds = Bounds::WholeMotion;
    options.orient_split = spec.is_on("orient_split");
    options.orient_propagation = spec.is_on("orient_propagation");
    options.bounds_from_children = spec["bounds_from"] == "children";
    options.keep_turned_rays = spec["ray_frames"] == "cached";
    options.leaf = spec.number("leaf");
    return options;
}

/// Options of the split builder alone are taken for "msbvh"; the others keep the defaults, whatever is said.
MovingTreeOptions moving_options(const MethodSpec& spec) {
    MovingTreeOptions options;
    options.leaf = spec.number("leaf");
    options.keys = spec["keys"] == "grids" ? 0 : spec.number("keys");
    if (spec["tree"] == "lbvh") options.topology = MovingTreeOptions::Topology::Morton;
    if (spec["tree"] != "msbvh") return options;
    options.budget = spec.number("budget");
    if (spec["clip"] == "box") options.clipping = MovingTreeOptions::Clipping::Box;
    if (spec["clip"] == "naive") options.clipping = MovingTreeOptions::Clipping::Naive;
    return options;
}

/// The plane's time is that at which positions of moving micropolygons are taken when a split is chosen.
KdTreeOptions kd_options(const MethodSpec& spec) {
    KdTreeOptions options;
    options.plane_time = spec["plane"] == "0" ? 0.0f : spec["plane"] == "1" ? 1.0f : 0.5f;
    if (spec["weight"] == "whole") options.weight = KdTreeOptions::Weight::Whole;
    if (spec["guests"] == "return") options.guests = KdTreeOptions::Guests::Return;
    options.budget = spec.number("duplicates");
    options.leaf = spec.number("leaf");
    options.mailbox = spec.is_on("mailbox");
    return options;
}

/// Values have been checked against the method's table of options, so nothing here can fail.
InsertionOptions insertion_options(const MethodSpec& spec) {
    InsertionOptions options;
    options.passes = spec["tree"] == "dynamic" ? 2 : 0;
    if (spec["order"] == "given") options.order = InsertionOptions::Order::Given;
    if (spec["reinsert"] == "root") options.reinsertion = InsertionOptions::Reinsertion::Root;
    if (spec["reinsert"] == "rebuilt") options.reinsertion = InsertionOptions::Reinsertion::Rebuilt;
    if (spec["thinning"] != "off") options.thinning = std::stof(std::string(spec["thinning"]));
    return options;
}

SlabTreeOptions slab_options(const MethodSpec& spec) {
    using Planes = SlabTreeOptions::Planes;
    return {spec["planes"] == "spacetime" ? Planes::SpaceTime : Planes::Moving, spec.number("leaf")};
}

LooseOptions loose_options(const MethodSpec& spec) {
    return {spec.number("levels"), spec["place"] == "size", spec.is_on("skip")};
}

/// Builds a tree of grids with the options that a spec has for it.
template <class Tree>
Tree built(const VisibilityInput& input) {
    const MethodSpec& spec = input.spec;
    if constexpr (std::is_same_v<Tree, MovingTree>) {
        return Tree(input.grids, moving_options(spec));
    } else if constexpr (std::is_same_v<Tree, KdTree>) {
        return Tree(input.grids, kd_options(spec));
    } else if constexpr (std::is_same_v<Tree, SlabTree>) {
        return Tree(input.grids, slab_options(spec));
    } else if constexpr (std::is_same_v<Tree, InsertionTree>) {
        Tree tree(insertion_options(spec));
        tree.build(input.grids);
        return tree;
    } else if constexpr (std::is_same_v<Tree, LooseTree>) {
        Tree tree(loose_options(spec));
        tree.build(input.grids);
        return tree;
    } else if constexpr (std::is_same_v<Tree, TwoLevelTree>) {
        Tree tree;
        tree.build(input.grids);
        return tree;
    } else {
        return Tree(input.grids, paper_options(spec));
    }
}

/// Whether beams can look for the part of a tree that their rays may meet.
template <class Tree>
inline constexpr bool kHasParts = requires(const Tree& tree) {
    tree.top();
};

/// Says where a tree had no budget left for cuts that it would have made.
void tell_of_budget(const VisibilityInput& input, const BuildStats& stats) {
    if (stats.lacked_budget && input.context.diagnostics)
        input.context.diagnostics->note({},
                                        "splits added " + std::to_string(stats.tree_duplicates) +
                                            " references; some nodes were not divided, for want of more",
                                        "budget");
}

/// What a thread needs for rays through a binary tree. `tile_top` and `group_top` are copies of what a beam
/// keeps of the levels above grids: a tile's, and from it a group's.
struct BinaryScratch {
    RayOrder rays;
    TopLevel tile_top, group_top;  ///< what of the tree the tile, and a group of its rays, may meet
    std::vector<Hit> hits;         ///< of one ray
};

/// `Tree` is one with parts, or KdTree, SlabTree, InsertionTree, LooseTree or TwoLevelTree.
template <class Tree>
class BinaryRayTraced final : public Visibility {
  public:
    explicit BinaryRayTraced(const VisibilityInput& input)
        : bundles_(kHasParts<Tree> && input.spec.is_on("bundle")),
          range_{input.context.camera.near_clip, input.context.camera.far_clip},
          sort_by_time_(input.context.motion && input.spec.is_on("ray_sort")),
          sort_by_direction_(input.context.camera.has_lens() && input.spec.is_on("ray_sort")),
          updates_(updates(input.spec)),
          all_opaque_(every_grid_is_opaque(input.grids)),
          tree_(built<Tree>(input)) {
        tell_of_budget(input, tree_.stats());
    }

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        order_rays(samples, {sort_by_time_, sort_by_direction_}, scratch.own.of<BinaryScratch>().rays);
        SampleStats counted;  // on the stack, so that counting stays in registers
        if (all_opaque_)
            resolve_closest(samples, hits, scratch, counted);
        else
            resolve_layers(samples, hits, scratch, counted);
        stats += counted;
    }

    BuildStats build_stats() const override { return tree_.stats(); }

    bool occluded(std::span<const SpaceRay> rays, DepthRange range, std::span<uint8_t> met,
                  SampleStats& stats) const override {
        SampleStats counted;
        for (size_t i = 0; i < rays.size(); ++i) {
            TraceRay ray = TraceRay::turned(axis_ray(rays[i]), range);
            AnyHit policy;
            trace(nullptr, ray, policy, counted);
            met[i] = policy.found;
        }
        stats += counted;
        return true;
    }

    bool update(const Grids& grids, const std::vector<uint32_t>* changed) override {
        if (!updates_) return false;
        if constexpr (std::is_same_v<Tree, MovingTree>)
            tree_.refit(grids);
        else if constexpr (requires { tree_.update(grids, *changed); })
            changed ? tree_.update(grids, *changed) : tree_.update(grids);
        else if constexpr (requires { tree_.update(grids); })
            tree_.update(grids);
        all_opaque_ = every_grid_is_opaque(grids);
        return true;
    }

  private:
    static bool updates(const MethodSpec& spec) {
        const std::string_view tree = spec["tree"];
        return tree == "refit" || tree == "dynamic" || tree == "loose" || tree == "twolevel" ||
               spec.is_on("refit");
    }

    /// Calls trace_one(sample, part of the tree, or null: all of it) for all samples in order. What a beam
    /// looks at counts in the stats, but for no one sample.
    template <class TraceOne>
    void trace_in_order(const SampleTile& samples, SampleScratch& scratch, SampleStats& stats,
                        TraceOne&& trace_one) const {
        BinaryScratch& own = scratch.own.of<BinaryScratch>();
        const std::span<const uint32_t> order = own.rays.order;
        if (order.empty()) return;
        const auto trace_group = [&](std::span<const uint32_t> group, const TopLevel* part) {
            for (const uint32_t sample : group) {
                const SampleStats before = stats;
                trace_one(sample, part);
                if (!scratch.heat) continue;
                scratch.heat->tests[sample] +=
                    static_cast<uint32_t>(stats.predicate_tests - before.predicate_tests);
                scratch.heat->nodes[sample] +=
                    static_cast<uint32_t>(stats.nodes_visited - before.nodes_visited);
            }
        };
        if (!bundles_) {
            trace_group(order, nullptr);
            return;
        }
        if constexpr (kHasParts<Tree>) {
            tree_.top().within(Beam(samples.rays, order, range_), own.tile_top, &stats.nodes_visited);
            for (size_t first = 0; first < order.size(); first += kGroupSize) {
                const auto group = order.subspan(first, std::min(kGroupSize, order.size() - first));
                own.tile_top.within(Beam(samples.rays, group, range_), own.group_top, &stats.nodes_visited);
                trace_group(group, &own.group_top);
            }
        }
    }

    /// Trees without a part to choose from have only one way in.
    template <class Policy>
    void trace(const TopLevel* part, TraceRay& ray, Policy& policy, SampleStats& stats) const {
        if constexpr (kHasParts<Tree>) {
            tree_.trace(part ? *part : tree_.top(), ray, policy, stats);
        } else {
            tree_.trace(ray, policy, stats);
        }
    }

    /// Opaque grids only: each ray keeps its nearest hit, and shortens itself to it as it goes.
    void resolve_closest(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                         SampleStats& stats) const {
        scratch.nearest.resize(samples.size());
        trace_in_order(samples, scratch, stats, [&](uint32_t sample, const TopLevel* part) {
            TraceRay ray = TraceRay::camera(samples.rays[sample], range_);
            ClosestHit policy;
            trace(part, ray, policy, stats);
            scratch.nearest[sample] = policy.best;
        });
        buffer_of_nearest(scratch, samples.size(), hits);
    }

    /// With layers: each ray collects hits to its first opaque one, within the window. A sample whose list
    /// was cut says so, or it would pass for complete.
    void resolve_layers(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                        SampleStats& stats) const {
        const LayerWindow& window = scratch.window;
        scratch.nearest.assign(samples.size(), kBehindAll);
        scratch.found.begin(samples.size(), window);
        std::vector<Hit>& of_ray = scratch.own.of<BinaryScratch>().hits;
        trace_in_order(samples, scratch, stats, [&](uint32_t sample, const TopLevel* part) {
            if (!window.wants(sample)) return;
            TraceRay ray = TraceRay::camera(samples.rays[sample], range_);
            of_ray.clear();
            HitsUntilOpaque policy{of_ray};
            policy.may_repeat = tree_.stats().tree_duplicates > 0;
            policy.most = std::min<size_t>(window.most, std::max<size_t>(1, window.room / 4));
            if (!window.behind.empty()) {
                policy.behind = window.behind[sample];
                ray.t_min = std::max(ray.t_min, policy.behind.depth);
            }
            trace(part, ray, policy, stats);
            if (policy.is_cut)
                scratch.found.cut(sample, policy.last);
            else
                scratch.nearest[sample] = policy.last;
            for (const Hit& hit : of_ray) scratch.found.add(sample, hit);
        });
        buffer_of_loose_hits(scratch, samples.size(), hits);
    }

    bool bundles_;
    DepthRange range_;
    bool sort_by_time_, sort_by_direction_, updates_, all_opaque_;
    Tree tree_;
};

}  // namespace

/// The tree is a template argument of the visibility, so that its traversal is inlined into the loop over
/// rays. tree=wide comes here where there are too many grids for its ids.
std::unique_ptr<Visibility> prepare_binary_raytrace(const VisibilityInput& input) {
    const std::string_view tree = input.spec["tree"];
    if (tree == "mbkd") return std::make_unique<BinaryRayTraced<KdTree>>(input);
    if (tree == "gs" || tree == "dynamic") return std::make_unique<BinaryRayTraced<InsertionTree>>(input);
    if (tree == "loose") return std::make_unique<BinaryRayTraced<LooseTree>>(input);
    if (tree == "slabs") return std::make_unique<BinaryRayTraced<SlabTree>>(input);
    if (tree == "twolevel") return std::make_unique<BinaryRayTraced<TwoLevelTree>>(input);
    if (tree != "paper" && tree != "wide") return std::make_unique<BinaryRayTraced<MovingTree>>(input);
    if (input.spec["split"] == "sah") return std::make_unique<BinaryRayTraced<MicropolygonTree>>(input);
    return std::make_unique<BinaryRayTraced<PaperTree>>(input);
}

}  // namespace trapeze
