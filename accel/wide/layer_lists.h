/// The layers that rays of a bundle meet: a list a ray, of the nearest few where no more are wanted, within a
/// bound of memory [decision 0032].
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace trapeze {

/// A hit on a grid that is not opaque.
struct BundleLayer {
    float depth;
    uint32_t id;  ///< as RayBundle::id

    /// Nearer, or as near and of a smaller id: as in_front() has it for hits.
    bool in_front(const BundleLayer& o) const { return depth < o.depth || (depth == o.depth && id < o.id); }
};

/// Which layers of a bundle's rays are wanted.
struct LayerBounds {
    const BundleLayer* behind = nullptr;  ///< ray -> only layers behind this; null: all
    uint32_t most = ~uint32_t{0};         ///< of each ray so many, the nearest; 0 where there are none
    /// Layers of all rays that may be held at once; but two of each ray always may.
    size_t room = std::numeric_limits<size_t>::max();
};

/// One a bundle. Lists are linked: nobody knows which of a thousand rays meets a thousand layers. But they
/// are so only from when one may have to be cut; until then layers lie in the order in which they came.
class LayerLists {
  public:
    /// Empties all lists, for so many rays. What `bounds` points to is read until the next begin().
    void begin(size_t ray_count, const LayerBounds& bounds);

    /// Whose list has come to an end, behind which nothing is wanted.
    enum class Ended { None, This, Many };

    /// Takes in a layer.
    Ended add(uint32_t ray, const BundleLayer& layer) {
        if (bounds_.behind && !bounds_.behind[ray].in_front(layer)) return Ended::None;
        if (is_linked_) return add_to_list(ray, layer);
        if (nodes_.size() == nodes_.capacity()) grow();
        nodes_.push_back({layer, ray, kNone});
        if (nodes_.size() < room_) return Ended::None;
        link_all();
        cut_all();
        return Ended::Many;
    }

    bool has_end(size_t ray) const { return is_linked_ && lists_[ray].has_end; }
    /// The last layer of a list that has an end; nothing behind it is in the list.
    const BundleLayer& end(size_t ray) const { return lists_[ray].end; }
    size_t bytes() const { return nodes_.capacity() * sizeof(Node) + lists_.capacity() * sizeof(List); }

    /// Calls visit(ray, layer) for all layers, in no order.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (const Node& node : nodes_)
            if (node.ray != kNone) visit(node.ray, node.layer);
    }

  private:
    static constexpr uint32_t kNone = ~uint32_t{0};
    struct Node {
        BundleLayer layer;
        uint32_t ray;   ///< kNone: this is free
        uint32_t next;  ///< in the list, or of those that are free
    };
    /// The layers of a ray, in no order. Once it has an end, what lies behind is no longer taken in.
    struct List {
        uint32_t first = kNone, count = 0;
        bool has_end = false;
        BundleLayer end{};
    };

    void grow();
    Ended add_to_list(uint32_t ray, const BundleLayer& layer);
    void link_all();
    void cut(List& list, size_t most);
    void cut_all();

    LayerBounds bounds_;
    bool is_linked_ = false;
    uint32_t trigger_ = 0;        ///< a list that has so many layers is cut
    size_t held_ = 0, room_ = 0;  ///< layers in all lists; and so many cut all of them
    size_t ray_count_ = 0;
    uint32_t free_ = kNone;  ///< the first of the free nodes
    std::vector<Node> nodes_;
    std::vector<List> lists_;
    std::vector<uint32_t> order_;  ///< of the nodes of a list that is cut
};

}  // namespace trapeze
