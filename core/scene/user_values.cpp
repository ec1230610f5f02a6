#include "core/scene/user_values.h"

#include <algorithm>
#include <compare>
#include <tuple>

namespace trapeze {
namespace {

/// Before, at or behind: where a value of this category and name stands beside another.
std::strong_ordering order(std::string_view category, std::string_view name, std::string_view other_category,
                           std::string_view other_name) {
    return std::tie(category, name) <=> std::tie(other_category, other_name);
}

}  // namespace

const Parameter* UserValues::find(std::string_view category, std::string_view name) const {
    for (const Node* node = root_.get(); node;) {
        const auto side = order(category, name, node->value->category, node->value->parameter.name);
        if (side == 0) return &node->value->parameter;
        node = (side < 0 ? node->left : node->right).get();
    }
    return nullptr;
}

const Parameter* UserValues::find(std::string_view full_name) const {
    const size_t colon = full_name.find(':');
    if (colon == std::string_view::npos) return find("user", full_name);
    return find(full_name.substr(0, colon), full_name.substr(colon + 1));
}

bool UserValues::has_category(std::string_view category) const {
    for (const Node* node = root_.get(); node;) {
        if (category == node->value->category) return true;
        node = (category < node->value->category ? node->left : node->right).get();
    }
    return false;
}

UserValues::Tree UserValues::joined(std::shared_ptr<const Value> value, Tree left, Tree right) {
    const int height = 1 + std::max(height_of(left), height_of(right));
    return std::make_shared<const Node>(Node{std::move(value), std::move(left), std::move(right), height});
}

/// Joins trees whose heights differ by 2 at most.
UserValues::Tree UserValues::balanced(const std::shared_ptr<const Value>& value, const Tree& left,
                                      const Tree& right) {
    const int lean = height_of(left) - height_of(right);
    if (lean > 1) {
        if (height_of(left->left) >= height_of(left->right))
            return joined(left->value, left->left, joined(value, left->right, right));
        const Tree& middle = left->right;
        return joined(middle->value, joined(left->value, left->left, middle->left),
                      joined(value, middle->right, right));
    }
    if (lean < -1) {
        if (height_of(right->right) >= height_of(right->left))
            return joined(right->value, joined(value, left, right->left), right->right);
        const Tree& middle = right->left;
        return joined(middle->value, joined(value, left, middle->left),
                      joined(right->value, middle->right, right->right));
    }
    return joined(value, left, right);
}

/// The tree with a value more, or another of this name: new nodes on the way to it, and all others as they
/// are.
UserValues::Tree UserValues::with(const Tree& tree, const std::shared_ptr<const Value>& value) {
    if (!tree) return joined(value, nullptr, nullptr);
    const auto side =
        order(value->category, value->parameter.name, tree->value->category, tree->value->parameter.name);
    if (side == 0) return joined(value, tree->left, tree->right);
    return side < 0 ? balanced(tree->value, with(tree->left, value), tree->right)
                    : balanced(tree->value, tree->left, with(tree->right, value));
}

void UserValues::set(std::string_view category, Parameter value) {
    root_ = with(root_, std::make_shared<const Value>(Value{std::string(category), std::move(value)}));
}

size_t UserValues::count_bytes() const {
    return count_bytes_below(root_.get());
}

size_t UserValues::count_bytes_below(const Node* node) {
    if (!node || node->counted) return 0;
    node->counted = true;
    size_t bytes = sizeof(Node) + count_bytes_below(node->left.get()) + count_bytes_below(node->right.get());
    const Value& value = *node->value;
    if (std::exchange(value.counted, true)) return bytes;
    const Parameter& parameter = value.parameter;
    bytes += sizeof(Value) + value.category.capacity() + parameter.name.capacity() +
             parameter.floats.capacity() * sizeof(float);
    for (const std::string& text : parameter.strings) bytes += sizeof text + text.capacity();
    return bytes;
}

}  // namespace trapeze
