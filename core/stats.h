/// Statistics are values that add [decision 0026], with the unit in the name. Every stage returns its own.
#pragma once

#include <algorithm>
#include <cstdint>

namespace trapeze {

/// What splitting made; culled subpatches are those that nothing sees.
struct TessellateStats {
    uint64_t primitives = 0, subpatches = 0, grids = 0, micropolygons = 0, culled_subpatches = 0;

    TessellateStats& operator+=(const TessellateStats& o) {
        primitives += o.primitives, subpatches += o.subpatches, grids += o.grids;
        micropolygons += o.micropolygons, culled_subpatches += o.culled_subpatches;
        return *this;
    }
};

/// Rays that shaders have traced, by kind, and how many of their hits were shaded.
struct RayStats {
    uint64_t diffuse = 0, specular = 0, transmission = 0, shaded_hits = 0;

    RayStats& operator+=(const RayStats& o) {
        diffuse += o.diffuse, specular += o.specular, transmission += o.transmission;
        shaded_hits += o.shaded_hits;
        return *this;
    }
};

/// What shading did; values that were no numbers have been replaced.
struct ShadeStats {
    uint64_t shaded_vertices = 0, not_finite_values = 0;
    RayStats rays;

    ShadeStats& operator+=(const ShadeStats& o) {
        shaded_vertices += o.shaded_vertices, not_finite_values += o.not_finite_values;
        rays += o.rays;
        return *this;
    }
};

/// Seconds of building a tree, one phase after the other; all 0 where a tree does not tell them. What is left
/// of the build is around them.
struct BuildPhases {
    double prepare = 0;  ///< bounding what is to be divided
    double divide = 0;   ///< deciding which node holds what
    double bound = 0;    ///< bounding nodes, where dividing does not say their boxes, and making lists
    /// Of dividing, the work of all threads together: in all, and on cutting micropolygons by planes.
    double divide_work = 0, cut_work = 0;

    BuildPhases& operator+=(const BuildPhases& o) {
        prepare += o.prepare, divide += o.divide, bound += o.bound;
        divide_work += o.divide_work, cut_work += o.cut_work;
        return *this;
    }
    double told() const { return prepare + divide + bound; }
    /// The part of dividing that was cutting.
    double cut_share() const { return divide_work > 0 ? cut_work / divide_work : 0; }
};

/// What was built for finding hits: bytes held, nodes and leaves.
struct BuildStats {
    uint64_t tree_bytes = 0, tree_nodes = 0, tree_leaves = 0;
    /// Where micropolygons may be in several leaves: how often they are in all, how often more than once, and
    /// how many nodes were cut for it.
    uint64_t tree_references = 0, tree_duplicates = 0, tree_splits = 0;
    /// Of a k-d tree for motion blur: the duplicates that planes made because something moves across them,
    /// and of how many micropolygons that is true [Yang17 table 2].
    uint64_t tree_guests = 0, tree_incoherent = 0;
    /// Tests and steps that a random line through the root's box is expected to need, by the surface area
    /// heuristic; 0: not counted.
    double tree_sah_cost = 0;
    bool lacked_budget = false;  ///< some node was not cut because there were references enough
    double setup_seconds =
        0;  ///< of the build: spent on copying to another library's buffers, not on the tree
    BuildPhases phases;

    BuildStats& operator+=(const BuildStats& o) {
        tree_bytes += o.tree_bytes, tree_nodes += o.tree_nodes, tree_leaves += o.tree_leaves;
        tree_references += o.tree_references, tree_duplicates += o.tree_duplicates;
        tree_splits += o.tree_splits, lacked_budget |= o.lacked_budget;
        tree_guests += o.tree_guests, tree_incoherent += o.tree_incoherent;
        tree_sah_cost += o.tree_sah_cost;
        setup_seconds += o.setup_seconds, phases += o.phases;
        return *this;
    }
};

/// What finding hits cost: rays traced, tests of the exact predicate and how many of them hit, nodes and
/// leaves of whatever structure the method has.
struct SampleStats {
    uint64_t rays = 0, predicate_tests = 0, predicate_hits = 0, nodes_visited = 0, leaves_visited = 0;

    SampleStats& operator+=(const SampleStats& o) {
        rays += o.rays, predicate_tests += o.predicate_tests, predicate_hits += o.predicate_hits;
        nodes_visited += o.nodes_visited, leaves_visited += o.leaves_visited;
        return *this;
    }
};

}  // namespace trapeze
