#include "pipeline/study/aff/aff_transforms.h"

#include <string_view>

namespace trapeze {
namespace {

/// Looked at for all transforms together: it bounds time, and memory to 32 MB.
constexpr size_t kMostAffSpans = 2'000'000;

}  // namespace

int AffTransforms::add(Node node) {
    node.depth = depth(node.parent) + 1;
    nodes_.push_back(std::move(node));
    return static_cast<int>(nodes_.size()) - 1;
}

int AffTransforms::add_static(int parent, const M44d& parent_from_local) {
    Node node;
    node.parent = parent, node.parent_from_local = parent_from_local;
    return add(std::move(node));
}

int AffTransforms::add_animated(int parent, std::string animation) {
    Node node;
    node.parent = parent, node.name = std::move(animation);
    return add(std::move(node));
}

bool AffTransforms::animate(const AffAnimations& animations) {
    std::map<std::string_view, int> numbers;
    for (const auto& [name, animation] : animations) {
        numbers[name] = static_cast<int>(animations_.size());
        animations_.push_back(animation);
    }
    size_t spans = 0;
    for (Node& node : nodes_) {
        if (node.parent < 0) continue;
        const Node& parent = nodes_[static_cast<size_t>(node.parent)];
        node.moves = parent.moves, node.spans = parent.spans;
        const auto found = node.name.empty() ? numbers.end() : numbers.find(node.name);
        if (found == numbers.end()) continue;
        node.animation = found->second;
        const AffAnimation& animation = animations_[static_cast<size_t>(node.animation)];
        node.moves = node.moves || animation.moves();
        if (animation.is_always_visible()) continue;
        spans += 1 + visible_[parent.spans].size() + animation.visible.size();
        if (spans > kMostAffSpans) return false;
        visible_.push_back(common_spans(visible_[parent.spans], animation.visible));
        node.spans = visible_.size() - 1;
    }
    return true;
}

M44d AffTransforms::local_matrix(const Node& node, double time) const {
    if (node.animation < 0) return node.parent_from_local;
    return animations_[static_cast<size_t>(node.animation)].matrix_at(time);
}

std::vector<AffPlacement> AffTransforms::at(double time) const {
    std::vector<AffPlacement> placed(nodes_.size());
    for (size_t i = 0; i < nodes_.size(); ++i) {
        const Node& node = nodes_[i];
        const double moment = nearest_in_spans(visible_[node.spans], time);
        M44d world_from_local = local_matrix(node, moment);
        // All that is above counts as it is at that moment, which may be another than its own.
        for (int above = node.parent; above >= 0;) {
            const auto number = static_cast<size_t>(above);
            if (placed[number].time == moment) {
                world_from_local *= placed[number].world_from_local;
                break;
            }
            world_from_local *= local_matrix(nodes_[number], moment);
            above = nodes_[number].parent;
        }
        placed[i] = {world_from_local, moment};
    }
    return placed;
}

}  // namespace trapeze
