/// Values that a scene sets by category and name, as Attribute does. Copies share them until one is changed:
/// a scene has millions of sets of attributes, and most of them differ in nothing of this.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/scene/parameters.h"

namespace trapeze {

/// The values of a category, found by name: a file may set them by the ten thousand.
class CategoryValues {
  public:
    const Parameter* find(std::string_view name) const {
        const auto found = values_.find(name);
        return found == values_.end() ? nullptr : &*found;
    }
    float float_or(std::string_view name, float fallback) const { return first_number(find(name), fallback); }
    std::string string_or(std::string_view name, std::string fallback) const {
        return first_string(find(name), std::move(fallback));
    }
    /// Replaces the value of the same name, or adds one.
    void set(Parameter value) {
        const auto place = values_.lower_bound(value.name);
        if (place == values_.end() || place->name != value.name) {
            values_.insert(place, std::move(value));
            return;
        }
        auto node = values_.extract(place);
        node.value() = std::move(value);
        values_.insert(std::move(node));
    }
    /// In the order of names.
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }

  private:
    struct ByName {
        using is_transparent = void;
        bool operator()(const Parameter& a, const Parameter& b) const { return a.name < b.name; }
        bool operator()(const Parameter& a, std::string_view b) const { return a.name < b; }
        bool operator()(std::string_view a, const Parameter& b) const { return a < b.name; }
    };
    std::set<Parameter, ByName> values_;
};

class UserValues {
  public:
    using Lists = std::map<std::string, CategoryValues>;

    const Lists& lists() const { return lists_ ? *lists_ : none(); }
    bool empty() const { return lists().empty(); }
    bool contains(const std::string& category) const { return lists().contains(category); }
    Lists::const_iterator find(const std::string& category) const { return lists().find(category); }
    const CategoryValues& at(const std::string& category) const { return lists().at(category); }
    Lists::const_iterator begin() const { return lists().begin(); }
    Lists::const_iterator end() const { return lists().end(); }

    /// The list of a category, to be changed in these values alone.
    CategoryValues& change(const std::string& category) {
        if (!lists_)
            lists_ = std::make_shared<Lists>();
        else if (lists_.use_count() > 1)
            lists_ = std::make_shared<Lists>(*lists_);
        return (*lists_)[category];
    }

  private:
    static const Lists& none() {
        static const Lists nothing;
        return nothing;
    }
    std::shared_ptr<Lists> lists_;  ///< null: none
};

}  // namespace trapeze
