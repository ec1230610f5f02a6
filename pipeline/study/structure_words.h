/// Which tree is for what, said in words from what trees cost on many scenes.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// What one tree cost on one scene. Seconds; bytes, tests and nodes are means.
struct StructureCosts {
    std::string tree;  ///< as in raytrace:tree=
    double build = 0, trace = 0;
    double bytes = 0;             ///< a micropolygon
    double tests = 0, nodes = 0;  ///< a ray

    double total() const { return build + trace; }
};

/// What trees cost on the same scene, moving or still: the same rays.
struct StructureRun {
    std::string scene, blur;
    double rays_per_micropolygon = 0;
    std::vector<StructureCosts> trees;
};

/// Sentences: who wins by what, and for each tree how it stands to the wide tree, the one that the program
/// takes by itself: with so many rays a micropolygon it is worth its building. Trees that a run lacks have no
/// part in it.
std::vector<std::string> words_on_structures(const std::vector<StructureRun>& runs);

/// With how many rays a micropolygon a tree costs less than another: one that is built faster with few, one
/// whose rays are faster with many.
struct Worth {
    enum class When { Always, Never, Fewer, More } when;
    double rays = 0;  ///< fewer or more than that
};
/// Of two trees of a run.
Worth worth_of(const StructureRun& run, const StructureCosts& tree, const StructureCosts& other);

}  // namespace trapeze
