/// The tree of an AFF file's transforms: which stands in which, and where they are at a time.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/study/aff/aff_animation.h"

namespace trapeze {

using AffAnimations = std::map<std::string, AffAnimation>;

/// Where a transform takes points to.
struct AffPlacement {
    M44d world_from_local;
    double time = 0;  ///< at which that is so
};

/// Transforms have numbers; 0 is the world.
class AffTransforms {
  public:
    AffTransforms() : nodes_(1) {}

    int add_static(int parent, const M44d& parent_from_local);
    /// Moved by the animation of that name, if there is one in the end.
    int add_animated(int parent, std::string animation);
    size_t size() const { return nodes_.size(); }
    /// How many transforms are above it.
    int depth(int transform) const { return nodes_[static_cast<size_t>(transform)].depth; }

    /// To be called once, when all transforms are there. False where visibility keys above each other are so
    /// many that it would take too long.
    bool animate(const AffAnimations& animations);

    /// Whether a transform moves, or one above it.
    bool moves(int transform) const { return nodes_[static_cast<size_t>(transform)].moves; }
    /// Of each transform. An invisible one, or one in such, is where it is at the nearest time at which it is
    /// visible; one that never is moves on as if it were.
    std::vector<AffPlacement> at(double time) const;

  private:
    struct Node {
        int parent = -1;
        int depth = 0;
        M44d parent_from_local;  ///< of a static one
        std::string name;        ///< of the animation; empty: it is static
        int animation = -1;      ///< in animations_; -1: none of that name
        size_t spans = 0;        ///< in visible_
        bool moves = false;
    };
    int add(Node node);
    M44d local_matrix(const Node& node, double time) const;

    std::vector<Node> nodes_;  ///< parents first
    std::vector<AffAnimation> animations_;
    std::vector<AffSpans> visible_{AffSpans{AffSpan()}};  ///< first that of who is always visible
};

}  // namespace trapeze
