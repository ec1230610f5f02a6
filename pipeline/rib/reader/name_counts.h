/// Counts by name, of which a few come again and again.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace trapeze::rib {

/// Remembers where the summary counts the names that came last.
class NameCounts {
  public:
    /// The count of a name in `counts`, the same map at each call, whose entries stay where they are. A cache
    /// of one entry a slot in front of the map: length, first and last letter tell request names apart well
    /// enough, and a clash costs no more than the search it saves.
    uint64_t& of(std::map<std::string, uint64_t>& counts, const std::string& name) {
        const size_t letters =
            name.empty() ? 0
                         : static_cast<unsigned char>(name[0]) * 5u + static_cast<unsigned char>(name.back());
        Known& known = known_[(name.size() * 11 + letters) % known_.size()];
        if (!known.name || *known.name != name) {
            const auto entry = counts.try_emplace(name, 0).first;
            known = {&entry->first, &entry->second};
        }
        return *known.count;
    }

  private:
    /// Points into the map, whose nodes do not move; name null: a slot not used yet.
    struct Known {
        const std::string* name = nullptr;
        uint64_t* count = nullptr;
    };
    std::array<Known, 64> known_;
};

}  // namespace trapeze::rib
