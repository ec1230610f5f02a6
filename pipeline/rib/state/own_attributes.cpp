#include "pipeline/rib/state/own_attributes.h"

#include <algorithm>

namespace trapeze::rib {
namespace {

bool says_on(const Parameter& value) {
    return !value.strings.empty() && value.strings[0] == "on";
}

/// Whether groups are added to others or taken from them (change_membership()).
bool changes_membership(const Parameter& value) {
    if (value.strings.empty()) return false;
    const std::string& names = value.strings[0];
    const size_t first = names.find_first_not_of(", \t\n");
    return first != std::string::npos && (names[first] == '+' || names[first] == '-');
}

/// Whether nothing is left of what an older value of the same name did (set_ray_attribute()).
bool replaces(const std::string& category, const Parameter& value, const Parameter& old) {
    if (value.is_string() != old.is_string()) return false;
    if (category == "grouping" && value.name == "membership")
        return !changes_membership(value) || value.strings == old.strings;
    if (category == "light" && value.name == "shadows") return says_on(value) || !says_on(old);
    return true;
}

}  // namespace

const std::vector<AttributeValue>& OwnAttributes::values() const {
    static const std::vector<AttributeValue> nothing;
    return values_ ? *values_ : nothing;
}

/// What a later value undoes is not kept: primitives may have names by the thousand.
void OwnAttributes::set(const std::string& category, const Parameter& value) {
    if (!values_)
        values_ = std::make_shared<std::vector<AttributeValue>>();
    else if (values_.use_count() > 1)
        values_ = std::make_shared<std::vector<AttributeValue>>(*values_);
    std::erase_if(*values_, [&](const AttributeValue& old) {
        return old.value.name == value.name && old.category == category &&
               replaces(category, value, old.value);
    });
    values_->push_back({category, value});
}

void OwnAttributes::switch_light(const std::shared_ptr<const LightInstance>& light, bool on) {
    std::erase_if(switches_, [&](const auto& known) { return known.first == light; });
    switches_.emplace_back(light, on);
}

void OwnAttributes::add(const OwnAttributes& other) {
    if (other.restored_) *this = OwnAttributes(definition_, other.restored_);
    whole_ |= other.whole_;
    for (const AttributeValue& value : other.values()) set(value.category, value.value);
    for (const auto& [light, on] : other.switches_) switch_light(light, on);
}

}  // namespace trapeze::rib
