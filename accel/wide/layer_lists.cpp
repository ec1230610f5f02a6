#include "accel/wide/layer_lists.h"

#include <algorithm>

namespace trapeze {
namespace {

/// Lists of so few layers are cut at each layer more, so that rays look no farther than they must. Longer
/// ones are cut when they are twice as long as wanted, which takes the same time for each layer however long
/// they are.
constexpr uint32_t kFewLayers = 32;
constexpr size_t kLeastNodes = 1024;

}  // namespace

void LayerLists::begin(size_t ray_count, const LayerBounds& bounds) {
    bounds_ = bounds;
    trigger_ = bounds.most;
    if (trigger_ > kFewLayers) trigger_ = bounds.most > kNone / 2 ? kNone : 2 * bounds.most;
    room_ = std::max(bounds.room, 2 * ray_count);
    ray_count_ = ray_count;
    nodes_.clear();
    is_linked_ = false;
    if (trigger_ != kNone && ray_count > 0) link_all();
}

/// Makes room for a node; nodes take no more memory than the room says.
void LayerLists::grow() {
    nodes_.reserve(std::min(room_, std::max(kLeastNodes, 2 * nodes_.capacity())));
}

/// Makes a list for each ray, of the layers that are there.
void LayerLists::link_all() {
    is_linked_ = true;
    held_ = nodes_.size();
    free_ = kNone;
    lists_.assign(ray_count_, {});
    for (uint32_t at = 0; at < nodes_.size(); ++at) {
        List& list = lists_[nodes_[at].ray];
        nodes_[at].next = list.first;
        list.first = at;
        ++list.count;
    }
}

/// Nodes that cuts have freed are used before new ones.
LayerLists::Ended LayerLists::add_to_list(uint32_t ray, const BundleLayer& layer) {
    List& list = lists_[ray];
    if (list.has_end && !layer.in_front(list.end)) return Ended::None;
    uint32_t at = free_;
    if (at != kNone) {
        free_ = nodes_[at].next;
    } else {
        if (nodes_.size() == nodes_.capacity()) grow();
        at = static_cast<uint32_t>(nodes_.size());
        nodes_.emplace_back();
    }
    nodes_[at] = {layer, ray, list.first};
    list.first = at;
    ++held_;
    if (++list.count >= trigger_) {
        cut(list, bounds_.most);
        return Ended::This;
    }
    if (held_ < room_) return Ended::None;
    cut_all();
    return Ended::Many;
}

/// Leaves the nearest `most` layers of a list that has as many, and ends it behind them.
void LayerLists::cut(List& list, size_t most) {
    order_.clear();
    for (uint32_t at = list.first; at != kNone; at = nodes_[at].next) order_.push_back(at);
    const auto last = order_.begin() + static_cast<std::ptrdiff_t>(most - 1);
    std::nth_element(order_.begin(), last, order_.end(),
                     [this](uint32_t a, uint32_t b) { return nodes_[a].layer.in_front(nodes_[b].layer); });
    // The nearest are linked anew; the nodes of all others become free, and for_each() passes them over.
    list.end = nodes_[*last].layer;
    list.has_end = true;
    list.first = kNone;
    list.count = static_cast<uint32_t>(most);
    for (size_t i = 0; i < order_.size(); ++i) {
        uint32_t& next_of = i < most ? list.first : free_;
        nodes_[order_[i]].next = next_of;
        next_of = order_[i];
        if (i >= most) nodes_[order_[i]].ray = kNone;
    }
    held_ -= order_.size() - most;
}

/// Cuts the longer lists, so that half of the room is free.
void LayerLists::cut_all() {
    const auto lists = static_cast<size_t>(
        std::count_if(lists_.begin(), lists_.end(), [](const List& list) { return list.count > 0; }));
    // At least one list has layers, since the room is full.
    const size_t most = std::min<size_t>(bounds_.most, std::max<size_t>(1, room_ / 2 / lists));
    for (List& list : lists_)
        if (list.count > most) cut(list, most);
}

}  // namespace trapeze
