/// Values that a scene sets by category and name, as Attribute and Option do.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/scene/parameters.h"

namespace trapeze {

/// A balanced tree whose copies share what none of them has changed: a scene has millions of sets of
/// attributes that differ in nothing of this, or each in a value from the one before. A copy takes no time, a
/// change as long as the logarithm of how many values there are.
class UserValues {
  public:
    bool empty() const { return !root_; }
    /// Null: nobody has set it. It stays where it is until these values change.
    const Parameter* find(std::string_view category, std::string_view name) const;
    /// Of "category:name", as shaders and conditions write it; without a category it is "user".
    const Parameter* find(std::string_view full_name) const;
    float float_or(std::string_view category, std::string_view name, float fallback) const {
        return first_number(find(category, name), fallback);
    }
    std::string string_or(std::string_view category, std::string_view name, std::string fallback) const {
        return first_string(find(category, name), std::move(fallback));
    }
    /// Whether anything of a category is set.
    bool has_category(std::string_view category) const;

    /// Replaces the value of the same category and name, or adds one.
    void set(std::string_view category, Parameter value);

    /// Calls visit(category, parameter) of all values, in the order of categories and names.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for_each_below(root_.get(), visit);
    }

    /// What these values take of memory and no earlier call has counted, of whatever values they share.
    size_t count_bytes() const;

  private:
    struct Value {
        std::string category;
        Parameter parameter;
        mutable bool counted = false;  ///< by count_bytes()
    };
    struct Node;
    using Tree = std::shared_ptr<const Node>;
    /// Of an AVL tree; never changed, since several trees may have it.
    struct Node {
        std::shared_ptr<const Value> value;
        Tree left, right;
        int height = 1;
        mutable bool counted = false;  ///< with all below it
    };

    template <typename Visit>
    static void for_each_below(const Node* node, const Visit& visit) {
        if (!node) return;
        for_each_below(node->left.get(), visit);
        visit(node->value->category, node->value->parameter);
        for_each_below(node->right.get(), visit);
    }
    static int height_of(const Tree& tree) { return tree ? tree->height : 0; }
    static Tree joined(std::shared_ptr<const Value> value, Tree left, Tree right);
    static Tree balanced(const std::shared_ptr<const Value>& value, const Tree& left, const Tree& right);
    static Tree with(const Tree& tree, const std::shared_ptr<const Value>& value);
    static size_t count_bytes_below(const Node* node);

    Tree root_;
};

}  // namespace trapeze
