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

const OwnAttributes::Values& OwnAttributes::values() const {
    static const Values nothing;
    return record_ ? record_->values : nothing;
}

void OwnAttributes::set(const std::string& category, const Parameter& value) {
    if (!record_)
        record_ = std::make_shared<Record>();
    else if (record_.use_count() > 1)
        record_ = std::make_shared<Record>(*record_);
    Record& record = *record_;
    std::set<uint64_t>& same_name = record.of_name[category + '\n' + value.name];
    std::erase_if(same_name, [&](uint64_t order) {
        return replaces(category, value, record.values.at(order).value) && record.values.erase(order) != 0;
    });
    same_name.insert(record.next);
    record.values.emplace_hint(record.values.end(), record.next++, AttributeValue{category, value});
}

void OwnAttributes::switch_light(const std::shared_ptr<const LightInstance>& light, bool on) {
    std::erase_if(switches_, [&](const auto& known) { return known.first == light; });
    switches_.emplace_back(light, on);
}

void OwnAttributes::add(const OwnAttributes& other) {
    if (other.restored_) *this = OwnAttributes(definition_, other.restored_);
    whole_ |= other.whole_;
    for (const auto& [order, value] : other.values()) set(value.category, value.value);
    for (const auto& [light, on] : other.switches_) switch_light(light, on);
}

}  // namespace trapeze::rib
