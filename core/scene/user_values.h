/// Values that a scene sets by category and name, as Attribute does. Copies share them until one is changed:
/// a scene has millions of sets of attributes, and most of them differ in nothing of this.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/scene/parameters.h"

namespace trapeze {

class UserValues {
  public:
    using Lists = std::map<std::string, ParameterList>;

    const Lists& lists() const { return lists_ ? *lists_ : none(); }
    bool empty() const { return lists().empty(); }
    bool contains(const std::string& category) const { return lists().contains(category); }
    Lists::const_iterator find(const std::string& category) const { return lists().find(category); }
    const ParameterList& at(const std::string& category) const { return lists().at(category); }
    Lists::const_iterator begin() const { return lists().begin(); }
    Lists::const_iterator end() const { return lists().end(); }

    /// The list of a category, to be changed in these values alone.
    ParameterList& change(const std::string& category) {
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
